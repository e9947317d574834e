//! `steer-lag`: the steering valves' pilot stages fill slowly.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// As for an arm's valve.
pub(super) const CAUSE: Cause = Cause {
    name: "steer-lag",
    block: Block::Steering,
    is_known: true,
    signal: "joint",
    scopes: Scopes::Whole,
    may_begin_late: true,
    shown_by: Manoeuvre::STurn,
    parameters: &[Parameter { name: "time_constant_s", spans: &[Span(0.2, 0.6)] }],
    apply: |truth, _, v| truth.steering.pilot_s = v[0],
};
