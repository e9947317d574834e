//! `steer-gain`: the steering controllers have other gains.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// A parameter set of another machine.
pub(super) const CAUSE: Cause = Cause {
    name: "steer-gain",
    block: Block::Steering,
    is_known: true,
    signal: "steer",
    scopes: Scopes::Whole,
    may_begin_late: false,
    shown_by: Manoeuvre::STurn,
    parameters: &[
        Parameter { name: "kp_factor", spans: &[Span(0.5, 0.7), Span(1.5, 2.0)] },
        Parameter { name: "ki_factor", spans: &[Span(0.4, 2.0)] },
    ],
    apply: |truth, _, v| (truth.ecu.steer_kp, truth.ecu.steer_ki) = (v[0], v[1]),
};
