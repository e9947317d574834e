//! Filtered signals as they leave the arm ECU: pressures, stroke rates, attitude.

use xt28_dbc::messages::{
    AccelCopy, ArmStatus, Attitude, GyroCopy, PressFront, VelFront, VelMidRear,
};
use xt28_dbc::{CanId, Frame};
use xt28_ecus::{ArmEcu, ArmOutputs, ArmPins, Port, pins};
use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, SimTime};

/// Fault bit of a silent inertial unit.
const ATTITUDE_FAULT: u16 = 1 << 2;

struct Rig {
    ecu: ArmEcu,
    out: ArmOutputs,
    pins: ArmPins,
    ms: u64,
}

impl Rig {
    fn new() -> Self {
        let pins = ArmPins {
            stroke_mv: PerWheel::splat(pins::stroke_mv(0.2)),
            pressure_a_mv: PerWheel::splat(pins::pressure_mv(0.0)),
            pressure_b_mv: PerWheel::splat(pins::pressure_mv(0.0)),
            supply_mv: 24_000.0,
        };
        Self { ecu: ArmEcu::new(&Machine::xt28()), out: ArmOutputs::default(), pins, ms: 0 }
    }

    fn now(&self) -> SimTime {
        SimTime::from_millis(self.ms)
    }

    fn imu(&mut self, rate_rad_s: [f64; 3], force_m_s2: [f64; 3]) {
        for frame in pins::imu_frames(rate_rad_s, force_m_s2) {
            self.ecu.on_frame(self.now(), Port::Can2, &frame);
        }
    }

    fn tick(&mut self) {
        self.ecu.tick(self.now(), &self.pins, &mut self.out);
        self.ms += 10;
    }

    fn sent(&self, id: CanId) -> &Frame {
        self.out.can1.frames().iter().find(|frame| frame.id() == id).expect("sent every tick")
    }

    fn attitude(&self) -> Attitude {
        Attitude::decode(self.sent(Attitude::ID)).unwrap()
    }

    fn faults(&self) -> u16 {
        ArmStatus::decode(self.sent(ArmStatus::ID)).unwrap().faults
    }
}

/// p <- trunc(0.94088 p + 0.05912 * 10000), run by hand from 0 (facts 3.2).
#[test]
fn a_pressure_step_rises_along_the_firmware_s_filter() {
    let mut rig = Rig::new();
    rig.tick();
    rig.pins.pressure_a_mv = PerWheel::splat(pins::pressure_mv(10e6));
    for tick in 1..=40 {
        rig.tick();
        let got = PressFront::decode(rig.sent(PressFront::ID)).unwrap().fl_a_kpa;
        let by_hand = [(1, 591.0), (10, 4560.0), (17, 6446.0), (40, 9119.0)];
        if let Some((_, kpa)) = by_hand.iter().find(|(at, _)| *at == tick) {
            assert_eq!(got, *kpa, "tick {tick}");
        }
    }
}

/// One tick's change of 11, 22 .. 66 mm gives 5 / 1.1 of it: 50, 100 .. 300 counts of 2 mm/s.
#[test]
fn stroke_rates_keep_their_places() {
    let mut rig = Rig::new();
    rig.tick();
    let mm = [11.0, -22.0, 33.0, -44.0, 55.0, -66.0];
    rig.pins.stroke_mv = PerWheel(mm.map(|mm| pins::stroke_mv(0.2 + (mm + 0.01) * 1e-3)));
    rig.tick();
    let front = VelFront::decode(rig.sent(VelFront::ID)).unwrap();
    let rest = VelMidRear::decode(rig.sent(VelMidRear::ID)).unwrap();
    let got =
        [front.fr_mm_s, front.fl_mm_s, rest.mr_mm_s, rest.ml_mm_s, rest.br_mm_s, rest.bl_mm_s];
    assert_eq!(got, [100.0, -200.0, 300.0, -400.0, 500.0, -600.0]);
    // Their mean, 50 - 100 + 150 - 200 + 250 - 300 over six, is cut off.
    assert_eq!(rig.attitude().mean_stroke_rate, -25);
}

#[test]
fn a_lean_is_seen_with_the_machine_s_signs() {
    let mut rig = Rig::new();
    // Nose up by 4 deg: the x axis points up a little. Right side high by 2 deg: y points down.
    let (pitch, roll) = (4.0_f64.to_radians(), 2.0_f64.to_radians());
    let up = (1.0 - pitch.sin().powi(2) - roll.sin().powi(2)).sqrt();
    let force = [pitch.sin(), -roll.sin(), up].map(|f| f * GRAVITY_M_S2);
    rig.imu([0.0; 3], force);
    rig.tick();
    let still = rig.attitude();
    assert!((still.pitch_deg - 4.0).abs() < 0.05, "{still:?}");
    assert!((still.roll_deg - 2.0).abs() < 0.05, "{still:?}");

    // A tick of 60 deg/s nose down and 30 deg/s right side down takes 0.6 and 0.3 deg away.
    rig.imu([30.0_f64.to_radians(), 60.0_f64.to_radians(), 0.0], force);
    rig.tick();
    let turned = rig.attitude();
    assert!((still.pitch_deg - turned.pitch_deg - 0.6).abs() < 0.02, "{turned:?}");
    assert!((still.roll_deg - turned.roll_deg - 0.3).abs() < 0.02, "{turned:?}");

    let rates = GyroCopy::decode(rig.sent(GyroCopy::ID)).unwrap();
    assert_eq!((rates.pitch_rate_deg_s, rates.roll_rate_deg_s), (-60.0, -30.0));
    let copy = AccelCopy::decode(rig.sent(AccelCopy::ID)).unwrap();
    assert_eq!((copy.x, copy.y), (35, -70), "X shows roll, Y pitch");
    assert_eq!(copy.z, (up * 1000.0).round() as i16);
}

#[test]
fn a_silent_inertial_unit_is_reported_and_stops_nothing() {
    let mut rig = Rig::new();
    rig.imu([0.0; 3], [0.0, 0.0, GRAVITY_M_S2]);
    let silent: Vec<bool> = (0..8)
        .map(|_| {
            rig.tick();
            rig.faults() & ATTITUDE_FAULT != 0
        })
        .collect();
    // Frames at 0 ms; lost once they are more than 50 ms old.
    assert_eq!(silent, [false, false, false, false, false, false, true, true]);
    rig.imu([0.0; 3], [0.0, 0.0, GRAVITY_M_S2]);
    rig.tick();
    assert_eq!(rig.faults(), 0);
}
