//! `oil-heating`: the oil warms up from stiff to thin.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Damping runs from several times nominal to as small a part of it. No catalogue has it.
pub(super) const CAUSE: Cause = Cause {
    name: "oil-heating",
    block: Block::Arms,
    is_known: false,
    signal: "stroke",
    scopes: Scopes::Whole,
    may_begin_late: false,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[
        Parameter { name: "cold_factor", spans: &[Span(3.5, 6.0)] },
        Parameter { name: "heating_s", spans: &[Span(25.0, 40.0)] },
    ],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.arms[wheel].cold_factor = v[0];
            truth.arms[wheel].heating_s = v[1];
        }
    },
};
