//! `soft-tyres`: the tyres give.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Low pressure: a spring and a damper between rim and ground.
pub(super) const CAUSE: Cause = Cause {
    name: "soft-tyres",
    block: Block::Tyre,
    is_known: true,
    signal: "att",
    scopes: Scopes::Any,
    may_begin_late: false,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[
        Parameter { name: "stiffness_n_m", spans: &[Span(3.0e5, 7.0e5)] },
        Parameter { name: "damping_n_s_m", spans: &[Span(5000.0, 20_000.0)] },
    ],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.body.tyres[wheel].stiffness_n_m = v[0];
            truth.body.tyres[wheel].damping_n_s_m = v[1];
        }
    },
};
