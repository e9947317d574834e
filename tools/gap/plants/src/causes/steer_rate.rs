//! `steer-rate`: the joints turn at other rates.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// A flow setting of another machine.
pub(super) const CAUSE: Cause = Cause {
    name: "steer-rate",
    block: Block::Steering,
    is_known: true,
    signal: "joint",
    scopes: Scopes::Whole,
    may_begin_late: true,
    shown_by: Manoeuvre::STurn,
    parameters: &[Parameter { name: "factor", spans: &[Span(0.45, 0.7), Span(1.4, 1.8)] }],
    apply: |truth, _, v| truth.steering.flow = v[0],
};
