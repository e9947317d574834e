//! The arm ECU of 2016 by what its operator sees: frames, modes, timeouts, levelling.

mod rig_2016;

use std::collections::BTreeMap;

use rig_2016::{Arm, only, stroke_mv};
use xt28_dbc::messages::{Attitude, CentreOfMass, ForceErrRear, OptLoadRear};
use xt28_dbc::{CanId, Outbox};
use xt28_ecus::firmware_2016::Quirks;
use xt28_machine::PerWheel;

fn arm() -> Arm {
    Arm::new(Quirks::firmware())
}

fn levelling(preset: u8) -> Arm {
    let mut arm = arm();
    arm.until(6.0);
    arm.press(preset);
    arm.press(18);
    assert!(arm.is_levelling());
    arm
}

fn ids(outbox: &Outbox) -> BTreeMap<u32, usize> {
    let mut ids = BTreeMap::new();
    for frame in outbox.frames() {
        *ids.entry(frame.id().raw()).or_default() += 1;
    }
    ids
}

/// Facts 2.1 and 2.5: 32 frames on `CAN_1`, three on `CAN_4`, each once a tick.
#[test]
fn every_tick_sends_the_whole_set_once() {
    let mut arm = arm();
    let can1 = [
        0x18FE_1020,
        0x18FE_1021,
        0x18FE_1022,
        0x18FE_1025,
        0x18FE_1026,
        0x18FE_1027,
        0x18FE_1028,
        0x18FE_1029,
        0x18FE_102A,
        0x18FE_102B,
        0x18FE_102D,
        0x18FE_102E,
        0x18FE_2020,
        0x18FE_202A,
        0x18FE_202B,
        0x18FF_1001,
        0x18FF_1002,
        0x18FF_1003,
        0x18FF_1004,
        0x18FF_1005,
        0x18FF_1060,
        0x17FE_0001,
        0x17FE_0002,
        0x17FE_0003,
        0x17FE_0006,
        0x17FE_0007,
        0x17FE_0008,
        0x18FE_1050,
        0x18FE_1051,
        0x18FE_1052,
        0x1FD,
        0x2FD,
    ];
    for tick in 0..20 {
        arm.tick();
        assert_eq!(ids(&arm.out.can1), can1.map(|id| (id, 1)).into(), "tick {tick}");
        let can4 = [0x18FE_1040, 0x18FE_1041, 0x18FE_1042];
        assert_eq!(ids(&arm.out.can4), can4.map(|id| (id, 1)).into());
        let start: Vec<_> = arm.out.can2.frames().iter().map(|f| (f.id(), f.data())).collect();
        let wanted: &[(CanId, &[u8])] =
            if tick == 0 { &[(CanId::Extended(0), &[0x01, 0x7F])] } else { &[] };
        assert_eq!(start, wanted, "the unit is started once");
    }
}

#[test]
fn jog_moves_the_wheel_of_its_button_until_pressed_again() {
    for (button, wheel) in [(1, 1), (3, 0), (4, 3), (6, 2), (7, 5), (9, 4)] {
        let mut arm = arm();
        arm.stick_mv = Some([2350, 4300]);
        arm.press(button);
        let mut wanted = [0; 6];
        wanted[wheel] = 300;
        assert_eq!(arm.u_ma(), wanted, "button {button}: up lowers");
        arm.press(button);
        assert_eq!(arm.u_ma(), [0; 6]);
    }
}

#[test]
fn a_chair_to_the_back_mirrors_jog_and_turns_tilt_round() {
    let mut arm = arm();
    arm.status = Some([0, 0]);
    arm.stick_mv = Some([2550 + 1750, 2350]);
    arm.press(16);
    assert_eq!(arm.u_ma(), [-300, 300, -300, 300, -300, 300]);
    arm.status = Some([0, 1]);
    arm.tick();
    assert_eq!(arm.u_ma(), [300, -300, 300, -300, 300, -300], "right lowers the right side");
    arm.stick_mv = Some([2350, 4300]);
    arm.tick();
    assert_eq!(arm.u_ma(), [300, 300, 0, 0, -300, -300], "forward lowers the front");
    arm.press(1);
    arm.status = Some([0, 0]);
    arm.tick();
    assert_eq!(arm.u_ma(), [0, 0, 0, 0, 300, 0], "front left from the other chair is back right");
}

#[test]
fn all_up_grows_by_04_a_tick_to_80_and_ends_with_the_button() {
    for (button, sign) in [(19, -1), (21, 1)] {
        let mut arm = arm();
        arm.tick();
        arm.buttons = Some(vec![button]);
        arm.ticks(100);
        assert_eq!(arm.u_ma(), [sign * 40; 6]);
        arm.ticks(150);
        assert_eq!(arm.u_ma(), [sign * 80; 6]);
        arm.buttons = Some(Vec::new());
        arm.tick();
        assert_eq!(arm.u_ma(), [0; 6]);
        // Every second press of the same button is lost (facts 3.8).
        arm.buttons = Some(vec![button]);
        arm.ticks(10);
        assert_eq!(arm.u_ma(), [0; 6]);
    }
}

#[test]
fn two_buttons_in_one_byte_are_none() {
    let mut arm = arm();
    arm.stick_mv = Some([2350, 4300]);
    arm.press(1);
    arm.buttons = Some(vec![3, 4]);
    arm.tick();
    assert_eq!(arm.u_ma(), [0; 6]);
}

/// Facts 3.9: seen 200 to 250 ms after the last frame; all modes end, the alert shows.
#[test]
fn a_lost_armrest_shuts_the_valves() {
    for phase_ticks in 0..5 {
        let mut arm = arm();
        arm.stick_mv = Some([2350, 4300]);
        arm.press(3);
        arm.ticks(phase_ticks);
        arm.buttons = None;
        let moved = (1..=60).take_while(|_| {
            arm.tick();
            arm.u_ma()[0] != 0
        });
        let after_ms = 10 * (moved.count() as u64 + 1);
        assert!((200..=260).contains(&after_ms), "{after_ms} ms");
        assert_eq!(arm.display().alert, 1);
        arm.press(3);
        assert_eq!(arm.display().alert, 0, "the alert clears by itself");
    }
}

/// Facts 3.1, 3.9: the fault task runs 5 ms after power-up and every 50 ms. A missing armrest has counted to 200
/// when it runs for the fifth time, at 205 ms: the frames of 210 ms are the first to say so.
#[test]
fn an_armrest_that_never_spoke_is_missed_by_the_fifth_fault_task() {
    let mut arm = Arm::new(Quirks::firmware());
    arm.buttons = None;
    let quiet = (0..60).take_while(|_| {
        arm.tick();
        arm.display().alert == 0
    });
    assert_eq!(10 * quiet.count(), 210);
}

#[test]
fn any_preset_jog_or_passive_button_drops_levelling() {
    for button in [1, 2, 5, 8, 10, 15, 17, 20] {
        let mut arm = levelling(11);
        arm.press(button);
        assert!(!arm.is_levelling(), "button {button}");
    }
}

#[test]
fn roll_is_levelled_by_a_third_of_its_gain_once_led_in() {
    let mut arm = levelling(11);
    arm.lean_deg = Some([0.0, 3.0]);
    let start_s = arm.ms as f64 / 1000.0;
    arm.until(start_s + 20.0);
    let roll_deg = Attitude::decode(&only(&arm.out.can1, Attitude::ID)).unwrap().roll_deg;
    assert!((2.7..=3.0).contains(&roll_deg), "stops up to 0.2 short: {roll_deg}");
    let u_ma = (80.0 / 3.0 * roll_deg) as i32;
    for (side, got) in arm.u_ma().into_iter().enumerate() {
        let wanted = if side % 2 == 0 { u_ma } else { -u_ma };
        assert!((got - wanted).abs() <= 1, "{:?}", arm.u_ma());
    }
}

#[test]
fn references_come_in_over_five_seconds_from_where_the_machine_stands() {
    let mut arm = arm();
    arm.pins.stroke_mv = PerWheel::splat(stroke_mv(200));
    arm.until(6.0);
    arm.press(11);
    arm.buttons = Some(vec![18]);
    arm.ticks(5);
    let begun = arm.ms - 10;
    arm.buttons = Some(Vec::new());
    // 50 mm to raise: 84.7 mA in the end, half of it after 2.5 s.
    let mut at = |ms: u64| {
        while arm.ms <= begun + ms {
            arm.tick();
        }
        arm.u_ma()[0]
    };
    assert_eq!(at(10), 0);
    assert_eq!(at(2500), -42);
    assert_eq!(at(4990), -83);
    assert_eq!(at(5000), -84);
}

#[test]
fn buttons_13_and_14_shift_the_height_by_50_mm_a_second_within_their_ends() {
    let mut arm = levelling(11);
    arm.until(13.0);
    assert_eq!(arm.display().height_reference_mm, 250.0);
    let mut hold = |button, ticks| {
        arm.buttons = Some(vec![button]);
        arm.ticks(ticks);
        arm.buttons = Some(Vec::new());
        arm.ticks(2);
        (arm.display().height_reference_mm, arm.u_ma()[0], arm.is_levelling())
    };
    assert_eq!(hold(13, 100), (200.0, 84, true));
    assert_eq!(hold(13, 500).0, 100.0);
    assert_eq!(hold(14, 900), (350.0, -169, true));
}

#[test]
fn the_force_part_waits_for_half_a_percent_and_takes_a_tick() {
    let mut arm = levelling(12);
    // All alike: centre at half of the track; rear wheels carry more than the optimum there.
    arm.pins.pressure_a_mv = PerWheel::splat(1500.0);
    arm.until(13.0);
    let centre = CentreOfMass::decode(&only(&arm.out.can1, CentreOfMass::ID)).unwrap();
    assert_eq!((centre.lateral_percent, centre.longitudinal_percent), (50.0, 53.0));
    let error = ForceErrRear::decode(&only(&arm.out.can1, ForceErrRear::ID)).unwrap();
    let sums = OptLoadRear::decode(&only(&arm.out.can1, OptLoadRear::ID)).unwrap();
    assert!((sums.sum_positive_dan - sums.sum_reference_dan).abs() <= 1.0);
    // Equal forces at 3.25 m are the optimum: errors are below a percent, parts below 2 mA.
    assert!(error.bl_percent.abs() <= 1.0 && arm.u_ma().iter().all(|u| u.abs() <= 2));
    // Half the load off one wheel: it is to carry more, so it extends.
    arm.pins.pressure_a_mv.0[0] = 1000.0;
    arm.ticks(300);
    assert!(arm.u_ma()[0] < -20, "{:?}", arm.u_ma());
    assert!(arm.u_ma()[1] > 0, "its neighbour carries too much");
}

/// Below 8 V it goes dark, and wakes with all forgotten: no gains, no mode, five seconds to wait.
#[test]
fn a_brown_out_shuts_the_valves_and_forgets_the_gains() {
    let mut arm = levelling(11);
    arm.until(13.0);
    arm.pins.stroke_mv = PerWheel::splat(stroke_mv(240));
    arm.tick();
    assert_eq!(arm.u_ma(), [-16; 6]);
    arm.pins.supply_mv = 6_000.0;
    arm.tick();
    assert_eq!((arm.u_ma(), arm.out.can1.frames().len()), ([0; 6], 0));
    arm.pins.supply_mv = 24_000.0;
    arm.ticks(30);
    let started = arm.out.can1.frames().len();
    assert_eq!((started, arm.is_levelling(), arm.u_ma()), (32, false, [0; 6]));
    arm.press(18);
    assert!(!arm.is_levelling(), "too early");
    arm.ticks(500);
    arm.press(18);
    arm.ticks(600);
    assert_eq!((arm.is_levelling(), arm.u_ma()), (true, [0; 6]), "no gains");
}
