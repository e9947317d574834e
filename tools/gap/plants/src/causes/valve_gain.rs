//! `valve-gain`: all speeds of an arm are scaled.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// The drop held over the spool is not the one it was cut for; flow goes by its root.
pub(super) const CAUSE: Cause = Cause {
    name: "valve-gain",
    block: Block::Arms,
    is_known: true,
    signal: "stroke",
    scopes: Scopes::Any,
    may_begin_late: true,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[Parameter { name: "factor", spans: &[Span(0.55, 0.8), Span(1.2, 1.45)] }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.arms[wheel].margin = v[0] * v[0];
        }
    },
};
