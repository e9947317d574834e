//! The whole machine's state as a log and a belief about its sensors have it.

use nalgebra::{Matrix3, Vector3};
use xt28_machine::{ArmPose, GRAVITY_M_S2, Machine, PerWheel, Wheel};
use xt28_sim::{Effects, Parts, Terrain, VehicleState};

use crate::diagnosis::gauge::{Gauge, rod_n};
use crate::diagnosis::generator::{PRESSURE_AT_TORQUE_MAX_PA, weights};
use crate::diagnosis::signals::{DT_S, Samples, Signals};

/// Ticks by which a load as logged is late: the ECU's pressure filter keeps 0.94 of its last value.
const LOAD_LATE: usize = 16;
/// Ticks on either side over which a noisy reading is averaged.
const AVERAGED: usize = 5;
/// Least load of a wheel that stands, N.
const STANDING_N: f64 = 3_000.0;
/// Corrections of a stance at most; each squares its error.
const PASSES: usize = 4;
/// Ticks from one stance to the next.
const EVERY: usize = 5;

/// Reads states off a log.
pub(super) struct Measured<'a> {
    s: &'a Signals,
    machine: &'a Machine,
    effects: &'a Effects,
    parts: Parts,
    circuits: [[Wheel; 3]; 2],
    /// How the front frame stood, every [`EVERY`] ticks.
    stances: Vec<Stance>,
}

/// How the front frame stands on its ground.
#[derive(Clone, Copy, Debug)]
struct Stance {
    z_m: f64,
    pitch_rad: f64,
    roll_rad: f64,
}

impl<'a> Measured<'a> {
    pub(super) fn new(s: &'a Signals, machine: &'a Machine, effects: &'a Effects) -> Self {
        let circuits = machine.circuits().expect("checked when the machine was read");
        let parts = Parts::new(machine, effects);
        let mut measured = Self { s, machine, effects, parts, circuits, stances: Vec::new() };
        let imu = &effects.sensors.imu_offset;
        let (_, yaw_rad, _) = measured.fix_at(0.0);
        let stands = axes(s.pitch_rad[0] - imu.pitch_rad, s.roll_rad[0] - imu.roll_rad, yaw_rad);
        let tilt = measured.parts.tilt;
        let [pitch_rad, roll_rad] =
            attitude_rad(&stands.map(|axis| tilt.map_or(axis, |tilt| tilt.to_ground(axis))));
        let mut near = Stance { z_m: 0.0, pitch_rad, roll_rad };
        for i in (0..s.len).step_by(EVERY) {
            near = measured.stance(i, near);
            measured.stances.push(near);
        }
        measured
    }

    /// The state at tick `i`.
    #[allow(clippy::cast_precision_loss)]
    pub(super) fn at(&self, i: usize) -> VehicleState {
        let last = self.stances.len() - 1;
        let (k, share) = ((i / EVERY).min(last), (i % EVERY) as f64 / EVERY as f64);
        let between =
            |a: &Stance, b: &Stance, of: fn(&Stance) -> f64| of(a) + share * (of(b) - of(a));
        let (a, b) = (&self.stances[k], &self.stances[(k + 1).min(last)]);
        let stance = Stance {
            z_m: between(a, b, |s| s.z_m),
            pitch_rad: between(a, b, |s| s.pitch_rad),
            roll_rad: between(a, b, |s| s.roll_rad),
        };
        let (from, to) = (k.saturating_sub(1), (k + 2).min(last));
        let span_s = ((to - from).max(1) * EVERY) as f64 * DT_S;
        let rate =
            |of: fn(&Stance) -> f64| (of(&self.stances[to]) - of(&self.stances[from])) / span_s;
        let rates = [rate(|s| s.roll_rad), rate(|s| s.pitch_rad)];
        self.state(i, &stance, rates)
    }

    /// Height and attitude with which the wheels that carry stand on the ground, by their own strokes;
    /// found from one nearby. What the inertial unit says of the attitude is wrong by the acceleration.
    fn stance(&self, i: usize, mut stance: Stance) -> Stance {
        let state = self.state(i, &stance, [0.0; 2]);
        let centres = self.wheel_centres_m(&state);
        for _ in 0..PASSES {
            let (mut a, mut b) = (Matrix3::zeros(), Vector3::zeros());
            let [x, y, z] = axes(stance.pitch_rad, stance.roll_rad, state.yaw_rad);
            for (_, &([bx, by, bz], normal_n, sag_m)) in centres.iter() {
                if normal_n < STANDING_N {
                    continue;
                }
                let at: [f64; 3] = core::array::from_fn(|k| x[k] * bx + y[k] * by + z[k] * bz);
                let (east, north) = (state.position_m[0] + at[0], state.position_m[1] + at[1]);
                let rest_m = self.rest_m(east, north) - sag_m;
                let row = Vector3::new(1.0, bx, -by);
                a += row * row.transpose();
                b += row * (rest_m - stance.z_m - at[2]);
            }
            let Some(step) = a.lu().solve(&b) else { return stance };
            stance.z_m += step[0];
            stance.pitch_rad += step[1];
            stance.roll_rad += step[2];
            if step.amax() < 1e-5 {
                break;
            }
        }
        stance
    }

    /// Height of a wheel's centre over a point, m.
    fn rest_m(&self, east_m: f64, north_m: f64) -> f64 {
        match self.s.terrain {
            Terrain::Flat => self.parts.radius_m,
            ref rough => rough.rest_m(east_m, north_m, self.parts.radius_m),
        }
    }

    /// Centres of the wheels in the front frame's axes, m, force of the ground on each, N, and how far
    /// it presses its tyre in, m.
    fn wheel_centres_m(&self, state: &VehicleState) -> PerWheel<([f64; 3], f64, f64)> {
        let frames = self.frames(state.joint_rad);
        let torque_nm = state.wheel_torque_nm;
        let unsprung_kg = self.parts.wheel.mass_kg
            + self.parts.arms[Wheel::Fr].body.mass_kg * self.machine.vehicle.arm_com_share;
        PerWheel::from_fn(|w| {
            let arm = &self.parts.arms[w];
            let pose = self.parts.linkage.at_stroke(state.stroke_m[w]);
            let ([ox, oy], angle) = frames[w.axle() as usize];
            let (sin, cos) = angle.sin_cos();
            let along = arm.pivot_m[0] + arm.extends * pose.reach_m;
            let out = arm.pivot_m[1] + arm.to_wheel_m[1];
            let centre = [
                ox + cos * along - sin * out,
                oy + sin * along + cos * out,
                arm.pivot_m[2] - pose.drop_m,
            ];
            let lift_nm = state.cylinder_force_n[w] * pose.lever_m - arm.extends * torque_nm[w];
            let normal_n = unsprung_kg * GRAVITY_M_S2 + lift_nm / pose.reach_m;
            (centre, normal_n, normal_n.max(0.0) / self.parts.tyres[w].stiffness_n_m)
        })
    }

    /// Origin and heading of each frame in the front one's axes; a bend to the left turns the frame
    /// behind to the right.
    fn frames(&self, joint_rad: [f64; 2]) -> [([f64; 2], f64); 3] {
        let mut frames = [([0.0; 2], 0.0_f64); 3];
        for k in 0..2 {
            let ([x, y], before) = frames[k];
            let angle = before - joint_rad[k];
            let at = self.parts.joint_m[k][0];
            let (from, to) = (before.sin_cos(), angle.sin_cos());
            frames[k + 1] = ([x + at * (from.1 - to.1), y + at * (from.0 - to.0)], angle);
        }
        frames
    }

    fn state(&self, i: usize, stance: &Stance, [roll_rate, pitch_rate]: [f64; 2]) -> VehicleState {
        let (s, effects) = (self.s, self.effects);
        let e = &effects.wheels;
        let scale = PerWheel::from_fn(|w| e[w].stroke_scale.factor);
        let mut state = VehicleState {
            stroke_m: PerWheel::from_fn(|w| {
                (s.stroke_m[w][i] - e[w].stroke_bias.bias_m) / scale[w]
            }),
            stroke_rate_m_s: PerWheel::from_fn(|w| s.stroke_rate_m_s[w][i] / scale[w]),
            cylinder_force_n: PerWheel::from_fn(|w| {
                let at = (i + LOAD_LATE).min(s.len - 1);
                let gauge = Gauge::new(self.machine.arms.area_bore_m2, &e[w]);
                gauge.load_n(s.cylinder_load_n[w][at], rod_n(s, self.machine, w, at))
            }),
            wheel_speed_rad_s: PerWheel::from_fn(|w| {
                mean(&s.wheel_speed_rad_s[w], i) / e[w].wheel_speed_scale.factor
            }),
            joint_rad: [s.joint_rad[0][i], s.joint_rad[1][i]],
            joint_rate_rad_s: [slope(&s.joint_rad[0], i), slope(&s.joint_rad[1], i)],
            pump_pressure_pa: [0, 1, 2, 3].map(|side| s.pump_pressure_pa[side][i]),
            engine_speed_rpm: self.machine.drive.engine_speed_rpm,
            front_rate_rad_s: [-roll_rate, -pitch_rate, 0.0],
            ..VehicleState::default()
        };
        let weights = weights(s, self.machine, i);
        for (c, circuit) in self.circuits.iter().enumerate() {
            let [a, b] = [0, 1].map(|k| mean(&s.pump_pressure_pa[2 * c + k], i));
            let torque_nm = (b - a) / PRESSURE_AT_TORQUE_MAX_PA * self.machine.wheels.torque_max_nm;
            circuit.iter().for_each(|&w| state.wheel_torque_nm[w] = torque_nm * weights[w]);
        }
        self.place(i, stance, &mut state);
        state
    }

    /// Position, attitude and velocity: fixes say where, the stance on its ground how it leans, the front wheels how
    /// fast.
    #[allow(clippy::cast_precision_loss)]
    fn place(&self, i: usize, stance: &Stance, state: &mut VehicleState) {
        let s = self.s;
        let late_s = self.effects.sensors.gnss_latency.delay_s;
        let ([antenna_east, antenna_north], yaw, yaw_rate) = self.fix_at(i as f64 * DT_S + late_s);
        let ([ax, ay, az], lever) =
            (self.machine.sensors.gnss_antenna_m, self.effects.sensors.gnss_lever_arm);
        let on_ground = axes(stance.pitch_rad, stance.roll_rad, yaw);
        let in_world = on_ground.map(|a| self.parts.tilt.map_or(a, |tilt| tilt.to_world(a)));
        [state.pitch_rad, state.roll_rad] = attitude_rad(&in_world);
        let [x, y, z] = in_world;
        let arm = [ax + lever.x_m, ay + lever.y_m, az];
        let lever: [f64; 3] =
            core::array::from_fn(|k| x[k] * arm[0] + y[k] * arm[1] + z[k] * arm[2]);
        let on_ground = [antenna_east - lever[0], antenna_north - lever[1], stance.z_m];
        state.position_m = self.parts.tilt.map_or(on_ground, |tilt| {
            // The fixes are of the level world, the height is along the ground's own normal.
            let [east, north, _] = tilt.to_ground([on_ground[0], on_ground[1], 0.0]);
            tilt.to_world([east, north, stance.z_m])
        });
        state.yaw_rad = yaw;
        state.front_rate_rad_s[2] = yaw_rate;
        let speed_m_s = self.speed_m_s(i);
        let rate: [f64; 3] = core::array::from_fn(|k| {
            let [p, q, r] = state.front_rate_rad_s;
            x[k] * p + y[k] * q + z[k] * r
        });
        let about = [
            rate[1] * lever[2] - rate[2] * lever[1],
            rate[2] * lever[0] - rate[0] * lever[2],
            rate[0] * lever[1] - rate[1] * lever[0],
        ];
        state.antenna_velocity_m_s = core::array::from_fn(|k| x[k] * speed_m_s + about[k]);
        state.antenna_position_m = core::array::from_fn(|k| state.position_m[k] + lever[k]);
        let (back, ahead) = (i.saturating_sub(10), (i + 10).min(s.len - 1));
        let pull_m_s2 =
            (self.speed_m_s(ahead) - self.speed_m_s(back)) / ((ahead - back).max(1) as f64 * DT_S);
        state.front_specific_force_m_s2 = [
            GRAVITY_M_S2 * x[2] + pull_m_s2,
            GRAVITY_M_S2 * y[2] + speed_m_s * yaw_rate,
            GRAVITY_M_S2 * z[2],
        ];
    }

    /// Speed of the front frame along itself: what its wheels roll, less what their arms carry them ahead of it.
    fn speed_m_s(&self, i: usize) -> f64 {
        let one = |w: Wheel| {
            let e = &self.effects.wheels[w];
            let stroke_m = (self.s.stroke_m[w][i] - e.stroke_bias.bias_m) / e.stroke_scale.factor;
            let rate_m_s = self.s.stroke_rate_m_s[w][i] / e.stroke_scale.factor;
            let [here, after] =
                [0.0, 1e-4].map(|by_m| self.parts.linkage.at_stroke(stroke_m + by_m));
            let by_stroke = |of: fn(&ArmPose) -> f64| {
                self.parts.arms[w].extends * (of(&after) - of(&here)) / 1e-4 * rate_m_s
            };
            // Turned on its arm, which the sensor reads, and with its arm it rolls, as far as its foot does not slip.
            let turns_rad_s = mean(&self.s.wheel_speed_rad_s[w], i) / e.wheel_speed_scale.factor
                + by_stroke(|pose| pose.angle_rad);
            let rolls_m_s =
                turns_rad_s * self.machine.wheels.radius_m * (1.0 - e.slippery_ground.slip);
            rolls_m_s - by_stroke(|pose| pose.reach_m)
        };
        0.5 * (one(Wheel::Fr) + one(Wheel::Fl))
    }

    /// Antenna, heading and its rate at `at_s`, between fixes; standing at the origin without any.
    fn fix_at(&self, at_s: f64) -> ([f64; 2], f64, f64) {
        let fixes = &self.s.fixes;
        let k = fixes.partition_point(|fix| fix[0] <= at_s);
        let (Some(after), Some(before)) = (fixes.get(k).or(fixes.last()), fixes.get(k.max(1) - 1))
        else {
            let [x, y, _] = self.machine.sensors.gnss_antenna_m;
            return ([x, y], 0.0, 0.0);
        };
        let span_s = after[0] - before[0];
        let share = if span_s > 0.0 { ((at_s - before[0]) / span_s).clamp(0.0, 1.0) } else { 0.0 };
        let place = [1, 2].map(|axis| before[axis] + share * (after[axis] - before[axis]));
        let near = || [self.s.heading_near(at_s).unwrap_or_default(), 0.0];
        let [yaw, rate] = self.s.heading_at(at_s).unwrap_or_else(near);
        (place, yaw, rate)
    }
}

/// Axes of a frame turned by yaw, then nose up, then right side high.
fn axes(pitch_rad: f64, roll_rad: f64, yaw_rad: f64) -> [[f64; 3]; 3] {
    let [(sp, cp), (sr, cr), (sy, cy)] = [pitch_rad, roll_rad, yaw_rad].map(f64::sin_cos);
    [
        [cp * cy, cp * sy, sp],
        [-sy * cr + cy * sp * sr, cy * cr + sy * sp * sr, -sr * cp],
        [-sy * sr - cy * sp * cr, cy * sr - sy * sp * cr, cr * cp],
    ]
}

/// How far the nose and the right side of a frame are up that has these axes, rad; [`axes`] the other way round.
fn attitude_rad([x, y, z]: &[[f64; 3]; 3]) -> [f64; 2] {
    [x[2].asin(), (-y[2]).atan2(z[2])]
}

#[allow(clippy::cast_precision_loss)]
fn mean(samples: &Samples, i: usize) -> f64 {
    let window = &samples[i.saturating_sub(AVERAGED)..(i + AVERAGED + 1).min(samples.len())];
    window.iter().sum::<f64>() / window.len() as f64
}

#[allow(clippy::cast_precision_loss)]
fn slope(samples: &Samples, i: usize) -> f64 {
    let (back, ahead) = (i.saturating_sub(10), (i + 10).min(samples.len() - 1));
    (samples[ahead] - samples[back]) / ((ahead - back).max(1) as f64 * DT_S)
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{FRAC_PI_2, PI};

    use super::*;
    use crate::diagnosis::generator::still;

    /// A machine that stands level on its arms on flat ground, heading so.
    fn standing(heading_rad: f64) -> Signals {
        let mut s = still::still(10);
        for w in Wheel::ALL {
            s.stroke_m[w].fill(0.2);
            s.cylinder_load_n[w].fill(60.0e3);
        }
        s.headings = vec![[0.0, heading_rad, 0.0], [10.0, heading_rad, 0.0]];
        s
    }

    #[test]
    fn a_slope_that_is_believed_lifts_what_is_uphill() {
        let machine = Machine::xt28();
        let mut effects = Effects::default();
        effects.slope.grade_x_rad = 0.1; // to the east
        let level = {
            let s = standing(0.0);
            Measured::new(&s, &machine, &Effects::default()).at(100)
        };
        for (heading_rad, nose_up_rad, right_up_rad) in
            [(0.0, 0.1, 0.0), (FRAC_PI_2, 0.0, 0.1), (PI, -0.1, 0.0), (-FRAC_PI_2, 0.0, -0.1)]
        {
            let s = standing(heading_rad);
            let state = Measured::new(&s, &machine, &effects).at(100);
            let leans = [state.pitch_rad - level.pitch_rad, state.roll_rad - level.roll_rad];
            let off_rad = [leans[0] - nose_up_rad, leans[1] - right_up_rad];
            assert!(off_rad.iter().all(|off| off.abs() < 2e-3), "{heading_rad}: {leans:?}");
        }
    }

    #[test]
    fn arms_that_swing_under_a_frame_that_stands_give_it_no_speed() {
        let machine = Machine::xt28();
        let mut s = standing(0.0);
        let (linkage, radius_m) = (machine.linkage(), machine.wheels.radius_m);
        for w in Wheel::ALL {
            for i in 0..s.len {
                s.stroke_m[w][i] = 0.2 + 0.05 * (i as f64 * DT_S);
            }
            s.stroke_rate_m_s[w].fill(0.05);
            let forward = if w.axle() as usize == 0 { 1.0 } else { -1.0 };
            for i in 0..s.len {
                let [here, after] =
                    [0.0, 1e-4].map(|by_m| linkage.at_stroke(s.stroke_m[w][i] + by_m));
                let carried_m_s = (after.reach_m - here.reach_m) / 1e-4 * 0.05;
                let turns_rad_s = (after.angle_rad - here.angle_rad) / 1e-4 * 0.05;
                s.wheel_speed_rad_s[w][i] = forward * (carried_m_s / radius_m - turns_rad_s);
            }
        }
        let effects = Effects::default();
        let state = Measured::new(&s, &machine, &effects).at(200);
        let ahead_m_s = state.antenna_velocity_m_s[0];
        assert!(ahead_m_s.abs() < 2e-3, "{ahead_m_s}");
    }
}
