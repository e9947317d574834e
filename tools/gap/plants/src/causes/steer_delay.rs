//! `steer-delay`: the steering spools get their command late.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// A dead time in the loop about the joint.
pub(super) const CAUSE: Cause = Cause {
    name: "steer-delay",
    block: Block::Steering,
    is_known: true,
    signal: "joint",
    scopes: Scopes::Whole,
    may_begin_late: true,
    shown_by: Manoeuvre::STurn,
    parameters: &[Parameter { name: "delay_s", spans: &[Span(0.15, 0.45)] }],
    apply: |truth, _, v| truth.steering.delay_s = v[0],
};
