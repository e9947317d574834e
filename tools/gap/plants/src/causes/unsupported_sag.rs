//! `unsupported-sag`: an arm that carries little draws out.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// The rod side's check opens too soon and the wheel's weight does the rest.
pub(super) const CAUSE: Cause = Cause {
    name: "unsupported-sag",
    block: Block::Arms,
    is_known: true,
    signal: "stroke",
    scopes: Scopes::Any,
    may_begin_late: true,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[
        Parameter { name: "rate_m_s", spans: &[Span(0.006, 0.015)] },
        Parameter { name: "below_n", spans: &[Span(10_000.0, 20_000.0)] },
    ],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.arms[wheel].sag_m_s = v[0];
            truth.arms[wheel].sag_below_n = v[1];
        }
    },
};
