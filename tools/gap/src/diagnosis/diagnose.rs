//! The whole diagnosis of one inquiry, step after step.

use rayon::prelude::*;

use xt28_sim::effects::Parameter;

use super::evidence::Evidence;
use super::excitation::not_testable;
use super::hypothesis::{Fit, Hypothesis};
use super::inquiry::Inquiry;
use super::knob::Knob;
use super::verdict::{Cause, Diagnosis, Estimate, Verdict};

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
        progress(Progress { stage: "driving blocks with what was measured", done: 0.0 });
        let runs: Vec<_> = self.runs.iter().map(|run| run.signals.clone()).collect();
        let evidence = Evidence::new(&runs, &self.machine, self.believed.clone(), Knob::all());
        let base = evidence.base_cost();
        let mut fits: Vec<Fit> = Hypothesis::all()
            .into_par_iter()
            .filter(|h| self.catalogue.contains(&h.effect))
            .map(|h| h.fit(&evidence, base))
            .collect();
        fits.sort_by(|a, b| b.log_evidence.total_cmp(&a.log_evidence));
        let best = fits.first().map_or(0.0, |fit| fit.log_evidence.max(0.0));
        let total: f64 =
            (-best).exp() + fits.iter().map(|fit| (fit.log_evidence - best).exp()).sum::<f64>();
        let cause = |fit: &Fit| Cause {
            effect: fit.hypothesis.effect,
            scope: fit.hypothesis.scope,
            probability: (fit.log_evidence - best).exp() / total,
            parameters: estimates(fit),
            class: vec![fit.hypothesis.effect.name],
            begins: None,
            shrink: None,
        };
        let causes: Vec<Cause> = fits.iter().take(10).map(cause).collect();
        let stands = causes.first().is_some_and(|cause| cause.probability > 0.5);
        Diagnosis {
            verdict: if stands { Verdict::Effect } else { Verdict::None },
            places: Vec::new(),
            causes,
            probability_none: (-best).exp() / total,
            probability_unknown: 0.0,
            together: None,
            next: None,
            not_testable: not_testable(&runs, &self.catalogue),
            notes: Vec::new(),
            seconds: 0.0,
        }
    }
}

fn estimates(fit: &Fit) -> Vec<Estimate> {
    let one = |(parameter, value): (&'static Parameter, &f64)| Estimate {
        name: parameter.name,
        value: [*value; 3],
    };
    fit.hypothesis.effect.parameters.iter().zip(&fit.values).map(one).collect()
}
