//! What was true of the plant during a run: what no bus carries, and only a simulator knows.

use xt28_machine::PerWheel;
use xt28_sim::VehicleState;

use crate::Series;

/// True quantities over time, s from the start of the run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Truth {
    /// Vertical force of the ground on each wheel, N.
    pub ground_force_n: Series<PerWheel<f64>>,
}

impl Truth {
    /// Adds the plant's state at `at_s`.
    pub fn push(&mut self, at_s: f64, state: &VehicleState) {
        self.ground_force_n.push(at_s, state.ground_force_n);
    }
}
