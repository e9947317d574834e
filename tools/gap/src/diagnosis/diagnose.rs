//! The whole diagnosis of one inquiry, step after step.

use super::candidates::{Candidate, Docket};
use super::inquiry::Inquiry;
use super::judgement::{Findings, judge};
use super::signals::Signals;
use super::verdict::Diagnosis;

/// A second cause must be worth this much, nats.
const SECOND_MIN: f64 = 12.0;

/// How far a diagnosis has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What is being done.
    pub stage: &'static str,
    /// Share of the whole that is done, 0 to 1.
    pub done: f64,
}

impl Inquiry {
    /// The answer. `progress` hears of every step, from any thread.
    #[must_use]
    pub fn diagnose(&self, progress: &(dyn Fn(Progress) + Sync)) -> Diagnosis {
        judge(self, &self.findings(progress))
    }

    /// What the logs say of every hypothesis, before it is judged.
    #[must_use]
    pub fn findings(&self, progress: &(dyn Fn(Progress) + Sync)) -> Findings {
        let tell = |stage, done| progress(Progress { stage, done });
        let of = |fit: bool| -> Vec<Signals> {
            let runs = self.runs.iter().filter(|run| run.fit == fit);
            runs.map(|run| run.signals.clone()).collect()
        };
        let (fit, held) = (of(true), of(false));
        let docket = |base: &_| Docket::new(&fit, &held, &self.machine, base);
        tell("driving every block with what was measured", 0.0);
        let first = docket(&self.believed);
        let before = first.left(&[]);
        tell("trying every cause", 0.05);
        let single = first.candidates(&self.catalogue);
        let Some(best) = single.first().cloned() else {
            return Findings { before, single, pair: Vec::new(), after: Vec::new() };
        };
        tell("trying second causes", 0.4);
        let pair = self.second(&docket, &best);
        tell("looking at what is left", 0.7);
        let after = match pair.first() {
            Some([first, second]) => {
                let base = first.fit.hypothesis.applied(&self.believed, &first.fit.values);
                docket(&base).left(&[&second.fit])
            }
            None => first.left(&[&best.fit]),
        };
        Findings { before, single, pair, after }
    }

    /// Two causes at once, the best first; none where one is enough.
    ///
    /// With the first believed, a second is sought; with that believed, the first is sought anew,
    /// for it was found while the second still disturbed.
    fn second<'a>(
        &self,
        docket: &dyn Fn(&xt28_sim::Effects) -> Docket<'a>,
        best: &Candidate,
    ) -> Vec<[Candidate; 2]> {
        let beside = |one: &Candidate| {
            let base = one.fit.hypothesis.applied(&self.believed, &one.fit.values);
            let others: Vec<_> = self
                .catalogue
                .iter()
                .copied()
                .filter(|effect| *effect != one.fit.hypothesis.effect)
                .collect();
            docket(&base).candidates(&others)
        };
        let seconds = beside(best);
        let Some(second) = seconds.first().filter(|second| second.score() > SECOND_MIN) else {
            return Vec::new();
        };
        let firsts = beside(second);
        let again = firsts.first().filter(|first| first.score() > SECOND_MIN).cloned();
        let first = again.unwrap_or_else(|| best.clone());
        seconds.into_iter().take(10).map(|second| [first.clone(), second]).collect()
    }
}
