//! Two looks at the runs: what sets in does so in every run alike, or else once on the day.
//!
//! There are so many instants of a day that what sets in once could be anything that a model does not quite say: joints
//! that play without steering, in the first runs of a day. So it is looked for only where the first look ends in
//! something unknown, and believed only where it leaves nothing unknown; told as a lead where it leaves less.

use super::diagnose::Progress;
use super::inquiry::Inquiry;
use super::judgement::{Findings, judge};
use super::onset::on_the_day;
use super::signals::Signals;
use super::verdict::{Cause, Diagnosis, Verdict};

/// Shares of a diagnosis between which the second look is.
const SECOND_LOOK: [f64; 2] = [0.7, 0.75];

impl Inquiry {
    /// What the logs say of every hypothesis, before it is judged.
    #[must_use]
    pub fn findings(&self, progress: &(dyn Fn(Progress) + Sync)) -> Findings {
        self.looked(progress).0
    }

    /// The same, and how it is judged.
    pub(super) fn looked(&self, progress: &(dyn Fn(Progress) + Sync)) -> (Findings, Diagnosis) {
        let every_run = self.findings_of(&self.fitted_and_held(false), progress);
        let first = judge(self, &every_run);
        let fitted = self.runs.iter().filter(|run| run.fit).map(|run| &run.signals);
        if first.verdict != Verdict::Unknown || on_the_day(fitted).is_empty() {
            return (every_run, first);
        }
        let [from, to] = SECOND_LOOK;
        let once = self.findings_of(&self.fitted_and_held(true), &|at: Progress| {
            let done = from + (to - from) * at.done;
            progress(Progress { stage: "looking for what set in once", done });
        });
        let second = judge(self, &once);
        let comes_once = |cause: &Cause| cause.onset().is_once();
        let leads =
            second.causes.first().is_some_and(comes_once) || second.stood_by().any(comes_once);
        let is_better = match second.verdict {
            Verdict::Effect => true,
            // It is no more believed, but a better lead.
            Verdict::Unknown => second.grounds.left_over < first.grounds.left_over,
            Verdict::None => false,
        };
        if leads && is_better { (once, second) } else { (every_run, first) }
    }

    /// Runs that are fitted and runs that are held out, each where it was on its day or as if nobody knew.
    fn fitted_and_held(&self, on_their_day: bool) -> [Vec<Signals>; 2] {
        [true, false].map(|fit| {
            let runs = self.runs.iter().filter(|run| run.fit == fit);
            let mut runs: Vec<Signals> = runs.map(|run| run.signals.clone()).collect();
            if !on_their_day {
                runs.iter_mut().for_each(|run| run.began_s = 0.0);
            }
            runs
        })
    }
}
