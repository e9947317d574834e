//! Joints and drive alone, driven by the whole vehicle's own signals: what they load the bodies with, to the bit.

mod overheard;

use core::time::Duration;
use std::path::Path;

use overheard::Overheard;
use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::effects::Overlay;
use xt28_sim::{
    Actuation, Bodies, Drive, DriveInput, DriveState, Effects, HingeMotion, Plant, RapierBodies,
    ReducedBodies, RollingDrag, STEP, Steering, SteeringInput, SteeringState, Terrain, Vehicle,
    VehicleState,
};

/// Torque with which the parking brake holds each wheel, Nm.
const BRAKE_NM: f64 = 20_000.0;
/// Rate over which rolling resistance fades at rest, rad/s.
const DRAG_FADE_RAD_S: f64 = 0.05;

/// Everything varies: pumps forward and back, each motor between a third and full, the engine between 800 and 1600
/// rpm, the brake on for two seconds of every seven.
fn driven(t_s: f64) -> Actuation {
    let sine = |rate: f64, phase: f64| (rate * t_s + phase).sin();
    Actuation {
        arm_opening: PerWheel::from_fn(|w| 0.3 * sine(1.0 + 0.1 * w.index() as f64, 0.0)),
        steer_opening: [sine(0.7, 0.0), 0.5 * sine(0.7, 0.0)],
        pump_displacement: [0.2 + 0.8 * sine(0.6, 0.0), 0.2 + 0.7 * sine(0.6, 0.3)],
        motor_displacement: PerWheel::from_fn(|w| 0.66 + 0.33 * sine(0.9, w.index() as f64)),
        engine_speed_rpm: 1200.0 + 400.0 * sine(0.4, 1.0),
        brake_released: t_s.rem_euclid(7.0) < 5.0,
    }
}

/// Joints and drive of one machine without a vehicle.
struct Alone {
    steering: [Steering; 2],
    joints: [SteeringState; 2],
    drive: Drive,
    shaft: DriveState,
    rolling_resistance_m: PerWheel<f64>,
}

impl Alone {
    fn new(machine: &Machine, effects: &Effects, dt_s: f64) -> Self {
        let steering = Steering::both(machine, &effects.steering);
        let drive = Drive::new(machine, effects);
        let w = &machine.wheels;
        let resistance_m = |wheel: Wheel| {
            let added = effects.wheels[wheel].rolling_resistance.added;
            (w.rolling_resistance + added).max(0.0) * w.radius_m
        };
        Self {
            joints: steering.each_ref().map(|joint| joint.straight(dt_s)),
            shaft: drive.at_rest(dt_s),
            steering,
            drive,
            rolling_resistance_m: PerWheel::from_fn(resistance_m),
        }
    }

    /// Steps on what the vehicle was told and what it measured before; all that it then loaded its bodies with must be
    /// what comes of it. Tolerance: none, to the bit, since nothing between them and the bodies is hidden.
    fn assert_reproduces<B: Bodies>(
        &mut self,
        actuation: &Actuation,
        before: &VehicleState,
        vehicle: &Vehicle<Overheard<B>>,
        dt_s: f64,
    ) {
        let (after, loads) = (vehicle.state(), &vehicle.bodies().loads);
        for (i, joint) in self.joints.iter_mut().enumerate() {
            let (angle_rad, rate_rad_s) = (before.joint_rad[i], before.joint_rate_rad_s[i]);
            let opening = actuation.steer_opening[i];
            self.steering[i].step(joint, &SteeringInput { opening, angle_rad, rate_rad_s }, dt_s);
            let spring = self.steering[i].spring(joint, HingeMotion { angle_rad, rate_rad_s });
            assert_eq!(spring, loads.joint[i]);
        }
        let input = DriveInput {
            pump_displacement: actuation.pump_displacement,
            motor_displacement: actuation.motor_displacement,
            engine_speed_rpm: actuation.engine_speed_rpm,
            wheel_speed_rad_s: before.wheel_speed_rad_s,
        };
        let out = self.drive.step(&mut self.shaft, &input, dt_s);
        assert_eq!(out.wheel_torque_nm, loads.drive_nm);
        assert_eq!(out.wheel_torque_nm, after.wheel_torque_nm);
        assert_eq!(out.pump_pressure_pa, after.pump_pressure_pa);
        assert_eq!(out.engine_speed_rpm, after.engine_speed_rpm);
        let brake_nm = if actuation.brake_released { 0.0 } else { BRAKE_NM };
        for w in Wheel::ALL {
            assert_eq!(out.hold_nm[w] + brake_nm, loads.hold_nm[w], "{w}");
            let most_nm = self.rolling_resistance_m[w] * before.ground_force_n[w].max(0.0);
            let rate_rad_s = before.wheel_speed_rad_s[w];
            let drag = RollingDrag::tanh(most_nm, DRAG_FADE_RAD_S, rate_rad_s);
            assert_eq!(drag, loads.drag[w], "{w}");
        }
    }
}

fn reproduced<B: Bodies>(effects: &Effects) {
    let (machine, strokes) = (Machine::xt28(), PerWheel::splat(0.17));
    let mut vehicle: Vehicle<Overheard<B>> =
        Vehicle::with(&machine, effects, &Terrain::Flat, strokes, STEP);
    let dt_s = STEP.as_secs_f64();
    let mut alone = Alone::new(&machine, effects, dt_s);
    let (mut fastest_rad_s, mut slowest_rad_s) = (0.0_f64, 0.0_f64);
    for step in 0..3000 {
        let actuation = driven(f64::from(step) * dt_s);
        let before = *vehicle.state();
        vehicle.step(&actuation);
        alone.assert_reproduces(&actuation, &before, &vehicle, dt_s);
        let mean_rad_s = before.wheel_speed_rad_s.mean();
        fastest_rad_s = fastest_rad_s.max(mean_rad_s);
        slowest_rad_s = slowest_rad_s.min(mean_rad_s);
    }
    assert!(fastest_rad_s > 0.5 && slowest_rad_s < -0.1, "{fastest_rad_s}, {slowest_rad_s}");
}

#[test]
fn blocks_alone_reproduce_the_whole() {
    reproduced::<RapierBodies>(&Effects::default());
    reproduced::<ReducedBodies>(&Effects::default());
}

/// The same of blocks with effects, each of which has a memory or a law of its own.
#[test]
fn blocks_with_effects_alone_reproduce_the_whole() {
    let text = |name: &str, values: &str| format!("[[effect]]\nname = \"{name}\"\n{values}\n");
    let late = text("steer-delay", "delay_s = 0.1") + &text("throttle-delay", "delay_s = 0.2");
    let slow = text("steer-lag", "time_constant_s = 0.2")
        + &text("steer-rate", "factor = 0.7")
        + &text("drive-lag", "time_constant_s = 0.3\nlead_s = 0.1");
    let loose = text("steer-backlash", "width_rad = 0.03")
        + &text("engine-droop", "droop_per_w = 2e-6\npower_factor = 0.05");
    let sticky = text("standstill-drag", "scope = \"front\"\ntorque_nm = 3000")
        + &text("rolling-resistance", "scope = \"left\"\nadded = 0.1");
    for text in [late, slow, loose, sticky] {
        let effects =
            Overlay::parse(&text, Path::new("o.toml")).unwrap().effects(&Machine::xt28()).unwrap();
        assert_ne!(effects, Effects::default());
        reproduced::<RapierBodies>(&effects);
    }
}

/// A machine taken up with its joints beyond their largest angles, where the frames meet metal: it pushes them back
/// as the block alone has it.
#[test]
fn joints_beyond_their_stops_alone_reproduce_the_whole() {
    let (machine, effects, dt_s) = (Machine::xt28(), Effects::default(), STEP.as_secs_f64());
    let max_rad = machine.articulation.angle_max_deg.to_radians();
    let mut bent = *Vehicle::new(&machine, &Terrain::Flat, PerWheel::splat(0.17)).state();
    bent.joint_rad = [max_rad + 0.01, -max_rad - 0.01];
    let actuation = Actuation { steer_opening: [1.0, -1.0], ..Actuation::idle(1200.0) };
    let mut vehicle = Vehicle::<Overheard<RapierBodies>>::from_measured(
        &machine,
        &effects,
        &Terrain::Flat,
        STEP,
        &bent,
        &actuation,
        Duration::ZERO,
    );
    let steering = Steering::both(&machine, &effects.steering);
    let motion = |s: &VehicleState, i: usize| HingeMotion {
        angle_rad: s.joint_rad[i],
        rate_rad_s: s.joint_rate_rad_s[i],
    };
    let mut joints =
        [0, 1].map(|i| steering[i].resumed(actuation.steer_opening[i], motion(&bent, i), dt_s));
    let mut touched = [0; 2];
    for _ in 0..400 {
        let before = *vehicle.state();
        vehicle.step(&actuation);
        for (i, joint) in joints.iter_mut().enumerate() {
            let HingeMotion { angle_rad, rate_rad_s } = motion(&before, i);
            let opening = actuation.steer_opening[i];
            steering[i].step(joint, &SteeringInput { opening, angle_rad, rate_rad_s }, dt_s);
            let spring = steering[i].spring(joint, motion(&before, i));
            assert_eq!(spring, vehicle.bodies().loads.joint[i]);
            touched[i] += usize::from(spring.stiffness_nm > steering[i].stiffness_nm());
        }
    }
    assert!(touched.iter().all(|steps| *steps > 10), "{touched:?} steps against the metal");
}
