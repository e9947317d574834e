//! Plain rules on the same logs, each as one would write it down in an afternoon. A diagnosis must be
//! better than these to be worth its trouble.

mod largest_shift;
mod max_lag;
mod one_step_bic;

use xt28_gap::diagnosis::{Inquiry, Signals};
use xt28_machine::Wheel;
use xt28_sim::effects::Scope;

use crate::reply::Reply;

/// One rule: its name and what it makes of an inquiry.
pub struct Baseline {
    /// As printed.
    pub name: &'static str,
    rule: fn(&Inquiry) -> Reply,
}

/// All of them.
pub static BASELINES: [Baseline; 3] = [
    Baseline { name: "largest shift", rule: largest_shift::reply },
    Baseline { name: "one-step BIC", rule: one_step_bic::reply },
    Baseline { name: "max lag", rule: max_lag::reply },
];

impl Baseline {
    /// Its reply.
    #[must_use]
    pub fn reply(&self, inquiry: &Inquiry) -> Reply {
        (self.rule)(inquiry)
    }
}

/// Runs that may be fitted; all of them where none is marked.
fn fitted(inquiry: &Inquiry) -> Vec<Signals> {
    let marked = inquiry.runs.iter().any(|run| run.fit);
    let runs = inquiry.runs.iter().filter(|run| run.fit || !marked);
    runs.map(|run| run.signals.clone()).collect()
}

/// The scope that is most like a group of wheels: shares most of them for its size.
fn nearest_scope(is_in: impl Fn(Wheel) -> bool) -> Scope {
    let unlike =
        |scope: &&Scope| Wheel::ALL.iter().filter(|&&w| is_in(w) != scope.contains(w)).count();
    *Scope::ALL.iter().min_by_key(unlike).expect("there are scopes")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_group_of_wheels_has_its_scope() {
        for scope in Scope::ALL {
            assert_eq!(nearest_scope(|wheel| scope.contains(wheel)), scope);
        }
        let five = |wheel| wheel != Wheel::Fr;
        assert_eq!(nearest_scope(five), Scope::All);
    }
}
