//! A vehicle taken up in the middle of what was measured of a machine.

use core::time::Duration;

use xt28_machine::{Machine, PerWheel};

use super::{Vehicle, cross};
use crate::bodies::{HingeMotion, Motion, Placed};
use crate::{Actuation, Effects, Terrain, VehicleState};

impl<B: Placed> Vehicle<B> {
    /// The machine with `effects` on `terrain`, stepped every `step`, where `measured` has it while
    /// it does as `actuation` says.
    ///
    /// Attitude, positions, strokes, joint and roll hinge angles and their rates, wheel speeds and torques, cylinder
    /// loads, and the antenna's velocity count. What no sensor shows is made up for: the oil in each
    /// cylinder carries the measured load; the oil of a joint leads by its damping, without the tyres'
    /// scrub; the drive's integral explains the torques; valves and throttle have stood for long.
    /// Tyres are pressed in and strain along the ground by standing still in this motion for `warm`.
    ///
    /// Not a snapshot (that is a clone), but near one: on a ramp, in a bend, with all arms moving, and
    /// 50 ms of `warm`, the largest distances over 5 s are on rapier3d 0.6 mm of stroke, 0.8 mrad of
    /// roll and pitch, 18 mm of position and 9 mrad of a joint; on the fast core 0.5 mm, 0.7 mrad,
    /// 22 mm and 9 mrad. Nearly all of that comes in the first moment, when the joints take up the
    /// scrub. Longer `warm` betters nothing; without any, wheels on rapier3d start with 0.25 rad/s of
    /// error. The fast core's rigid wheels remember nothing and need none.
    /// A machine with a roll hinge, whose angle counts too, drifts by up to 2.9 mm of stroke and 4.8 mrad
    /// of roll and pitch: its front takes up the scrub as well.
    /// `cargo run --release -p xt28-sim --example resume` prints the table. It is of the nominal machine:
    /// what an effect hides from every sensor (where a worn joint lies in its backlash) is not made up for,
    /// and such a machine drifts by as much as that.
    #[must_use]
    pub fn from_measured(
        machine: &Machine,
        effects: &Effects,
        terrain: &Terrain,
        step: Duration,
        measured: &VehicleState,
        actuation: &Actuation,
        warm: Duration,
    ) -> Self {
        let mut vehicle = Self::with(machine, effects, terrain, measured.stroke_m, step);
        let motion = vehicle.motion_of(measured);
        vehicle.actuators.resume(measured, actuation, &motion, vehicle.turn_s());
        let steps = (warm.as_secs_f64() / vehicle.step_s).round();
        let mut ahead = vehicle.actuators.clone();
        let loads = ahead.step(actuation, &motion, &mut VehicleState::default(), vehicle.turn_s());
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        for _ in 0..steps as u32 {
            vehicle.bodies.place(&motion);
            vehicle.bodies.advance(&loads, vehicle.step_s);
        }
        vehicle.bodies.place(&motion);
        let ground_force_n = vehicle.bodies.motion().ground_force_n;
        vehicle.motion = Motion { ground_force_n, ..vehicle.bodies.motion() };
        vehicle.state = *measured;
        vehicle.observe(vehicle.imu_velocity_m_s(&vehicle.motion));
        vehicle.state.front_specific_force_m_s2 = measured.front_specific_force_m_s2;
        vehicle
    }

    /// The rigid bodies' motion that shows as this state.
    pub(super) fn motion_of(&self, s: &VehicleState) -> Motion {
        let [(sp, cp), (sr, cr), (sy, cy)] = [s.pitch_rad, s.roll_rad, s.yaw_rad].map(f64::sin_cos);
        // Yaw, then nose up, then right side high; in the level world.
        let level = [
            [cp * cy, cp * sy, sp],
            [-sy * cr + cy * sp * sr, cy * cr + sy * sp * sr, -sr * cp],
            [-sy * sr - cy * sp * cr, cy * sr - sy * sp * cr, cr * cp],
        ];
        let along = |v: [f64; 3]| {
            core::array::from_fn(|i| v[0] * level[0][i] + v[1] * level[1][i] + v[2] * level[2][i])
        };
        let rate: [f64; 3] = along(s.front_rate_rad_s);
        let lever: [f64; 3] =
            along(core::array::from_fn(|i| self.antenna_m[i] - self.front_com_m[i]));
        let about_com = cross(rate, lever);
        let velocity = core::array::from_fn(|i| s.antenna_velocity_m_s[i] - about_com[i]);
        let ground = |v: [f64; 3]| self.tilt.map_or(v, |tilt| tilt.to_ground(v));
        Motion {
            arm: PerWheel::from_fn(|w| {
                self.actuators.arm_motion(s.stroke_m[w], s.stroke_rate_m_s[w])
            }),
            joint: core::array::from_fn(|i| HingeMotion {
                angle_rad: s.joint_rad[i],
                rate_rad_s: s.joint_rate_rad_s[i],
            }),
            roll_hinge: HingeMotion {
                angle_rad: s.roll_hinge_rad,
                rate_rad_s: s.roll_hinge_rate_rad_s,
            },
            wheel_rate_rad_s: s.wheel_speed_rad_s,
            position_m: ground(s.position_m),
            axes: level.map(ground),
            velocity_m_s: ground(velocity),
            rate_rad_s: ground(rate),
            ground_force_n: s.ground_force_n,
            chassis_force_n: 0.0,
        }
    }
}
