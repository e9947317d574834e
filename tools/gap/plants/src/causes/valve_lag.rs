//! `valve-lag`: the pilot stage fills slowly.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// A clogged damping orifice before the spool.
pub(super) const CAUSE: Cause = Cause {
    name: "valve-lag",
    block: Block::Arms,
    is_known: true,
    signal: "stroke",
    scopes: Scopes::Any,
    may_begin_late: true,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[Parameter { name: "time_constant_s", spans: &[Span(0.1, 0.4)] }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.arms[wheel].pilot_s = v[0];
        }
    },
};
