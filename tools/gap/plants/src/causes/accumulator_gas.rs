//! `accumulator-gas`: nitrogen instead of the linear spring.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;
use crate::truth::Gas;

/// Soft where the arm is light, stiff where it is heavy, closed below its precharge.
pub(super) const CAUSE: Cause = Cause {
    name: "accumulator-gas",
    block: Block::Arms,
    is_known: true,
    signal: "load",
    scopes: Scopes::Any,
    may_begin_late: false,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[
        Parameter { name: "precharge_pa", spans: &[Span(1.0e6, 3.0e6)] },
        Parameter { name: "volume_m3", spans: &[Span(5.0e-4, 0.0016)] },
        Parameter { name: "exponent", spans: &[Span(1.1, 1.5)] },
    ],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            let gas = Gas { precharge_pa: v[0], volume_m3: v[1], exponent: v[2] };
            truth.arms[wheel].gas = Some(gas);
        }
    },
};
