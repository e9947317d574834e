//! `leakage-drift`: a loaded cylinder sinks.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Laminar flow past the piston, in proportion to the load.
pub(super) const CAUSE: Cause = Cause {
    name: "leakage-drift",
    block: Block::Arms,
    is_known: true,
    signal: "stroke",
    scopes: Scopes::Any,
    may_begin_late: true,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[Parameter { name: "rate_m_s", spans: &[Span(0.003, 0.01)] }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.arms[wheel].leak_m_s = v[0];
        }
    },
};
