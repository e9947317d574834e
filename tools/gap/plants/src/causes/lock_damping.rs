//! `lock-damping`: the throttle before the accumulator is not as assumed.

use crate::causes::{Block, Cause, Parameter, Span};
use crate::manoeuvre::Manoeuvre;

/// Another bore, another oil.
pub(super) const CAUSE: Cause = Cause {
    name: "lock-damping",
    block: Block::Arms,
    is_known: true,
    signal: "load",
    is_scoped: true,
    may_begin_late: false,
    shown_by: Manoeuvre::Ramp,
    parameters: &[Parameter { name: "factor", spans: &[Span(0.2, 0.45), Span(2.2, 4.0)] }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.arms[wheel].damping_n_s_m *= v[0];
        }
    },
};
