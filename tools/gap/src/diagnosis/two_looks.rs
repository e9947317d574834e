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
use super::verdict::{Cause, Verdict};

/// Shares of a diagnosis between which the second look is.
const SECOND_LOOK: [f64; 2] = [0.7, 0.75];

impl Inquiry {
    /// What the logs say of every hypothesis, before it is judged.
    #[must_use]
    pub fn findings(&self, progress: &(dyn Fn(Progress) + Sync)) -> Findings {
        let of = |fit: bool| -> Vec<Signals> {
            let runs = self.runs.iter().filter(|run| run.fit == fit);
            runs.map(|run| run.signals.clone()).collect()
        };
        let on_their_day = [of(true), of(false)];
        let each = on_their_day.clone().map(apart);
        let every_run = self.findings_of(&each, progress);
        let first = judge(self, &every_run);
        if first.verdict != Verdict::Unknown || on_the_day(&on_their_day[0]).is_empty() {
            return every_run;
        }
        let [from, to] = SECOND_LOOK;
        let once = self.findings_of(&on_their_day, &|at: Progress| {
            let done = from + (to - from) * at.done;
            progress(Progress { stage: "looking for what set in once", done });
        });
        let told = judge(self, &once);
        let comes_once = |cause: &Cause| cause.onset().is_once();
        let leads = told.causes.first().is_some_and(comes_once) || told.stood_by().any(comes_once);
        let is_better = match told.verdict {
            Verdict::Effect => true,
            // It is no more believed, but a better lead.
            Verdict::Unknown => told.grounds.left_over < first.grounds.left_over,
            Verdict::None => false,
        };
        if leads && is_better { once } else { every_run }
    }
}

/// Runs of which nobody knows which was first.
fn apart(mut runs: Vec<Signals>) -> Vec<Signals> {
    runs.iter_mut().for_each(|run| run.began_s = 0.0);
    runs
}
