//! Causes that are named by their evidence and shrink nothing: who reads a verdict must not have to find
//! that in a table.

use xt28_sim::effects::Block;

use super::verdict::{Cause, Diagnosis, Shrink};

impl Shrink {
    /// Whether it is beyond chance on the whole machine, 5 s ahead or over whole runs.
    #[must_use]
    pub fn is_sure(&self) -> bool {
        let [_, five_s, run] = self.interval;
        five_s[0] > 0.0 || run[0] > 0.0
    }
}

impl Diagnosis {
    /// A sentence for each cause that it stands by although that was seen to shrink nothing.
    #[must_use]
    pub fn unshrunk(&self) -> Vec<String> {
        let alone = if self.stood_by().count() > 1 { " by itself" } else { "" };
        let runs = if self.held_out_runs.is_empty() { "fitted" } else { "held-out" };
        let told = |cause: &Cause| {
            let why = if cause.effect.block == Block::Bus {
                "commands come as they came in the log, so that what the bus does is there without it"
            } else {
                "the 90 % interval of its shrink reaches 0 or less both 5 s ahead and over whole runs"
            };
            format!(
                "{} is named by its evidence, but putting it in{alone} does not shrink the gap on the \
                 {runs} runs: {why}.",
                cause.effect.name
            )
        };
        let is_idle = |cause: &&Cause| cause.shrink.is_some_and(|shrink| !shrink.is_sure());
        self.stood_by().filter(is_idle).map(told).collect()
    }
}
