//! `lock-damping`: the throttle before the accumulator is not as assumed.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Another bore, another oil.
pub(super) const CAUSE: Cause = Cause {
    name: "lock-damping",
    block: Block::Arms,
    is_known: true,
    signal: "stroke",
    scopes: Scopes::Any,
    may_begin_late: false,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[Parameter { name: "factor", spans: &[Span(0.1, 0.3), Span(2.5, 5.0)] }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.arms[wheel].damping_n_s_m *= v[0];
        }
    },
};
