//! `rolling-resistance`: the wheels roll hard.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Soft ground or a low tyre: drag torque over normal force and radius.
pub(super) const CAUSE: Cause = Cause {
    name: "rolling-resistance",
    block: Block::Drive,
    is_known: true,
    signal: "pump",
    scopes: Scopes::Any,
    may_begin_late: false,
    shown_by: Manoeuvre::Straight,
    parameters: &[Parameter { name: "coefficient", spans: &[Span(0.06, 0.12)] }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.body.tyres[wheel].rolling = v[0];
        }
    },
};
