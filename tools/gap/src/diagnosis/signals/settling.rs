//! A log that begins while its machine moves: what was before it no log says, and blocks remember it.
//!
//! A drive that lags, a valve that follows, a filter of the attitude and oil under pressure go on from where they
//! were. A log that begins at rest says where that is. One that begins underway does not, and what a block is then
//! off by in its first seconds is the beginning's and not the machine's.

use super::{DT_S, Samples, Signals};

/// How long blocks remember what was before the log, s: the slowest that all machines have, the filter of the roll,
/// keeps a twelfth of it then (2 s, facts 5).
const REMEMBERS_S: f64 = 5.0;
/// What is looked at to tell whether the machine moves as its log begins, s: one that is armed a moment later and sets
/// out stood until then.
const BEGINS_S: f64 = 0.15;
/// What is looked at to tell whether its attitude is settled, which a slow filter shows later, s.
const SETTLED_S: f64 = 0.5;
/// Throttle that asks for nothing, at the most (assumed).
const ASKS: f64 = 0.02;
/// How far a valve of an arm is open in the mean that holds a stance or begins a sway, at the most (assumed).
const OPENS: f64 = 0.1;
/// What the wheels of a machine that stands turn at together, at the most, rad/s: 4 cm/s at the rim (assumed).
const STANDS_RAD_S: f64 = 0.05;
/// What a joint that stands turns by meanwhile, at the most, rad: 0.2 deg (assumed).
const TURNS_RAD: f64 = 0.004;
/// What the attitude changes by at the most that no filter has yet to settle on, rad, while nothing is asked of the
/// drive and no stroke reads more than its next step or two: 0.09 deg (assumed), from its mean over the first third to
/// that over the last, as a reading may be as noisy.
const SETTLES_RAD: f64 = 0.0015;
const SWINGS_M: f64 = 0.002;

impl Signals {
    /// How long blocks cannot be judged as the log begins, s: not at all, where it begins at rest.
    #[must_use]
    pub fn settles_s(&self) -> f64 {
        if self.begins_underway() { REMEMBERS_S.min(self.duration_s()) } else { 0.0 }
    }

    /// Whether the machine moves, or is asked to drive, as the log begins, or did so just before.
    fn begins_underway(&self) -> bool {
        let mean = |samples: &[f64]| mean(first(samples, BEGINS_S));
        let rolls_rad_s = |i| self.mean_wheel_speed_rad_s(i).abs();
        let any = |all: &[Samples], within_s: f64, most: f64| {
            all.iter().any(|samples| span(samples, within_s) > most)
        };
        mean(&self.throttle).abs() > ASKS
            || (0..first(&self.throttle, BEGINS_S).len()).any(|i| rolls_rad_s(i) > STANDS_RAD_S)
            || self.opening.iter().any(|(_, opening)| mean(opening).abs() > OPENS)
            || any(&self.joint_rad, BEGINS_S, TURNS_RAD)
            || !first(&self.throttle, SETTLED_S).iter().any(|throttle| throttle.abs() > ASKS)
                && [&self.roll_rad, &self.pitch_rad]
                    .into_iter()
                    .any(|angle| change(first(angle, SETTLED_S)).abs() > SETTLES_RAD)
                && !any(&self.stroke_reading_m.0, SETTLED_S, SWINGS_M)
    }
}

/// The first of the samples.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn first(samples: &[f64], within_s: f64) -> &[f64] {
    &samples[..samples.len().min((within_s / DT_S) as usize)]
}

fn mean(samples: &[f64]) -> f64 {
    samples.iter().sum::<f64>() / samples.len().max(1) as f64
}

/// From the mean of the first third to that of the last.
fn change(samples: &[f64]) -> f64 {
    let third = samples.len() / 3;
    mean(&samples[samples.len() - third..]) - mean(&samples[..third])
}

/// How far the first of the samples lie apart.
fn span(samples: &[f64], within_s: f64) -> f64 {
    let widen = |[low, high]: [f64; 2], x: &f64| [low.min(*x), high.max(*x)];
    let [low, high] = first(samples, within_s).iter().fold([f64::MAX, f64::MIN], widen);
    high - low
}

#[cfg(test)]
mod tests {
    use super::super::super::generator::still;
    use super::*;

    #[test]
    fn blocks_settle_only_in_a_log_that_begins_underway() {
        let settles_s = |moved: &dyn Fn(&mut Signals)| {
            let mut s = still::still(20);
            moved(&mut s);
            s.settles_s()
        };
        assert_eq!(settles_s(&|_| ()), 0.0);
        assert_eq!(settles_s(&|s| s.throttle[20..].fill(0.5)), 0.0, "it sets out later");
        assert_eq!(settles_s(&|s| s.throttle.fill(-0.5)), REMEMBERS_S);
        let rolls = |s: &mut Signals, rad_s: &[f64; 6]| {
            s.wheel_speed_rad_s
                .0
                .iter_mut()
                .zip(rad_s)
                .for_each(|(wheel, rad_s)| wheel.fill(*rad_s));
        };
        assert_eq!(settles_s(&|s| rolls(s, &[0.8; 6])), REMEMBERS_S);
        assert_eq!(settles_s(&|s| rolls(s, &[0.2, 0.0, 0.0, 0.0, 0.0, 0.0])), 0.0, "one misreads");
        assert_eq!(settles_s(&|s| s.opening.0[3].fill(0.05)), 0.0, "it holds its arms");
        assert_eq!(settles_s(&|s| s.opening.0[3].fill(0.15)), REMEMBERS_S);
        assert_eq!(settles_s(&|s| s.joint_rad[0][10..].fill(0.02)), REMEMBERS_S);
        let leans = |s: &mut Signals, swings_m: f64| {
            s.pitch_rad[20..].fill(0.004);
            s.stroke_reading_m.0[3][20..].fill(swings_m);
        };
        assert_eq!(settles_s(&|s| leans(s, 0.001)), REMEMBERS_S, "a filter that settles");
        assert_eq!(settles_s(&|s| leans(s, 0.005)), 0.0, "arms that let it lean");
        let shakes = |s: &mut Signals| {
            s.pitch_rad.iter_mut().step_by(2).for_each(|pitch_rad| *pitch_rad += 0.004);
        };
        assert_eq!(settles_s(&shakes), 0.0, "an attitude that is noisy");
        let sets_out = |s: &mut Signals| {
            s.throttle[30..].fill(0.5);
            leans(s, 0.0);
        };
        assert_eq!(settles_s(&sets_out), 0.0, "a machine that squats as it sets out");
        let short = |s: &mut Signals| {
            s.throttle.fill(0.5);
            s.len = 300;
        };
        assert_eq!(settles_s(&short), 3.0);
    }
}
