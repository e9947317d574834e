//! `rear-follower-lag`: the rear joint follows late and weakly.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// A filter on the front angle in the ECU, and another ratio.
pub(super) const CAUSE: Cause = Cause {
    name: "rear-follower-lag",
    block: Block::Steering,
    is_known: true,
    signal: "joint",
    scopes: Scopes::Whole,
    may_begin_late: false,
    shown_by: Manoeuvre::STurn,
    parameters: &[
        Parameter { name: "time_constant_s", spans: &[Span(0.6, 1.6)] },
        Parameter { name: "ratio_factor", spans: &[Span(0.65, 0.9)] },
    ],
    apply: |truth, _, v| (truth.ecu.rear_filter_s, truth.ecu.rear_ratio) = (v[0], v[1]),
};
