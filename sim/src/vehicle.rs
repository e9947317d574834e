//! The whole vehicle: the actuators' blocks joined to a solver of the rigid bodies.

mod resume;
mod track;

use core::time::Duration;

use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel};

use crate::actuators::Actuators;
use crate::blocks::Drive;
use crate::bodies::{Bodies, Motion};
use crate::{Actuation, Effects, Parts, Plant, RapierBodies, STEP, Terrain, Tilt, VehicleState};

/// Gravity in the world, m/s².
const DOWN_M_S2: [f64; 3] = [0.0, 0.0, -GRAVITY_M_S2];

/// A plant made of blocks and of a solver `B`. A clone is a snapshot: stepped alike, it goes on bit
/// for bit like the original. The terrain is shared, not copied.
#[derive(Clone, Debug)]
pub struct Vehicle<B = RapierBodies> {
    bodies: B,
    actuators: Actuators,
    front_com_m: [f64; 3],
    /// From there to the inertial unit, which sits where the machine file has the centre of mass;
    /// `None` where they are the same.
    com_to_imu_m: Option<[f64; 3]>,
    tilt: Option<Tilt>,
    antenna_m: [f64; 3],
    step_s: f64,
    /// A step is made of so many, in each of which the blocks act anew.
    turns: u32,
    motion: Motion,
    state: VehicleState,
}

impl Vehicle {
    /// The nominal machine on the reference solver, stepped every [`STEP`].
    #[must_use]
    pub fn new(machine: &Machine, terrain: &Terrain, stroke_m: PerWheel<f64>) -> Self {
        Self::with(machine, &Effects::default(), terrain, stroke_m, STEP)
    }
}

impl<B: Bodies> Vehicle<B> {
    /// The machine with `effects` on `terrain`, front axle at the origin heading east, arms at
    /// `stroke_m`, stepped every `step`.
    ///
    /// The arms start near their load, so the machine settles within about a second.
    ///
    /// The reference makes steps longer than [`STEP`] of several; the fast core takes them whole. Where wheels turn
    /// too lightly for their drive ([`Bodies::held_at_most_s`]), blocks and bodies take turns within a step, as
    /// often as it takes: nominal wheels need none of that; of an eighth of their inertia they need five turns
    /// a [`STEP`] on the reference and two on the fast core.
    #[must_use]
    pub fn with(
        machine: &Machine,
        effects: &Effects,
        terrain: &Terrain,
        stroke_m: PerWheel<f64>,
        step: Duration,
    ) -> Self {
        let parts = Parts::new(machine, effects);
        let step_s = step.as_secs_f64();
        let bodies = B::new(&parts, terrain, stroke_m);
        let slope_nms = Drive::slope_max_nms(machine);
        let held_s = B::held_at_most_s(parts.wheel.inertia_kg_m2[1], slope_nms);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let turns = (step_s / held_s).ceil().max(1.0) as u32;
        let mut vehicle = Self {
            motion: bodies.motion(),
            bodies,
            actuators: Actuators::new(machine, effects, stroke_m, step_s / f64::from(turns)),
            front_com_m: parts.frames[0].com_m,
            com_to_imu_m: {
                let (imu_m, com_m) = (machine.frames.front_com_m, parts.frames[0].com_m);
                (imu_m != com_m).then(|| core::array::from_fn(|i| imu_m[i] - com_m[i]))
            },
            tilt: parts.tilt,
            antenna_m: {
                let ([x, y, z], lever) =
                    (machine.sensors.gnss_antenna_m, effects.sensors.gnss_lever_arm);
                [x + lever.x_m, y + lever.y_m, z]
            },
            step_s,
            turns,
            state: VehicleState::default(),
        };
        vehicle.observe(vehicle.imu_velocity_m_s(&vehicle.motion));
        vehicle
    }

    /// The solver of the rigid bodies, to be looked at.
    #[must_use]
    pub const fn bodies(&self) -> &B {
        &self.bodies
    }

    /// Time in which blocks and bodies act once each, s.
    fn turn_s(&self) -> f64 {
        self.step_s / f64::from(self.turns)
    }

    /// Velocity of the inertial unit in this motion, along its axes.
    fn imu_velocity_m_s(&self, m: &Motion) -> [f64; 3] {
        let Some(lever_m) = self.com_to_imu_m else {
            return m.velocity_m_s;
        };
        let about_com = cross(m.rate_rad_s, from_frame(&m.axes, lever_m));
        core::array::from_fn(|i| m.velocity_m_s[i] + about_com[i])
    }

    /// Writes the state that the motion shows; `before_m_s` was the inertial unit's velocity a step ago.
    ///
    /// Solvers move the machine in the ground's axes; what is true of it is said in the world's.
    fn observe(&mut self, before_m_s: [f64; 3]) {
        let (level, level_before_m_s);
        let (m, before_m_s) = match self.tilt {
            None => (&self.motion, before_m_s),
            Some(tilt) => {
                level = self.motion.in_world(&tilt);
                level_before_m_s = tilt.to_world(before_m_s);
                (&level, level_before_m_s)
            }
        };
        let imu_m_s = self.imu_velocity_m_s(m);
        let s = &mut self.state;
        self.actuators.observe(m, s);
        s.joint_rad = m.joint.map(|joint| joint.angle_rad);
        s.joint_rate_rad_s = m.joint.map(|joint| joint.rate_rad_s);
        s.roll_hinge_rad = m.roll_hinge.angle_rad;
        s.roll_hinge_rate_rad_s = m.roll_hinge.rate_rad_s;
        s.wheel_speed_rad_s = m.wheel_rate_rad_s;
        s.ground_force_n = m.ground_force_n;
        s.chassis_force_n = m.chassis_force_n;
        let [x, y, z] = m.axes;
        s.position_m = m.position_m;
        s.yaw_rad = x[1].atan2(x[0]);
        s.pitch_rad = x[2].clamp(-1.0, 1.0).asin();
        s.roll_rad = -y[2].atan2(z[2]);
        let into_frame = |v: [f64; 3]| m.axes.map(|axis| dot(axis, v));
        s.front_rate_rad_s = into_frame(m.rate_rad_s);
        s.front_specific_force_m_s2 = into_frame(core::array::from_fn(|i| {
            (imu_m_s[i] - before_m_s[i]) / self.step_s - DOWN_M_S2[i]
        }));
        let antenna = from_frame(&m.axes, self.antenna_m);
        let com = from_frame(&m.axes, self.front_com_m);
        let about_com = cross(m.rate_rad_s, core::array::from_fn(|i| antenna[i] - com[i]));
        s.antenna_position_m = core::array::from_fn(|i| m.position_m[i] + antenna[i]);
        s.antenna_velocity_m_s = core::array::from_fn(|i| m.velocity_m_s[i] + about_com[i]);
    }
}

impl<B: Bodies> Plant for Vehicle<B> {
    fn step(&mut self, actuation: &Actuation) {
        let before_m_s = self.imu_velocity_m_s(&self.motion);
        let turns = f64::from(self.turns);
        let (mut ground_force_n, mut chassis_force_n) = (PerWheel::splat(0.0), 0.0);
        for _ in 0..self.turns {
            let turn_s = self.turn_s();
            let loads = self.actuators.step(actuation, &self.motion, &mut self.state, turn_s);
            self.bodies.advance(&loads, turn_s);
            self.motion = self.bodies.motion();
            let Motion { ground_force_n: on_wheels_n, chassis_force_n: on_frames_n, .. } =
                self.motion;
            ground_force_n = PerWheel::from_fn(|w| ground_force_n[w] + on_wheels_n[w] / turns);
            chassis_force_n += on_frames_n / turns;
        }
        self.motion = Motion { ground_force_n, chassis_force_n, ..self.motion };
        self.observe(before_m_s);
    }

    fn state(&self) -> &VehicleState {
        &self.state
    }
}

/// What has these coordinates along a frame's axes, in the axes' own world.
fn from_frame(axes: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = axes;
    core::array::from_fn(|i| v[0] * x[i] + v[1] * y[i] + v[2] * z[i])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
