//! What a report shows beside the verdict: the gap by block and regime and over the horizon, and
//! traces before and after. Nothing here takes part in the verdict.
//!
//! Residuals are those of the machine as believed, without the tolerances at their best: a report
//! shows what the simulator does as it stands, and what it does with the causes put in.

mod horizons;
mod over_time;
mod regimes;
mod traces;
mod whole;

use rayon::prelude::*;
use xt28_sim::Effects;

use super::generator::{Generator, Residual, STEP_S};
use super::inquiry::Inquiry;
use super::onset::FirstOnset;
use super::verdict::Diagnosis;
use crate::GapError;

pub use horizons::{Curve, HORIZONS_S};
pub use over_time::{CELL_S, Strip};
pub use regimes::{OF_ARM, REGIMES, RegimeGaps};
pub use traces::Trace;

/// The details of one diagnosis.
#[derive(Clone, Debug)]
pub struct Details {
    /// The runs.
    pub runs: Vec<RunLine>,
    /// Root mean square of every generator's residual in each of [`REGIMES`], floors.
    pub map: Vec<RegimeGaps>,
    /// The same over the time of every run.
    pub strips: Vec<Strip>,
    /// How every generator's error grows with time: first where the verdict sees most, then the largest.
    pub horizons: Vec<Curve>,
    /// Where the gap is largest on runs that were not fitted, before and after; on fitted ones where
    /// all were.
    pub traces: Vec<Trace>,
    /// The whole machine over the run that parts most of those not fitted, before and after; nothing where how far the
    /// gap shrinks was not asked.
    pub whole: Vec<Trace>,
    /// Whether there are causes to put in: else before and after are the same.
    pub has_after: bool,
    /// What is wrong with the logs, a line each.
    pub faults: Vec<String>,
}

/// One run of a report.
#[derive(Clone, Debug)]
pub struct RunLine {
    /// Name of the log, without its folder.
    pub name: String,
    /// Length, s.
    pub seconds: f64,
    /// Frames in the log.
    pub frames: u64,
    /// Whether causes were fitted on it.
    pub fit: bool,
    /// When the first cause begins in it, s: 0 from its start, never where that is beyond its end.
    pub since_s: f64,
}

/// Residuals of one generator on one run, before and after.
struct Pair {
    run: usize,
    generator: Generator,
    before: Vec<Residual>,
    after: Vec<Residual>,
}

impl Details {
    /// The details of `diagnosis`, which answers `inquiry`.
    ///
    /// # Errors
    /// [`GapError::Command`] for a command that our bus cannot say.
    pub fn new(inquiry: &Inquiry, diagnosis: &Diagnosis) -> Result<Self, GapError> {
        let overlay = diagnosis.overlay();
        let mut with_causes = inquiry.believed.clone();
        overlay.entries.iter().for_each(|entry| entry.apply(&inquiry.machine, &mut with_causes));
        let since = diagnosis.since();
        let pairs = pairs(inquiry, &with_causes, &since);
        Ok(Self {
            runs: inquiry
                .runs
                .iter()
                .map(|run| RunLine {
                    name: run.file(),
                    seconds: run.signals.duration_s(),
                    frames: run.log.frames(),
                    fit: run.fit,
                    since_s: since.in_run(run.signals.began_s),
                })
                .collect(),
            map: regimes::map(inquiry, &pairs),
            strips: over_time::strips(&pairs),
            horizons: horizons::curves(&pairs, diagnosis),
            traces: traces::traces(inquiry, &pairs),
            whole: whole::whole(inquiry, diagnosis)?,
            has_after: !overlay.entries.is_empty(),
            faults: inquiry.runs.iter().flat_map(|run| run.log.told_faults()).collect(),
        })
    }
}

/// Every generator on every run, before and after; `with_causes` from `since` on.
fn pairs(inquiry: &Inquiry, with_causes: &Effects, since: &FirstOnset) -> Vec<Pair> {
    let runs = 0..inquiry.runs.len();
    let jobs: Vec<(usize, Generator)> =
        runs.flat_map(|run| Generator::all().into_iter().map(move |g| (run, g))).collect();
    let pair = |(run, generator): (usize, Generator)| {
        let signals = &inquiry.runs[run].signals;
        let of = |effects| generator.residuals(signals, &inquiry.machine, effects);
        let since_s = since.in_run(signals.began_s);
        let (before, mut after) = (of(&inquiry.believed), of(with_causes));
        for (before, after) in before.iter().zip(&mut after) {
            let values = before.values.iter().zip(&mut after.values).zip(0_u32..);
            let early = values.take_while(|(_, k)| f64::from(*k) * STEP_S < since_s);
            early.for_each(|((before, after), _)| *after = *before);
        }
        Pair { run, generator, before, after }
    };
    jobs.into_par_iter().map(pair).collect()
}

/// Root mean square of what is finite; `None` without any.
#[allow(clippy::cast_precision_loss)]
fn rms(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, n) =
        values.filter(|v| v.is_finite()).fold((0.0, 0_usize), |(sum, n), v| (sum + v * v, n + 1));
    (n > 0).then(|| (sum / n as f64).sqrt())
}
