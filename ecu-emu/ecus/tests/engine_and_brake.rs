//! The drive ECU's engine link, brake and display frame, on the bus.

use xt28_dbc::messages::{DriveStatus, DriveStatusState, DriveTarget, Eec1, Et1, MachineStatus};
use xt28_dbc::{CanId, Frame};
use xt28_ecus::{DriveEcu, DriveOutputs, DrivePins, Port, State, pins};
use xt28_machine::{Machine, PerWheel, SimTime, Wheel};

/// Fault bit of a silent engine.
const ENGINE_FAULT: u16 = 1 << 4;

struct Rig {
    ecu: DriveEcu,
    out: DriveOutputs,
    /// Of all wheels, on 0.74 m.
    speed_m_s: f64,
    ms: u64,
}

impl Rig {
    fn new() -> Self {
        let (ecu, out) = (DriveEcu::new(&Machine::xt28()), DriveOutputs::default());
        Self { ecu, out, speed_m_s: 0.0, ms: 0 }
    }

    fn now(&self) -> SimTime {
        SimTime::from_millis(self.ms)
    }

    fn command(&mut self, throttle_percent: f64, brake: bool) {
        let target = DriveTarget {
            throttle_percent,
            front_angle_deg: 0.0,
            engine_speed_rpm: 1200.0,
            brake,
            enable: true,
            counter: (self.ms / 10 % 16) as u8,
        };
        self.ecu.on_frame(self.now(), Port::Can1, &target.encode().unwrap());
    }

    fn tick(&mut self) -> (DriveStatus, MachineStatus) {
        let pins = DrivePins {
            joint_front_mv: pins::joint_front_mv(10.0_f64.to_radians()),
            joint_rear_mv: pins::joint_rear_mv((-5.0_f64).to_radians()),
            wheel_hz: PerWheel::splat(pins::wheel_hz(self.speed_m_s / 0.74)),
            wheel_forward: PerWheel::splat(true),
            pump_mv: [pins::pump_mv(25e5); 4],
            supply_mv: 24_000.0,
        };
        self.ecu.tick(self.now(), &pins, &mut self.out);
        self.ms += 10;
        let status = DriveStatus::decode(self.sent(DriveStatus::ID)).unwrap();
        (status, MachineStatus::decode(self.sent(MachineStatus::ID)).unwrap())
    }

    fn sent(&self, id: CanId) -> &Frame {
        self.out.can1.frames().iter().find(|frame| frame.id() == id).expect("sent every tick")
    }
}

#[test]
fn a_braked_machine_is_not_driven() {
    let mut rig = Rig::new();
    for _ in 0..50 {
        rig.command(80.0, true);
        let (status, display) = rig.tick();
        assert_eq!((status.state, status.brake), (DriveStatusState::Active, true));
        assert_eq!((display.parking_brake, display.drive_mode), (4, 1));
        assert!(!rig.out.brake_released);
        assert_eq!(rig.out.pump_ma, [0.0; 4]);
        assert_eq!(rig.out.motor_ma[Wheel::Ml], 0.0, "full displacement");
    }
}

/// Pumps that push on while the throttle's lag runs out would do so against a closed brake.
#[test]
fn a_brake_at_speed_shuts_the_pumps_at_once() {
    let mut rig = Rig::new();
    rig.speed_m_s = 0.9;
    for _ in 0..200 {
        rig.command(60.0, false);
        rig.tick();
    }
    // Above a third of full speed the pumps are full.
    assert!((rig.out.pump_ma[1] - 605.0).abs() < 1e-9, "{:?}", rig.out.pump_ma);
    for _ in 0..20 {
        rig.command(60.0, true);
        let (status, display) = rig.tick();
        assert!(status.brake && !rig.out.brake_released);
        assert_eq!(rig.out.pump_ma, [0.0; 4]);
        assert_eq!(rig.out.motor_ma, PerWheel::splat(0.0), "full displacement");
        assert_eq!(display.drive_mode, 1, "neutral");
    }
    // Released, it sets off as from rest.
    rig.command(60.0, false);
    rig.tick();
    let demand = 0.6 * (1.0 - (-0.01_f64 / 0.15).exp());
    let pump_ma = rig.out.pump_ma[1];
    assert!((pump_ma - (195.0 + 410.0 * 3.0 * demand)).abs() < 1e-9, "{pump_ma}");
}

/// A machine that creeps down a slope at 0.03 m/s still rolls; one at 0.015 m/s stands.
#[test]
fn a_safe_stop_brakes_no_machine_that_still_creeps() {
    let mut rig = Rig::new();
    rig.speed_m_s = 0.03;
    rig.command(20.0, false);
    for _ in 0..100 {
        assert!(!rig.tick().0.brake);
    }
    assert_eq!(rig.ecu.state(), State::SafeStop);
    rig.speed_m_s = 0.015;
    assert!(rig.tick().0.brake);
}

/// Facts 2.5: 1 neutral, 4 forward, 16 reverse; turn mode 64 follow; half degrees, left > 0.
#[test]
fn the_display_is_told_direction_and_joints() {
    for (throttle, mode) in [(60.0, 4), (-60.0, 16), (0.0, 1)] {
        let mut rig = Rig::new();
        rig.command(throttle, false);
        let (_, display) = rig.tick();
        assert_eq!((display.drive_mode, display.parking_brake, display.turn_mode), (mode, 0, 64));
        assert_eq!((display.front_joint_deg, display.rear_joint_deg), (10.0, -5.0));
    }
}

/// 60 % of throttle is 3.96 % of demand after a tick of 0.15 s lag: side B, three times as much.
#[test]
fn forward_is_side_b_of_both_pumps() {
    let mut rig = Rig::new();
    rig.command(60.0, false);
    rig.tick();
    let demand = 0.6 * (1.0 - (-0.01_f64 / 0.15).exp());
    let [a1, b1, a2, b2] = rig.out.pump_ma;
    assert_eq!((a1, a2), (0.0, 0.0));
    for ma in [b1, b2] {
        assert!((ma - (195.0 + 410.0 * 3.0 * demand)).abs() < 1e-9, "{ma}");
    }
}

#[test]
fn a_silent_engine_is_reported_and_its_speed_shown() {
    let mut rig = Rig::new();
    let (status, _) = rig.tick();
    assert_eq!(status.faults & ENGINE_FAULT, ENGINE_FAULT, "not heard yet");
    let eec1 = Eec1 { engine_speed_rpm: 1250.0 }.encode().unwrap();
    // The same frame on another bus is not the engine's.
    rig.ecu.on_frame(rig.now(), Port::Can2, &eec1);
    assert_eq!(rig.tick().0.faults & ENGINE_FAULT, ENGINE_FAULT);
    rig.ecu.on_frame(rig.now(), Port::Can3, &eec1);
    let heard_ms = rig.ms;
    loop {
        let age_ms = rig.ms - heard_ms;
        let (status, display) = rig.tick();
        assert_eq!(display.engine_speed_rpm, 1250.0);
        assert_eq!(status.faults & ENGINE_FAULT != 0, age_ms > 200, "after {age_ms} ms");
        if age_ms > 200 {
            break;
        }
    }
}

/// Facts 2.5: -40 before the first frame, and no more than a signed byte can say. 215 is "not available".
#[test]
fn coolant_is_shown_once_the_engine_has_spoken_of_it() {
    let mut rig = Rig::new();
    let mut shown = |coolant_deg_c: Option<f64>| {
        if let Some(coolant_deg_c) = coolant_deg_c {
            let frame = Et1 { coolant_deg_c }.encode().unwrap();
            rig.ecu.on_frame(rig.now(), Port::Can3, &frame);
        }
        let (_, display) = rig.tick();
        // A machine of the paper steers by following, from a seat to the front.
        assert_eq!((display.turn_mode, display.chair), (64, 0));
        display.coolant_deg_c
    };
    let heard = [None, Some(85.0), None, Some(215.0), Some(128.0)];
    assert_eq!(heard.map(&mut shown), [-40.0, 85.0, 85.0, 85.0, 127.0]);
}
