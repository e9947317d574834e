//! Bumps of a residual: one is no law and is overlooked, but what comes a third time is one.

use super::stack::Group;

/// Share of the samples of a signal that may be bumps.
const BUMPS: f64 = 0.04;
/// Peaks nearer than this in one run are one bump, s.
const APART_S: f64 = 2.0;
/// The bump that makes a law: one is an accident, and its end may be another.
const RECURS: usize = 3;

/// What a mean square does not tell of a signal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bumps {
    /// Mean square without the samples that leave most, floors.
    pub(super) steady: f64,
    /// The third largest of all bumps at its peak, floors; zero where there are fewer.
    pub(super) recurring: f64,
}

impl Bumps {
    /// Of `samples`, each its instant in its run, s, and its value times the root of its weight; run after
    /// run, all of `group`.
    pub(super) fn of(samples: &[(f64, f64)], group: &Group) -> Self {
        let root = group.signal.weight().sqrt();
        Self { steady: steady(samples, group), recurring: recurring(samples) / root }
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss, clippy::cast_sign_loss)]
fn steady(samples: &[(f64, f64)], group: &Group) -> f64 {
    let mut squares: Vec<f64> = samples.iter().map(|(_, value)| value * value).collect();
    squares.sort_by(f64::total_cmp);
    let kept = (squares.len() as f64 * (1.0 - BUMPS)).ceil() as usize;
    squares[..kept].iter().sum::<f64>() / ((1.0 - BUMPS) * group.samples).max(1.0)
}

fn recurring(samples: &[(f64, f64)]) -> f64 {
    let runs: Vec<&[(f64, f64)]> = samples.chunk_by(|a, b| a.0 < b.0).collect();
    let mut peaks: Vec<(usize, f64)> = Vec::new();
    for _ in 0..RECURS {
        let is_new = |run: usize, at_s: f64| {
            peaks.iter().all(|&(other, peak_s)| run != other || (at_s - peak_s).abs() > APART_S)
        };
        let all =
            runs.iter().enumerate().flat_map(|(run, own)| own.iter().map(move |one| (run, one)));
        let new = all.filter(|&(run, &(at_s, _))| is_new(run, at_s));
        let Some((run, &(at_s, value))) = new.max_by(|a, b| a.1.1.abs().total_cmp(&b.1.1.abs()))
        else {
            return 0.0;
        };
        peaks.push((run, at_s));
        if peaks.len() == RECURS {
            return value.abs();
        }
    }
    0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::floor::Signal;

    /// Two runs of 30 s with bumps of four floors at these instants of the first, s.
    fn bumps(at: &[f64]) -> Bumps {
        let signal = Signal::JointFast;
        let root = signal.weight().sqrt();
        let value = |run: usize, at_s: f64| {
            let near = run == 0 && at.iter().any(|bump_s| (at_s - bump_s).abs() < 0.15);
            root * if near { -4.0 } else { 0.2 }
        };
        let run = |run: usize| (0..300).map(move |i| f64::from(i) * 0.1).map(move |s| (run, s));
        let samples: Vec<_> =
            [0, 1].into_iter().flat_map(run).map(|(run, s)| (s, value(run, s))).collect();
        Bumps::of(&samples, &Group { signal, samples: 600.0 * signal.weight() })
    }

    #[test]
    fn what_comes_a_third_time_is_no_bump() {
        for (at, recurring) in [
            (&[][..], 0.2),
            (&[10.0], 0.2),
            (&[10.0, 20.0], 0.2),
            (&[10.0, 11.0, 20.0, 21.0], 0.2),
            (&[5.0, 10.0, 20.0], 4.0),
        ] {
            let told = bumps(at);
            assert!((told.recurring - recurring).abs() < 1e-9, "{at:?}: {told:?}");
            assert!((told.steady - 0.04).abs() < 1e-3, "{at:?}: {told:?}");
        }
    }

    #[test]
    fn two_runs_have_their_own_bumps() {
        let samples = [(0.0, 1.0), (0.1, 3.0), (0.2, 1.0), (0.0, 1.0), (0.1, 2.0), (9.0, 1.5)];
        assert!((recurring(&samples) - 1.5).abs() < 1e-12);
        assert!(recurring(&samples[..5]).abs() < 1e-12);
    }
}
