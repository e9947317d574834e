//! `steer-backlash`: the pins of the steering cylinders have clearance.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Within it nothing but the ground holds the joint.
pub(super) const CAUSE: Cause = Cause {
    name: "steer-backlash",
    block: Block::Steering,
    is_known: true,
    signal: "joint",
    scopes: Scopes::Whole,
    may_begin_late: false,
    shown_by: Manoeuvre::STurn,
    parameters: &[Parameter { name: "width_rad", spans: &[Span(0.026, 0.06)] }],
    apply: |truth, _, v| truth.steering.clearance_rad = v[0],
};
