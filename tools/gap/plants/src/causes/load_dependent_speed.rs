//! `load-dependent-speed`: speed depends on the cylinder's load.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// A compensator that sticks lets a share of the load pressure through to the spool.
pub(super) const CAUSE: Cause = Cause {
    name: "load-dependent-speed",
    block: Block::Arms,
    is_known: true,
    signal: "stroke",
    scopes: Scopes::Any,
    may_begin_late: true,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[Parameter { name: "loss", spans: &[Span(0.45, 0.95)] }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.arms[wheel].compensator_loss = v[0];
        }
    },
};
