//! `pressure-bias`: a bore pressure sensor is off its zero.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Drifted bridge.
pub(super) const CAUSE: Cause = Cause {
    name: "pressure-bias",
    block: Block::Sensor,
    is_known: true,
    signal: "load",
    scopes: Scopes::Any,
    may_begin_late: true,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[Parameter {
        name: "bias_pa",
        spans: &[Span(-1.0e6, -4.0e5), Span(4.0e5, 1.0e6)],
    }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.sensors.pressure_bias_pa[wheel] = v[0];
        }
    },
};
