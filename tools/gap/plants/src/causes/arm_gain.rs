//! `arm-gain`: the position controllers have other gains.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// A parameter set of another machine.
pub(super) const CAUSE: Cause = Cause {
    name: "arm-gain",
    block: Block::Arms,
    is_known: true,
    signal: "opening",
    scopes: Scopes::Any,
    may_begin_late: false,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[
        Parameter { name: "kp_factor", spans: &[Span(0.5, 0.7), Span(1.4, 1.8)] },
        Parameter { name: "ki_factor", spans: &[Span(0.4, 2.0)] },
    ],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.ecu.arm_kp[wheel] = v[0];
            truth.ecu.arm_ki[wheel] = v[1];
        }
    },
};
