//! `steer-creep`: the joints creep to one side.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// A steering cylinder that leaks on one side. No catalogue has it.
pub(super) const CAUSE: Cause = Cause {
    name: "steer-creep",
    block: Block::Steering,
    is_known: false,
    signal: "joint",
    scopes: Scopes::Whole,
    may_begin_late: false,
    shown_by: Manoeuvre::STurn,
    parameters: &[Parameter {
        name: "rate_rad_s",
        spans: &[Span(-0.035, -0.015), Span(0.015, 0.035)],
    }],
    apply: |truth, _, v| truth.steering.creep_rad_s = v[0],
};
