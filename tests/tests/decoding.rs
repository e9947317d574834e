//! Frames into quantities: units, joined halves, and bytes that no ECU would send.

use proptest::prelude::*;
use xt28_dbc::messages::{
    ArmStatus, ArmStatusMode, ArmStatusReason, ArmStatusState, ArmTarget, ArmTargetMode, Attitude,
    CylLoadFront, CylLoadMidRear, DriveTarget, GnssPosition, GnssVelocity, PosFront, PosMidRear,
    WheelSpeedJoint, WheelSpeedSigned,
};
use xt28_dbc::{CanId, Frame};
use xt28_machine::Wheel;
use xt28_scenarios::trace::EcuState;
use xt28_scenarios::{Decoder, Trace};

fn decoded(frames: impl IntoIterator<Item = Frame>) -> Trace {
    let mut decoder = Decoder::default();
    for (index, frame) in (0_u32..).zip(frames) {
        decoder.push(f64::from(index) * 1e-3, &frame);
    }
    decoder.finish()
}

fn arms_in() -> ArmTarget {
    let [fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm] = [0.0; 6];
    let mode = ArmTargetMode::ManualPosition;
    ArmTarget { fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm, mode, counter: 0 }
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

#[test]
fn wire_units_become_si() {
    let speeds = WheelSpeedSigned { fr_rpm: -6.0, bl_rpm: 12.0, ..Default::default() };
    let joints =
        WheelSpeedJoint { front_joint_deg: 9.0, rear_joint_deg: -5.0, ..Default::default() };
    let trace = decoded([
        GnssPosition { east_mm: -300.0, north_mm: 4980.0 }.encode().unwrap(),
        GnssVelocity { heading_deg: 337.0, up_mm_s: 25.0, ..Default::default() }.encode().unwrap(),
        Attitude { roll_deg: 1.5, pitch_deg: -0.5, ..Default::default() }.encode().unwrap(),
        speeds.encode().unwrap(),
        joints.encode().unwrap(),
    ]);
    assert_eq!(trace.faults, []);
    assert_eq!(trace.antenna_m.last().unwrap().value, [-0.3, 4.98]);
    let motion = trace.motion.last().unwrap().value;
    assert!(near(motion.heading_rad.to_degrees(), -23.0) && near(motion.velocity_m_s[2], 0.025));
    assert!(near(trace.attitude.last().unwrap().value.roll_rad.to_degrees(), 1.5));
    let speed = trace.wheel_speed_rad_s.last().unwrap().value;
    assert!(near(speed[Wheel::Fr], -0.628_318_530_717_958_6), "{speed:?}");
    assert!(near(trace.joint_rad.last().unwrap().value[1].to_degrees(), -5.0));
}

#[test]
fn two_frames_make_one_measurement_of_six() {
    let front = PosFront { fr_mm: 1.0, fl_mm: 2.0 }.encode().unwrap();
    let others = PosMidRear { mr_mm: 3.0, ml_mm: 4.0, br_mm: 5.0, bl_mm: 6.0 }.encode().unwrap();
    // The second front half replaces the first, whose other half was lost.
    let trace = decoded([front, front, others, others]);
    let strokes: Vec<_> = trace.stroke_m.samples().iter().map(|s| (s.at_s, s.value.0)).collect();
    assert_eq!(strokes, [(2e-3, [1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3])]);
    let front = CylLoadFront { fr_dan: 100.0, fl_dan: -1.0 }.encode().unwrap();
    let others = CylLoadMidRear { bl_dan: 7.0, ..Default::default() }.encode().unwrap();
    let load = decoded([others, front]).cylinder_load_n.last().unwrap().value;
    assert_eq!(load.0, [1000.0, -10.0, 0.0, 0.0, 0.0, 70.0]);
}

#[test]
fn commands_and_states_are_read_and_holds_are_no_targets() {
    let target = ArmTarget { fr_mm: 250.0, fl_mm: 510.0, ..arms_in() };
    let drive = DriveTarget { throttle_percent: -40.0, enable: true, ..Default::default() };
    let status = ArmStatus {
        mode: ArmStatusMode::Off,
        state: ArmStatusState::SafeStop,
        faults: 0,
        accepted: 3,
        reason: ArmStatusReason::None,
        supply_v: 24.0,
        counter: 5,
    };
    let trace =
        decoded([target.encode().unwrap(), drive.encode().unwrap(), status.encode().unwrap()]);
    let targets = trace.stroke_target_m.last().unwrap().value;
    assert_eq!((targets[Wheel::Fr], targets[Wheel::Fl]), (Some(0.25), None));
    assert!(near(trace.drive_target.last().unwrap().value.throttle, -0.4));
    assert_eq!(trace.arm_state.last().unwrap().value, EcuState::SafeStop);
}

#[test]
fn a_corrupt_frame_is_a_fault_and_an_unknown_one_only_counted() {
    let mut corrupt = arms_in().encode().unwrap();
    corrupt.data_mut()[0] ^= 1;
    let unknown = Frame::new(CanId::Standard(0x123), &[1, 2, 3]).unwrap();
    let trace = decoded([corrupt, unknown]);
    assert_eq!((trace.frames, trace.faults.len()), (2, 1));
    assert!(trace.faults[0].what.starts_with("0CFF4027#"), "{:?}", trace.faults);
    assert_eq!(trace.stroke_target_m.samples(), []);
}

proptest! {
    #[test]
    fn no_bytes_make_it_panic_or_lose_count(
        frames in prop::collection::vec(
            (prop::sample::select(IDS), prop::collection::vec(any::<u8>(), 0..=8)), 0..40),
    ) {
        let frames: Vec<Frame> = frames
            .iter()
            .map(|(id, data)| Frame::new(CanId::Extended(*id), data).unwrap())
            .collect();
        let count = frames.len() as u64;
        let trace = decoded(frames);
        prop_assert_eq!(trace.frames, count);
        let strokes = trace.stroke_m.samples().iter().flat_map(|s| s.value.0);
        prop_assert!(strokes.into_iter().all(f64::is_finite));
    }
}

/// Every identifier that is read, and one that is not.
const IDS: &[u32] = &[
    0x18FF_6027,
    0x18FF_6127,
    0x18FE_202B,
    0x18FE_1012,
    0x0CFF_5229,
    0x18FE_1026,
    0x18FE_1025,
    0x18FE_102E,
    0x18FE_102D,
    0x0CFF_4027,
    0x0CFF_4127,
    0x0CFF_5028,
    0x0CFF_5129,
    0x0000_0001,
];

/// A frame of each message of the database, all zeros but for what must not be: CRC, counter, what zero is out of
/// range of.
fn each_message(counter: u8) -> Vec<(String, Frame)> {
    let database = xt28_dbc::database();
    let frame = |message: &xt28_dbc::model::Message| {
        let mut data = vec![0; usize::from(message.len)];
        for signal in &message.signals {
            let value = if signal.name == "Counter" && message.alive {
                f64::from(counter % 16)
            } else {
                0_f64.clamp(signal.field.min, signal.field.max)
            };
            signal.field.write(&mut data, value).unwrap();
        }
        if message.is_protected() {
            data[7] = xt28_dbc::e2e::crc(message.data_id, &data[..7]);
        }
        let id = match message.id & 0x8000_0000 {
            0 => CanId::standard(u16::try_from(message.id).unwrap()),
            _ => CanId::extended(message.id & 0x1FFF_FFFF),
        };
        (message.name.clone(), Frame::new(id.unwrap(), &data).unwrap())
    };
    database.messages().iter().map(frame).collect()
}

#[test]
fn every_message_of_the_database_is_held_to_its_length() {
    let whole = decoded(each_message(0).into_iter().map(|(_, frame)| frame));
    assert_eq!(whole.faults, []);
    for (name, frame) in each_message(0) {
        let short = &frame.data()[1..];
        let trace = decoded([Frame::new(frame.id(), short).unwrap()]);
        assert_eq!(trace.faults.len(), 1, "{name}");
        assert!(trace.faults[0].what.contains(&name), "{:?}", trace.faults);
    }
}

#[test]
fn every_protected_message_is_held_to_its_crc_and_every_other_to_its_ranges() {
    let database = xt28_dbc::database();
    let mut out_of_range = 0;
    for (name, frame) in each_message(0) {
        let message = database.message_named(&name).unwrap();
        let faults = |data: &[u8]| {
            decoded([Frame::new(frame.id(), data).unwrap()]).faults.first().map(|f| f.what.clone())
        };
        if message.is_protected() {
            let mut data = frame.data().to_vec();
            data[7] ^= 0x10;
            assert!(faults(&data).unwrap().contains("crc"), "{name}");
            continue;
        }
        for signal in &message.signals {
            for raw in [0, u64::MAX, 1 << (signal.field.length - 1)] {
                let mut data = frame.data().to_vec();
                signal.field.set_raw(&mut data, raw);
                if signal.field.read(&data).is_err() {
                    let fault = faults(&data).unwrap_or_else(|| panic!("{name}.{}", signal.name));
                    assert!(fault.contains(&signal.name), "{fault}");
                    out_of_range += 1;
                }
            }
        }
    }
    assert!(out_of_range > 10, "{out_of_range}");
}

/// Ticks of all messages, the counter in each as `counter` has it.
fn ticking(ticks: u8, counter: impl Fn(u8) -> u8) -> Trace {
    let mut decoder = Decoder::default();
    for tick in 0..ticks {
        for (_, frame) in each_message(counter(tick)) {
            decoder.push(f64::from(tick) * 0.01, &frame);
        }
    }
    decoder.finish()
}

#[test]
fn an_alive_counter_goes_up_in_each_message_that_has_one() {
    let alive = xt28_dbc::database().messages().iter().filter(|message| message.alive).count();
    assert_eq!(ticking(40, |tick| tick).faults, []);
    assert_eq!(ticking(2, |_| 3).faults.len(), alive, "it stands still");
    assert_eq!(ticking(2, |tick| 9 - tick).faults.len(), alive, "it goes back");
    assert_eq!(ticking(2, |tick| 5 * tick).faults.len(), alive, "it goes ahead of time");
}

#[test]
fn frames_that_are_missing_and_senders_that_begin_anew_are_no_fault() {
    let mut decoder = Decoder::default();
    for tick in [0, 1, 2, 5, 6, 12, 13, 30] {
        // It was silent from 13 on, and began anew at 30.
        let counter = if tick == 30 { 0 } else { tick };
        for (_, frame) in each_message(counter) {
            decoder.push(f64::from(tick) * 0.01, &frame);
        }
    }
    assert_eq!(decoder.finish().faults, []);
}
