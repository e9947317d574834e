//! Look how late each block answers: the latest has the delay. If none is late, the one whose answer
//! has the wrong size has the wrong gain.

use xt28_gap::diagnosis::{DT_S, Inquiry, Signals, Verdict};
use xt28_machine::{PerWheel, Wheel};
use xt28_sim::effects::{Scope, find};

use super::{fitted, nearest_scope};
use crate::reply::{Named, Reply};
use crate::score::average;

/// Longest lag looked for, samples.
const LAG_MAX: usize = 100;
/// Lag beyond a block's own from which on it is late, s (assumed).
const LATE_S: f64 = 0.1;
/// Share by which a gain may be off: a sound arm of a foreign plant was off by up to 0.10.
const OFF_MIN: f64 = 0.15;
/// Half of the time over which rates are measured, samples.
const HALF: usize = 10;
/// Below this share of full speed, root mean square, a block has not been driven: it holds.
const DRIVEN_MIN: f64 = 0.04;

/// How one block answers to its input.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Answer {
    lag_s: f64,
    /// Slope of what came over what nominal laws expect.
    gain: f64,
}

pub(super) fn reply(inquiry: &Inquiry) -> Reply {
    let runs = fitted(inquiry);
    let machine = &inquiry.machine;
    let arms = PerWheel::from_fn(|wheel| {
        let full = machine.hydraulics.speed_full_m_s;
        answer(runs.iter().map(|run| arm(run, wheel, full)), full)
    });
    let full = machine.articulation.rate_max_deg_s.to_radians();
    let joint = answer(runs.iter().map(|run| joint(run, full)), full);
    let full = machine.drive.speed_full_m_s / machine.wheels.radius_m;
    let drive = answer(runs.iter().map(|run| drive(run, inquiry)), full);
    // A spring with a damper beside it answers late by the quotient of the two.
    let (lock, vehicle) = (&machine.hydraulics, &machine.vehicle);
    let arm_s = lock.lock_damping_n_s_m / lock.lock_stiffness_n_m;
    let joint_s = vehicle.joint_damping_nms / vehicle.joint_stiffness_nm;
    let lags = [
        ("arm-delay", worst(&arms, |a| a.lag_s - arm_s)),
        ("steer-delay", (joint.map_or(0.0, |a| a.lag_s - joint_s), Scope::All)),
        ("throttle-delay", (drive.map_or(0.0, |a| a.lag_s), Scope::All)),
    ];
    let gains = [
        ("valve-gain", worst(&arms, |a| (a.gain - 1.0).abs())),
        ("steer-rate", (joint.map_or(0.0, |a| (a.gain - 1.0).abs()), Scope::All)),
        ("wheel-speed-scale", (drive.map_or(0.0, |a| (a.gain - 1.0).abs()), Scope::All)),
    ];
    let late = lags.iter().any(|(_, (lag_s, _))| *lag_s > LATE_S);
    let off = gains.iter().any(|(_, (off, _))| *off > OFF_MIN);
    let (lags, gains) = (ranked(inquiry, lags), ranked(inquiry, gains));
    let mut causes = if late || !off { [lags, gains].concat() } else { [gains, lags].concat() };
    if let Some(first) = causes.first_mut() {
        first.stands = late || off;
    }
    let verdict = if late || off { Verdict::Effect } else { Verdict::None };
    Reply { verdict, causes, none: None, unknown: None }
}

fn ranked(inquiry: &Inquiry, mut found: [(&str, (f64, Scope)); 3]) -> Vec<Named> {
    found.sort_by(|(_, (a, _)), (_, (b, _))| b.total_cmp(a));
    let named = |(name, (_, scope)): (&str, (f64, Scope))| {
        let effect = find(name).filter(|effect| inquiry.catalogue.contains(effect))?;
        Some(Named::without_probability(effect, scope))
    };
    found.into_iter().filter_map(named).collect()
}

/// The largest of the arms, and the scope of those at least half as bad.
fn worst(arms: &PerWheel<Option<Answer>>, how_bad: impl Fn(Answer) -> f64) -> (f64, Scope) {
    let bad = |wheel| arms[wheel].map_or(0.0, &how_bad);
    let most = Wheel::ALL.into_iter().map(bad).fold(0.0, f64::max);
    (most, nearest_scope(|wheel| bad(wheel) > 0.5 * most))
}

/// Rate of a stroke, expected and measured.
fn arm(run: &Signals, wheel: Wheel, full_m_s: f64) -> (Vec<f64>, Vec<f64>) {
    (expected(&run.opening[wheel], full_m_s), run.stroke_rate_m_s[wheel].clone())
}

/// Rate of the front joint, expected and measured.
fn joint(run: &Signals, full_rad_s: f64) -> (Vec<f64>, Vec<f64>) {
    let angle = &run.joint_rad[0];
    #[allow(clippy::cast_precision_loss)]
    let rate = |w: &[f64]| (w[w.len() - 1] - w[0]) / ((w.len() - 1).max(1) as f64 * DT_S);
    (expected(&run.steer_opening[0], full_rad_s), windowed(angle, rate))
}

/// Rate that an opening asks for, a mean over the time over which rates are measured.
fn expected(opening: &[f64], full: f64) -> Vec<f64> {
    windowed(opening, |w| full * average(w))
}

/// `of` the 0.2 s around each sample.
fn windowed(samples: &[f64], of: impl Fn(&[f64]) -> f64) -> Vec<f64> {
    let window = |i: usize| &samples[i.saturating_sub(HALF)..(i + HALF + 1).min(samples.len())];
    (0..samples.len()).map(|i| of(window(i))).collect()
}

/// Mean wheel speed, expected from the throttle by the nominal lag, and measured.
fn drive(run: &Signals, inquiry: &Inquiry) -> (Vec<f64>, Vec<f64>) {
    let machine = &inquiry.machine;
    let full_rad_s = machine.drive.speed_full_m_s / machine.wheels.radius_m;
    let share = DT_S / machine.drive.speed_time_constant_s;
    let mut speed = 0.0;
    let follow = |throttle: &f64| {
        speed += share * (throttle * full_rad_s - speed);
        speed
    };
    let expected = run.throttle.iter().map(follow).collect();
    let mean =
        |i: usize| Wheel::ALL.iter().map(|&w| run.wheel_speed_rad_s[w][i]).sum::<f64>() / 6.0;
    (expected, (0..run.len).map(mean).collect())
}

/// Lag of the largest cross-correlation over all runs, and the gain at that lag; `None` of a block
/// that was hardly driven, compared with its `full` speed.
fn answer(runs: impl Iterator<Item = (Vec<f64>, Vec<f64>)>, full: f64) -> Option<Answer> {
    let runs: Vec<_> = runs.map(|(a, b)| (centred(&a), centred(&b))).collect();
    let power: f64 = runs.iter().flat_map(|(input, _)| input).map(|x| x * x).sum();
    let samples: usize = runs.iter().map(|(input, _)| input.len()).sum();
    #[allow(clippy::cast_precision_loss)]
    if power < (DRIVEN_MIN * full).powi(2) * samples as f64 {
        return None;
    }
    // Products at a lag, over the samples that overlap there: input with output, and each with itself.
    let products = |lag: usize| -> [f64; 3] {
        let pairs = runs.iter().flat_map(|(x, y)| x.iter().zip(y.iter().skip(lag)));
        pairs.fold([0.0; 3], |[xy, xx, yy], (x, y)| [xy + x * y, xx + x * x, yy + y * y])
    };
    let coefficient = |lag: usize| {
        let [xy, xx, yy] = products(lag);
        xy / (xx * yy).sqrt().max(f64::MIN_POSITIVE)
    };
    let best = (0..=LAG_MAX).map(|lag| (coefficient(lag), lag)).max_by(|a, b| a.0.total_cmp(&b.0));
    let (_, lag) = best.expect("there are lags");
    let [xy, xx, _] = products(lag);
    #[allow(clippy::cast_precision_loss)]
    Some(Answer { lag_s: lag as f64 * DT_S, gain: xy / xx })
}

#[allow(clippy::cast_precision_loss)]
fn centred(values: &[f64]) -> Vec<f64> {
    let finite = || values.iter().filter(|v| v.is_finite());
    let mean = finite().sum::<f64>() / (finite().count() as f64).max(1.0);
    values.iter().map(|v| if v.is_finite() { v - mean } else { 0.0 }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_and_weak_answer_is_measured() {
        let input: Vec<f64> = (0..2000).map(|i| (0.013 * f64::from(i)).sin()).collect();
        let late = |lag: usize, gain: f64| -> Vec<f64> {
            (0..2000).map(|i| gain * input[usize::max(i, lag) - lag]).collect()
        };
        let found = answer([(input.clone(), late(23, 0.8))].into_iter(), 1.0).unwrap();
        assert!((found.lag_s - 0.23).abs() < 0.015, "{found:?}");
        assert!((found.gain - 0.8).abs() < 0.02, "{found:?}");
        let still = answer([(vec![0.0; 100], vec![0.0; 100])].into_iter(), 1.0);
        assert_eq!(still, None, "a block that was not driven says nothing");
    }
}
