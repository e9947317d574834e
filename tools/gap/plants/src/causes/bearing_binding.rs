//! `bearing-binding`: a wheel bearing binds once a turn.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Drag that comes and goes with the wheel's angle. No catalogue has it.
pub(super) const CAUSE: Cause = Cause {
    name: "bearing-binding",
    block: Block::Drive,
    is_known: false,
    signal: "wheel",
    scopes: Scopes::Any,
    may_begin_late: false,
    shown_by: Manoeuvre::Straight,
    parameters: &[Parameter { name: "torque_nm", spans: &[Span(3000.0, 7000.0)] }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.drive.binding_nm[wheel] = v[0];
        }
    },
};
