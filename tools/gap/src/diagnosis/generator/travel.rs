//! Wheel speeds against one another and against the receiver: who slips, who misreads, who is late.

use xt28_machine::{Machine, PerWheel};
use xt28_sim::Effects;

use super::grade::Grade;
use super::rolling::rolling_errors;
use super::stance::antenna_leans_m;
use crate::diagnosis::signals::{DT_S, Samples, Signals};

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
/// Slower than this a lag of the receiver's own shows more than it moves, m/s.
const ROLLING_M_S: f64 = 0.2;
/// Slower than this a course says nothing, m/s.
const COURSE_M_S: f64 = 0.3;

/// Rolling over a run.
#[must_use]
pub(super) fn travel_errors(s: &Signals, machine: &Machine, effects: &Effects) -> TravelErrors {
    let rolling = rolling_errors(s, machine, effects);
    // Distance that the wheels say, cumulated, so that a fix can be late by any time.
    let mut rolled = Vec::with_capacity(s.len + 1);
    rolled.push(0.0);
    for i in 0..s.len {
        rolled.push(rolled[i] + rolling.ahead_m_s[i] * DT_S);
    }
    let late_s = effects.sensors.gnss_latency.delay_s;
    let rolled_at = |at_s: f64| {
        let place = ((at_s - late_s) / DT_S).clamp(0.0, (s.len) as f64 - 1e-6);
        let (i, share) = (place as usize, place.fract());
        rolled[i] + share * (rolled[i + 1] - rolled[i])
    };
    let mut speed = vec![f64::NAN; s.len];
    let mut course = vec![f64::NAN; s.len];
    let ground = Grade::believed(s, effects);
    let lever = effects.sensors.gnss_lever_arm;
    let leans_m = s.antenna_leans_m(|| antenna_leans_m(s, machine));
    let lean_m = |at_s: f64| leans_m[(((at_s - late_s) / DT_S).max(0.0) as usize).min(s.len - 1)];
    let back = (WINDOW_S * 8.0) as usize;
    for k in back..s.fixes.len() {
        let ([t0, x0, y0], [t1, x1, y1]) = (s.fixes[k - back], s.fixes[k]);
        let (dx, dy) = (x1 - x0, y1 - y0);
        // Over fixes that are missing a heading in the middle says too little.
        let near = t1 - t0 < 1.5 * WINDOW_S;
        let leaning_m = [0, 1].map(|axis| lean_m(t1)[axis] - lean_m(t0)[axis]);
        let heading = s.heading_at(0.5 * (t0 + t1)).filter(|_| near);
        let wheel_m_s = (rolled_at(t1) - rolled_at(t0)) / (t1 - t0);
        let (from, to) = ((t1 / DT_S) as usize, ((t1 + 0.125) / DT_S) as usize);
        let (mut along, mut angle) = (f64::NAN, f64::NAN);
        if let (Some([heading, yaw_rate]), Some(ground)) = (heading, ground) {
            let (sin, cos) = heading.sin_cos();
            let wheel_m_s = wheel_m_s * ground.on_map(heading);
            if wheel_m_s.abs() > ROLLING_M_S {
                let moved_m = cos * dx + sin * dy - leaning_m[0];
                along = wheel_m_s - yaw_rate * lever.y_m - moved_m / (t1 - t0);
            }
            if wheel_m_s > COURSE_M_S {
                let antenna = machine.sensors.gnss_antenna_m;
                let side = yaw_rate * (antenna[0] + lever.x_m);
                let moved_m = cos * dy - sin * dx - leaning_m[1];
                angle = side / wheel_m_s - moved_m / (t1 - t0) / wheel_m_s;
            }
        }
        for i in from..to.min(s.len) {
            speed[i] = along;
            course[i] = angle;
        }
    }
    TravelErrors { speed_m_s: speed, course_rad: course, wheel_rad_s: rolling.wheel_rad_s }
}
