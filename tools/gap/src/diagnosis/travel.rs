//! Wheel speeds against one another and against the receiver: who slips, who misreads, who is late.

use xt28_machine::{Machine, PerWheel};
use xt28_sim::Effects;

use super::signals::{DT_S, Samples, Signals};

/// Errors of rolling over a run; `NaN` where nothing can be said.
#[derive(Clone, Debug, Default)]
pub(super) struct TravelErrors {
    /// Speed over ground that the front wheels say less the receiver's, m/s.
    pub(super) speed_m_s: Samples,
    /// Course that heading and lever arm say less the receiver's, rad.
    pub(super) course_rad: Samples,
    /// Each wheel's speed that the others say less its own, rad/s.
    pub(super) wheel_rad_s: PerWheel<Samples>,
}

/// Time over which fixes give a speed, s.
const WINDOW_S: f64 = 1.0;
/// A cylinder that carries less may have its wheel in the air, N.
const CARRYING_N: f64 = 5_000.0;
/// Slower than this the wheels roll by the arms' swing as much as by the drive, m/s.
const ROLLING_M_S: f64 = 0.2;
/// Slower than this a course says nothing, m/s.
const COURSE_M_S: f64 = 0.3;

/// Rolling over a run.
#[must_use]
pub(super) fn travel_errors(s: &Signals, machine: &Machine, effects: &Effects) -> TravelErrors {
    let wheels = wheel_errors(s, machine, effects);
    let radius_m = machine.wheels.radius_m;
    let scale = |w: xt28_machine::Wheel| effects.wheels[w].wheel_speed_scale.factor;
    let slip = effects.wheels.iter().map(|(_, e)| e.slippery_ground.slip).sum::<f64>() / 6.0;
    // Distance that the wheels say, cumulated, so that a fix can be late by any time.
    let mut rolled = Vec::with_capacity(s.len + 1);
    rolled.push(0.0);
    for i in 0..s.len {
        let mean = s.wheel_speed_rad_s.iter().map(|(w, v)| v[i] / scale(w)).sum::<f64>() / 6.0;
        rolled.push(rolled[i] + mean * radius_m * (1.0 - slip) * DT_S);
    }
    let late_s = effects.sensors.gnss_latency.delay_s;
    let rolled_at = |at_s: f64| {
        let place = ((at_s - late_s) / DT_S).clamp(0.0, (s.len) as f64 - 1e-6);
        let (i, share) = (place as usize, place.fract());
        rolled[i] + share * (rolled[i + 1] - rolled[i])
    };
    let mut speed = vec![f64::NAN; s.len];
    let mut course = vec![f64::NAN; s.len];
    let flat = matches!(s.terrain, xt28_sim::Terrain::Flat);
    let lever = effects.sensors.gnss_lever_arm;
    let back = (WINDOW_S * 8.0) as usize;
    for k in back..s.fixes.len() {
        let ([t0, x0, y0], [t1, x1, y1]) = (s.fixes[k - back], s.fixes[k]);
        let (dx, dy) = (x1 - x0, y1 - y0);
        let heading = s.heading_at(0.5 * (t0 + t1));
        let wheel_m_s = (rolled_at(t1) - rolled_at(t0)) / (t1 - t0);
        let (from, to) = ((t1 / DT_S) as usize, ((t1 + 0.125) / DT_S) as usize);
        let (mut along, mut angle) = (f64::NAN, f64::NAN);
        if let Some([heading, yaw_rate]) = heading {
            let (sin, cos) = heading.sin_cos();
            if wheel_m_s.abs() > ROLLING_M_S && flat {
                along = wheel_m_s - yaw_rate * lever.y_m - (cos * dx + sin * dy) / (t1 - t0);
            }
            if wheel_m_s > COURSE_M_S && flat {
                let antenna = machine.sensors.gnss_antenna_m;
                let side = yaw_rate * (antenna[0] + lever.x_m);
                angle = side / wheel_m_s - (cos * dy - sin * dx) / (t1 - t0) / wheel_m_s;
            }
        }
        for i in from..to.min(s.len) {
            speed[i] = along;
            course[i] = angle;
        }
    }
    TravelErrors { speed_m_s: speed, course_rad: course, wheel_rad_s: wheels }
}

/// Each wheel against the mean of the six: a bend parts them by known shares, an arm that swings
/// rolls its wheel.
fn wheel_errors(s: &Signals, machine: &Machine, effects: &Effects) -> PerWheel<Samples> {
    let linkage = machine.linkage();
    let (r, half_track) = (machine.wheels.radius_m, machine.wheels.track_m / 2.0);
    let scale = |w: xt28_machine::Wheel| effects.wheels[w].wheel_speed_scale.factor;
    let mut out = PerWheel::from_fn(|_| vec![f64::NAN; s.len]);
    let x = machine.wheels.axle_x_m;
    let joint_x = [machine.articulation.front_joint_x_m, machine.articulation.rear_joint_x_m];
    let flat = matches!(s.terrain, xt28_sim::Terrain::Flat);
    for i in (0..s.len).step_by(5) {
        let joint = [s.joint_rad[0][i], s.joint_rad[1][i]];
        let moving = s.mean_wheel_speed_rad_s(i) * r;
        let back = i.saturating_sub(20);
        let change = (s.mean_wheel_speed_rad_s(i) - s.mean_wheel_speed_rad_s(back)) * r / 0.2;
        if change.abs() > 0.1 || moving.abs() < ROLLING_M_S || !flat {
            continue;
        }
        // Steady bend: each axle's middle goes along its frame. Rates of turn from the joints.
        let (a, b) = (-joint_x[0] + x[0], joint_x[0] - x[1]);
        let turn_front = moving * joint[0].tan() / (a + b);
        let turn_rear = moving * joint[1].tan() / (joint_x[1] - x[2] + x[1] - joint_x[1]);
        let turn = [turn_front, 0.5 * (turn_front + turn_rear), turn_rear];
        let rolls = PerWheel::from_fn(|w| {
            let k = w.axle() as usize;
            let side = if w.side() == xt28_machine::Side::Left { 1.0 } else { -1.0 };
            let forward = if k == 0 { 1.0 } else { -1.0 };
            let pose = linkage.at_stroke(s.stroke_m[w][i]);
            let after = linkage.at_stroke(s.stroke_m[w][i] + 1e-4);
            let swing = forward * (after.reach_m - pose.reach_m) / 1e-4 * s.stroke_rate_m_s[w][i];
            moving - side * half_track * turn[k] + swing
        });
        let true_speed = PerWheel::from_fn(|w| s.wheel_speed_rad_s[w][i] / scale(w) * r);
        let offset = (true_speed.sum() - rolls.sum()) / 6.0;
        for w in xt28_machine::Wheel::ALL {
            if s.cylinder_load_n[w][i] < CARRYING_N {
                continue;
            }
            let error = (rolls[w] + offset - true_speed[w]) / r * scale(w);
            let end = (i + 5).min(s.len);
            out[w][i..end].fill(error);
        }
    }
    out
}
