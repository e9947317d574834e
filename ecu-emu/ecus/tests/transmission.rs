//! The transmission through pins and frames: target speed, wheels that spin, an engine that is dragged.

use xt28_dbc::messages::{DriveTarget, Eec1};
use xt28_ecus::{DriveEcu, DriveOutputs, DrivePins, Port, pins};
use xt28_machine::{Machine, PerWheel, SimTime, Wheel};

struct Rig {
    ecu: DriveEcu,
    out: DriveOutputs,
    pins: DrivePins,
    engine_rpm: f64,
    asked_rpm: f64,
    ticks: u32,
}

impl Rig {
    /// All wheels at 0.5 rad/s, straight ahead, engine at its working speed.
    fn new() -> Self {
        Self {
            ecu: DriveEcu::new(&Machine::xt28()),
            out: DriveOutputs::default(),
            pins: DrivePins {
                joint_front_mv: pins::joint_front_mv(0.0),
                joint_rear_mv: pins::joint_rear_mv(0.0),
                wheel_hz: PerWheel::splat(pins::wheel_hz(0.5)),
                wheel_forward: PerWheel::splat(true),
                pump_mv: [pins::pump_mv(25e5); 4],
                supply_mv: 24_000.0,
            },
            engine_rpm: 1200.0,
            asked_rpm: 1200.0,
            ticks: 0,
        }
    }

    fn drive(&mut self, throttle_percent: f64, seconds: f64) {
        for _ in 0..(seconds * 100.0) as u32 {
            let now = SimTime::from_millis(u64::from(self.ticks) * 10);
            let target = DriveTarget {
                throttle_percent,
                front_angle_deg: 0.0,
                engine_speed_rpm: self.asked_rpm,
                brake: false,
                enable: true,
                counter: (self.ticks % 16) as u8,
            };
            self.ecu.on_frame(now, Port::Can1, &target.encode().unwrap());
            let eec1 = Eec1 { engine_speed_rpm: self.engine_rpm };
            self.ecu.on_frame(now, Port::Can3, &eec1.encode().unwrap());
            self.ecu.tick(now, &self.pins, &mut self.out);
            self.ticks += 1;
        }
    }

    /// Displacements of the two pumps, + forward.
    fn pumps(&self) -> [f64; 2] {
        let [a1, b1, a2, b2] = self.out.pump_ma;
        [pins::pump_displacement(a1, b1), pins::pump_displacement(a2, b2)]
    }

    fn motors(&self) -> PerWheel<f64> {
        self.out.motor_ma.map(pins::motor_displacement)
    }

    /// Speed over full speed that displacements and engine make: the flow over the motors' volume.
    fn speed_share(&self) -> f64 {
        let [one, two] = self.pumps();
        (one + two) / 2.0 / self.motors().mean() / 3.0 * self.engine_rpm / 1200.0
    }
}

#[test]
fn the_throttle_sets_the_speed_at_any_speed_of_the_engine() {
    for (throttle_percent, engine_rpm) in
        [(20.0, 1200.0), (60.0, 1200.0), (60.0, 1600.0), (30.0, 900.0)]
    {
        let mut rig = Rig::new();
        (rig.engine_rpm, rig.asked_rpm) = (engine_rpm, engine_rpm);
        rig.drive(throttle_percent, 3.0);
        let off = rig.speed_share() - throttle_percent / 100.0;
        assert!(off.abs() < 0.005, "{throttle_percent} % at {engine_rpm} rpm: {off} off");
    }
}

#[test]
fn a_wheel_in_the_air_leaves_its_circuit_s_torque_to_the_others() {
    let mut rig = Rig::new();
    rig.pins.wheel_hz[Wheel::Mr] = pins::wheel_hz(1.5);
    rig.drive(30.0, 4.0);
    let (motors, [one, two]) = (rig.motors(), rig.pumps());
    assert!(motors[Wheel::Mr] < 0.32 && motors[Wheel::Fl] == 1.0, "{motors:?}");
    // Circuit 2 keeps its speed: less flow for less volume.
    assert!((two / one - (2.0 + motors[Wheel::Mr]) / 3.0).abs() < 0.01, "{one} {two}");
    // It has come down: the trim goes.
    rig.pins.wheel_hz[Wheel::Mr] = pins::wheel_hz(0.5);
    rig.drive(30.0, 5.0);
    assert_eq!(rig.motors(), PerWheel::splat(1.0));
}

/// A machine that runs out keeps what it has: a wheel that finds grip again on the way would be asked for
/// more just as all others are asked for less.
#[test]
fn a_trim_stays_while_the_machine_runs_out_and_is_gone_at_its_end() {
    let mut rig = Rig::new();
    rig.pins.wheel_hz[Wheel::Mr] = pins::wheel_hz(1.5);
    rig.drive(30.0, 4.0);
    let spinning = rig.motors()[Wheel::Mr];
    assert!((spinning - 0.3).abs() < 1e-3, "{spinning}");
    rig.pins.wheel_hz[Wheel::Mr] = pins::wheel_hz(0.5);
    // The lag of 0.15 s leaves 0.3 exp(-0.5 / 0.15) = 1 % of demand after half a second.
    rig.drive(0.0, 0.5);
    let [one, two] = rig.pumps();
    assert!(one > 0.02 && two > 0.02, "{one} {two}: still running out");
    assert_eq!(rig.motors()[Wheel::Mr], spinning);
    rig.drive(0.0, 1.5);
    assert_eq!(rig.pumps(), [0.0; 2]);
    assert_eq!(rig.motors(), PerWheel::splat(1.0));
}

#[test]
fn a_bend_is_no_slip() {
    let mut rig = Rig::new();
    let bend_rad = [25.0_f64.to_radians(), 14.0_f64.to_radians()];
    rig.pins.joint_front_mv = pins::joint_front_mv(bend_rad[0]);
    rig.pins.joint_rear_mv = pins::joint_rear_mv(bend_rad[1]);
    // Front axle's curvature: sin 25 / (1.85 (1 + cos 25)) = 0.120 / m.
    for (wheel, hz) in rig.pins.wheel_hz.0.iter_mut().enumerate() {
        let side = if wheel % 2 == 0 { 1.0 } else { -1.0 };
        *hz = pins::wheel_hz(0.6 * (1.0 + side * 0.120 * 1.175));
    }
    rig.drive(40.0, 3.0);
    let alike = rig.motors().0.iter().all(|m| *m == rig.motors().0[0]);
    assert!(alike, "{:?}", rig.motors());
}

#[test]
fn a_dragged_engine_is_asked_for_less_and_recovers() {
    let mut rig = Rig::new();
    rig.drive(30.0, 2.0);
    let free = rig.pumps()[0];
    rig.engine_rpm = 0.80 * 1200.0;
    rig.drive(30.0, 0.1);
    let dragged = rig.pumps()[0];
    // (0.80 - 0.75) / (0.93 - 0.75) of the demand.
    assert!((dragged / free - 0.278).abs() < 0.01, "{dragged} of {free}");
    rig.engine_rpm = 1200.0;
    rig.drive(30.0, 10.0);
    assert!((rig.pumps()[0] - free).abs() < 1e-4);
}

/// Asked for more it takes its time, and is not dragged meanwhile: 400 rpm more with a governor of 0.3 s. The
/// throttle's own lag is shorter, so the machine slows down a little; taken for dragged, it would nearly stop.
#[test]
fn an_engine_that_still_speeds_up_is_not_dragged() {
    let mut rig = Rig::new();
    rig.drive(30.0, 2.0);
    rig.asked_rpm = 1600.0;
    let mut slowest = f64::MAX;
    for tick in 0..1000 {
        rig.engine_rpm = 1600.0 - 400.0 * (-f64::from(tick) / 30.0).exp();
        rig.drive(30.0, 0.01);
        slowest = slowest.min(rig.speed_share());
    }
    assert!((0.25..0.30).contains(&slowest), "{slowest}");
    assert!((rig.speed_share() - 0.30).abs() < 0.005);
    let free = rig.pumps()[0];
    rig.engine_rpm = 0.80 * 1600.0;
    rig.drive(30.0, 0.1);
    assert!((rig.pumps()[0] / free - 0.278).abs() < 0.01, "dragged then as ever");
}
