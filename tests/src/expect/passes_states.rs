//! An ECU passes through its states in an order.

use serde::Deserialize;

use super::Evidence;
use super::ecu_state::{Ecu, words};
use crate::trace::EcuState;
use crate::{Bound, Finding};

/// The states of an ECU, one after the other, from the first to the last of the run.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PassesStates {
    /// Whose status frame.
    pub ecu: Ecu,
    /// Each state once for each time it is entered.
    pub states: Vec<EcuState>,
}

impl PassesStates {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let series = self.ecu.states(evidence.trace);
        let mut passed: Vec<EcuState> = series.samples().iter().map(|s| s.value).collect();
        passed.dedup();
        // How far the run goes along, so that a figure says where it left the way.
        let along = passed.iter().zip(&self.states).take_while(|(is, be)| is == be).count();
        let all = along == self.states.len();
        #[allow(clippy::cast_precision_loss)] // a handful
        let [found, wanted] =
            [if all { passed.len() } else { along }, self.states.len()].map(|n| n as f64);
        let what = format!("states that the {} passes in order", self.ecu.name());
        let note = passed.into_iter().map(words).collect::<Vec<_>>().join(", ");
        let wanted = Bound::Near { value: wanted, tolerance: 0.0 };
        vec![Finding::of(what, found, wanted, "").noting(note)]
    }
}
