//! Wheel speeds against one another and against the receiver: who slips, who misreads, who is late.

use core::iter::once;

use xt28_machine::{Machine, PerWheel};

use super::antenna::Antenna;
use super::grade::Grade;
use super::rolling::rolling_errors;
use super::side_slip::SideSlip;
use super::stance::antenna_leans_m;
use crate::diagnosis::belief::EffectSchedule;
use crate::diagnosis::signals::{DT_S, Samples, Signals, median};

/// Errors of rolling over a run; `NaN` where nothing can be said.
#[derive(Clone, Debug, Default)]
pub(super) struct TravelErrors {
    /// Speed over ground of the front axle that all wheels say less the receiver's, m/s.
    pub(super) speed_m_s: Samples,
    /// Course that heading and lever arm say less the receiver's, rad.
    pub(super) course_rad: Samples,
    /// Each wheel's speed that the six together say less its own, rad/s.
    pub(super) wheel_rad_s: PerWheel<Samples>,
}

/// Time over which fixes give a speed, s, and how far from it two of them may be apart.
const WINDOW_S: f64 = 1.0;
const WINDOW_LEAST_S: f64 = 0.9375;
const WINDOW_MOST_S: f64 = 1.5;
/// Slower than this a lag of the receiver's own shows more than it moves, m/s.
const ROLLING_M_S: f64 = 0.2;
/// Slower than this a course says nothing, m/s.
const COURSE_M_S: f64 = 0.3;

/// Rolling over a run.
#[must_use]
pub(super) fn travel_errors(
    s: &Signals,
    machine: &Machine,
    schedule: EffectSchedule<'_>,
) -> TravelErrors {
    let (effects, antenna) = (schedule.effects, Antenna::new(schedule));
    let rolling = rolling_errors(s, machine, effects);
    // Distances that wheels say, so that a fix can be late by any time: as believed, and as they turn.
    let rolled = Rolled::new(rolling.ahead_m_s.iter().copied());
    let radius_m = machine.wheels.radius_m;
    let turned = Rolled::new((0..s.len).map(|i| s.mean_wheel_speed_rad_s(i) * radius_m));
    let mut speed = vec![f64::NAN; s.len];
    let mut course = vec![f64::NAN; s.len];
    let ground = Grade::believed(s, effects);
    let leans_m = s.antenna_leans_m(|| antenna_leans_m(s, machine));
    let lean_m = |at_s: f64| {
        let then_s = at_s - antenna.late_s(at_s);
        leans_m[((then_s / DT_S).max(0.0) as usize).min(s.len - 1)]
    };
    let slip = SideSlip::new(s, machine, effects);
    let holds_s = 1.5 * interval_s(&s.fixes);
    for (k, &[t1, x1, y1]) in s.fixes.iter().enumerate() {
        let [t0, x0, y0] = a_window_before(&s.fixes[..=k]);
        if t1 - t0 < WINDOW_LEAST_S {
            continue;
        }
        let (dx, dy) = (x1 - x0, y1 - y0);
        // Over fixes that are missing a heading in the middle says too little.
        let near = t1 - t0 < WINDOW_MOST_S;
        // What the antenna does beside the frame: it leans with the frame, and may be bent.
        let (lever_m, jumped_m) = (antenna.lever_m(t1), antenna.jumped_m([t0, t1]));
        let beside_m = [0, 1].map(|axis| lean_m(t1)[axis] - lean_m(t0)[axis] + jumped_m[axis]);
        let heading = s.heading_at(0.5 * (t0 + t1)).filter(|_| near);
        let then_s = |at_s: f64| at_s - antenna.late_s(at_s);
        let wheel_m_s = (rolled.until_m(then_s(t1)) - rolled.until_m(then_s(t0))) / (t1 - t0);
        // Whether an instant is judged depends on nothing that is believed: what falls out is held against it.
        let turns_m_s = (turned.until_m(t1) - turned.until_m(t0)) / (t1 - t0);
        let until_s = s.fixes.get(k + 1).map_or(f64::INFINITY, |next| next[0]).min(t1 + holds_s);
        let (from, to) = ((t1 / DT_S) as usize, (until_s / DT_S) as usize);
        let (mut along, mut angle) = (f64::NAN, f64::NAN);
        if let (Some([heading, yaw_rate]), Some(ground)) = (heading, ground) {
            let (sin, cos) = heading.sin_cos();
            let wheel_m_s = wheel_m_s * ground.on_map(heading);
            if turns_m_s.abs() > ROLLING_M_S {
                let moved_m = cos * dx + sin * dy - beside_m[0];
                along = wheel_m_s - yaw_rate * lever_m[1] - moved_m / (t1 - t0);
            }
            if turns_m_s > COURSE_M_S {
                let ahead_m = machine.sensors.gnss_antenna_m[0] + lever_m[0];
                let slips_m_s =
                    slip.as_ref().map_or(0.0, |slip| slip.front_m_s(then_s(0.5 * (t0 + t1))));
                let side = yaw_rate * ahead_m + slips_m_s;
                let moved_m = cos * dy - sin * dx - beside_m[1];
                angle = (side - moved_m / (t1 - t0)) / turns_m_s;
            }
        }
        for i in from..to.min(s.len) {
            speed[i] = along;
            course[i] = angle;
        }
    }
    TravelErrors { speed_m_s: speed, course_rad: course, wheel_rad_s: rolling.wheel_rad_s }
}

/// How far the machine has gone since a run began, by a speed at each of its samples.
struct Rolled(Samples);

impl Rolled {
    fn new(speeds_m_s: impl Iterator<Item = f64>) -> Self {
        let mut gone_m = 0.0;
        let step = |speed_m_s| {
            gone_m += speed_m_s * DT_S;
            gone_m
        };
        Self(once(0.0).chain(speeds_m_s.map(step)).collect())
    }

    /// Until `at_s`, m.
    fn until_m(&self, at_s: f64) -> f64 {
        let last = self.0.len() - 1;
        let place = (at_s / DT_S).clamp(0.0, last as f64);
        let (i, share) = (place as usize, place.fract());
        self.0[i] + share * (self.0[(i + 1).min(last)] - self.0[i])
    }
}

/// The one of `fixes` that is nearest to a window before the last, however often a receiver speaks.
fn a_window_before(fixes: &[[f64; 3]]) -> [f64; 3] {
    let last_s = fixes.last().map_or(0.0, |fix| fix[0]);
    let from_s = last_s - WINDOW_S;
    let after = fixes.partition_point(|fix| fix[0] < from_s);
    let around = [after.checked_sub(1), Some(after)].into_iter().flatten();
    let away = |k: &usize| (fixes[*k][0] - from_s).abs();
    around
        .filter(|k| *k < fixes.len())
        .min_by(|a, b| away(a).total_cmp(&away(b)))
        .map_or([last_s, f64::NAN, f64::NAN], |k| fixes[k])
}

/// How far apart most fixes are, s.
fn interval_s(fixes: &[[f64; 3]]) -> f64 {
    median(fixes.windows(2).map(|pair| pair[1][0] - pair[0][0])).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use xt28_machine::Wheel;
    use xt28_sim::Effects;

    use super::super::still::still;
    use super::*;

    /// A machine that goes round to the left at 1 m/s and 0.1 rad/s, its front axle slipping to the right.
    fn bend(machine: &Machine, slips_m_s: f64) -> Signals {
        let mut s = still(20);
        (s.fixes, s.headings) = (Vec::new(), Vec::new());
        for w in Wheel::ALL {
            s.cylinder_load_n[w].fill(60.0e3);
            for speed in [&mut s.smooth_wheel_speed_rad_s[w], &mut s.wheel_speed_rad_s[w]] {
                speed.fill(1.0 / machine.wheels.radius_m);
            }
        }
        // Axles that touch a circle of 10 m.
        for (joint, from_axle_m) in [1.85_f64, 1.175].into_iter().enumerate() {
            s.joint_rad[joint].fill(2.0 * (from_axle_m / 10.0).atan());
        }
        let ahead_m = machine.sensors.gnss_antenna_m[0];
        let (mut x_m, mut y_m) = (0.0, 0.0);
        for i in 0..s.len {
            let at_s = i as f64 * DT_S;
            let (sin, cos) = (0.1 * at_s).sin_cos();
            if i % 12 == 0 {
                s.fixes.push([at_s, x_m + ahead_m * cos, y_m + ahead_m * sin]);
                s.headings.push([at_s, 0.1 * at_s, 0.1]);
            }
            x_m += (cos + sin * slips_m_s) * DT_S;
            y_m += (sin - cos * slips_m_s) * DT_S;
        }
        s
    }

    fn slippery(creep_m_s_n: f64) -> Effects {
        let mut effects = Effects::default();
        for w in Wheel::ALL {
            effects.wheels[w].slippery_ground.creep_m_s_n = creep_m_s_n;
        }
        effects
    }

    #[test]
    fn wheels_that_creep_slip_to_the_outside_of_a_bend() {
        let (machine, slippery) = (Machine::xt28(), slippery(1.2e-4));
        // The front axle bears about half of what 17 t need at 1 m/s and 0.1 rad/s (`side_slip.rs`).
        let s = bend(&machine, 0.5 * 1.2e-4 * 0.51 * machine.mass_kg() * 0.1);
        let course_rad = |effects: &Effects| {
            let errors = travel_errors(&s, &machine, effects.into());
            errors.course_rad[800..1800].iter().fold(0.0_f64, |most, e| most.max(e.abs()))
        };
        let [creeping, not] = [&slippery, &Effects::default()].map(course_rad);
        assert!(creeping < 0.2 * not && not > 0.03, "{creeping}, without creep {not}");
    }

    /// A sample that a belief makes nobody judge stays as it was without it, however wrong.
    #[test]
    fn which_samples_are_judged_depends_on_no_belief() {
        let machine = Machine::xt28();
        let mut s = bend(&machine, 0.0);
        // It sets off, and pushes hard.
        for w in Wheel::ALL {
            for speed in [&mut s.smooth_wheel_speed_rad_s[w], &mut s.wheel_speed_rad_s[w]] {
                speed[..400].fill(0.0);
            }
        }
        for forward in [1, 3] {
            s.pump_pressure_pa[forward][400..600].fill(5.0e6);
        }
        let mut late = Effects::default();
        late.sensors.gnss_latency.delay_s = 0.4;
        let judged = |effects: &Effects| {
            let errors = travel_errors(&s, &machine, effects.into());
            let is_judged = |samples: Samples| samples.into_iter().map(f64::is_finite).collect();
            [is_judged(errors.speed_m_s), is_judged(errors.course_rad)]
        };
        let sound: [Vec<bool>; 2] = judged(&Effects::default());
        assert!(sound.iter().all(|of| of.contains(&true) && of.contains(&false)));
        for effects in [late, slippery(1.0e-4)] {
            assert_eq!(judged(&effects), sound);
        }
    }

    #[test]
    fn fixes_a_second_apart_are_found_at_any_rate() {
        for rate_hz in [1.0, 2.0, 5.0, 8.0, 10.0, 20.0] {
            let fixes: Vec<[f64; 3]> =
                (0..100).map(|k| [f64::from(k) / rate_hz, 0.0, 0.0]).collect();
            assert!((interval_s(&fixes) - 1.0 / rate_hz).abs() < 1e-9);
            for end in 2..fixes.len() {
                let [from_s, ..] = a_window_before(&fixes[..=end]);
                let apart_s = fixes[end][0] - from_s;
                assert!(
                    (apart_s - WINDOW_S.min(fixes[end][0])).abs() < 1e-9,
                    "{rate_hz} {apart_s}"
                );
            }
        }
        // Where fixes are missing, the nearest that there is.
        let [from_s, ..] = a_window_before(&[[0.0; 3], [0.1; 3], [1.6; 3]]);
        assert_eq!(from_s, 0.1);
    }
}
