//! Grounding, the paper's terminal condition: nothing but wheels may touch the ground.

use serde::Deserialize;

use super::Evidence;
use crate::series::{Sample, mean};
use crate::{Bound, Finding};

/// The greatest force of the ground on anything but the wheels over a window. No bus carries it, so only
/// a simulator's truth tells.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClearsGround {
    /// Start of the window, s.
    pub from_s: f64,
    /// End of the window, s.
    pub to_s: f64,
    /// Greatest force, kN; 0 or left out where nothing may touch at all.
    #[serde(default)]
    pub at_most_kn: f64,
}

const N_PER_KN: f64 = 1e3;

impl ClearsGround {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let wanted = Bound::AtMost(self.at_most_kn);
        let what = "greatest force of the ground on the frames, true";
        let Some(truth) = evidence.truth else {
            let why = "the bus does not carry it; it takes a simulated machine";
            return vec![Finding::missing(what, wanted, "kN", why)];
        };
        let chassis = &truth.chassis_force_n;
        let forces = match chassis.covering(self.from_s, self.to_s, "truth of the frames") {
            Ok(forces) => forces,
            Err(note) => return vec![Finding::missing(what, wanted, "kN", note)],
        };
        // Not a number is above all that are: a plant that lost its figures has cleared nothing.
        let hardest = forces.iter().copied().max_by(|a, b| a.value.total_cmp(&b.value));
        vec![match hardest {
            Some(Sample { at_s, value }) if value != 0.0 => {
                let mean_kn = mean(forces, |force_n| *force_n).unwrap_or(0.0) / N_PER_KN;
                Finding::of(what, value / N_PER_KN, wanted, "kN")
                    .noting(format!("at {at_s:.2} s; {mean_kn:.2} in the mean"))
            }
            _ => Finding::of(what, 0.0, wanted, "kN"),
        }]
    }
}
