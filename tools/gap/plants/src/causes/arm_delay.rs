//! `arm-delay`: the spool gets its command late.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Task, driver and pilot stage add up; a ring of past commands is read some time back.
pub(super) const CAUSE: Cause = Cause {
    name: "arm-delay",
    block: Block::Arms,
    is_known: true,
    signal: "stroke",
    scopes: Scopes::Any,
    may_begin_late: true,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[Parameter { name: "delay_s", spans: &[Span(0.1, 0.35)] }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.arms[wheel].delay_s = v[0];
        }
    },
};
