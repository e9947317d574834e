//! `standstill-drag`: idle motors hold their wheels.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// An arm that swings at a stand then pinches its wheel against the ground.
pub(super) const CAUSE: Cause = Cause {
    name: "standstill-drag",
    block: Block::Drive,
    is_known: true,
    signal: "load",
    scopes: Scopes::Any,
    may_begin_late: false,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[Parameter { name: "torque_nm", spans: &[Span(2000.0, 6000.0)] }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.drive.idle_hold_nm[wheel] = v[0];
        }
    },
};
