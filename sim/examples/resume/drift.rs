//! A vehicle on a ramp, resumed from its own state, beside the vehicle itself.

use core::time::Duration;

use xt28_machine::{Machine, PerWheel};
use xt28_sim::{
    Actuation, Bodies, Effects, Placed, Plant, Ramp, STEP, Terrain, Vehicle, VehicleState,
};

/// Largest distances over a while.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Distance {
    /// Of any stroke, m.
    pub stroke_m: f64,
    /// Of roll or pitch, rad.
    pub attitude_rad: f64,
    /// Of the front frame, m.
    pub position_m: f64,
    /// Of either joint, rad.
    pub joint_rad: f64,
    /// Of any wheel's speed, rad/s.
    pub wheel_rad_s: f64,
}

/// How far a resumed vehicle is from the snapshot.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Drift {
    /// Within the first second.
    pub after_1_s: Distance,
    /// Within five.
    pub after_5_s: Distance,
}

/// The machine with its front free to roll, as its file describes it.
pub(crate) fn with_roll_hinge() -> Machine {
    let mut machine = Machine::xt28();
    machine.vehicle.roll_hinge = true;
    machine
}

/// What is asked of the machine, s after its start.
fn actuation(t_s: f64) -> Actuation {
    Actuation {
        pump_displacement: [(t_s / 2.0).min(1.0); 2],
        steer_opening: if t_s < 8.0 { [0.1, 0.06] } else { [-0.1, -0.06] },
        arm_opening: PerWheel::from_fn(|w| 0.1 * (t_s * (1.0 + w.index() as f64 * 0.1)).sin()),
        ..Actuation::idle(1200.0)
    }
}

/// The vehicle after `at_s` s of driving, and its ground.
pub(crate) fn drive<B: Bodies>(machine: &Machine, at_s: f64) -> (Vehicle<B>, Terrain) {
    let ramp = Ramp { x_m: [1.0, 3.0, 5.0, 7.0], height_m: 0.2, y_min_m: -1.9, y_max_m: -0.5 };
    let terrain = Terrain::ramp(&ramp);
    let effects = Effects::default();
    let mut vehicle = Vehicle::with(machine, &effects, &terrain, PerWheel::splat(0.17), STEP);
    let steps = (at_s / STEP.as_secs_f64()).round() as u32;
    (0..steps).for_each(|step| vehicle.step(&actuation(seconds(step))));
    (vehicle, terrain)
}

fn seconds(step: u32) -> f64 {
    f64::from(step) * STEP.as_secs_f64()
}

impl Drift {
    /// `machine` resumed from its state at `at_s`, and both driven on.
    pub(crate) fn of<B: Placed>(machine: &Machine, at_s: f64, warm: Duration) -> Self {
        let (mut vehicle, terrain) = drive::<B>(machine, at_s);
        let mut resumed: Vehicle<B> = Self::resumed(machine, vehicle.state(), &terrain, at_s, warm);
        let (mut drift, mut seen) = (Self::default(), Distance::default());
        for step in 0..1000 {
            let now = actuation(at_s + seconds(step));
            vehicle.step(&now);
            resumed.step(&now);
            seen.see(vehicle.state(), resumed.state());
            if step == 199 {
                drift.after_1_s = seen;
            }
        }
        drift.after_5_s = seen;
        drift
    }

    /// A `machine` taken up at `measured`, `at_s` s after the start.
    pub(crate) fn resumed<B: Placed>(
        machine: &Machine,
        measured: &VehicleState,
        terrain: &Terrain,
        at_s: f64,
        warm: Duration,
    ) -> Vehicle<B> {
        let (effects, now) = (Effects::default(), actuation(at_s));
        Vehicle::from_measured(machine, &effects, terrain, STEP, measured, &now, warm)
    }
}

impl Distance {
    fn see(&mut self, a: &VehicleState, b: &VehicleState) {
        let most = |pairs: &mut dyn Iterator<Item = (f64, f64)>| {
            pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        let wheels = |a: PerWheel<f64>, b: PerWheel<f64>| a.0.into_iter().zip(b.0);
        self.stroke_m = self.stroke_m.max(most(&mut wheels(a.stroke_m, b.stroke_m)));
        let attitude = [(a.roll_rad, b.roll_rad), (a.pitch_rad, b.pitch_rad)];
        self.attitude_rad = self.attitude_rad.max(most(&mut attitude.into_iter()));
        let place = a.position_m.into_iter().zip(b.position_m);
        let apart = place.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        self.position_m = self.position_m.max(apart);
        let joints = &mut a.joint_rad.into_iter().zip(b.joint_rad);
        self.joint_rad = self.joint_rad.max(most(joints));
        let speeds = &mut wheels(a.wheel_speed_rad_s, b.wheel_speed_rad_s);
        self.wheel_rad_s = self.wheel_rad_s.max(most(speeds));
    }
}
