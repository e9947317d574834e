//! `stroke-bias`: a position sensor reads off by a length.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Mounted off its mark; the controller holds the wrong stroke.
pub(super) const CAUSE: Cause = Cause {
    name: "stroke-bias",
    block: Block::Sensor,
    is_known: true,
    signal: "load",
    scopes: Scopes::Part,
    may_begin_late: false,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[Parameter { name: "bias_m", spans: &[Span(-0.025, -0.008), Span(0.008, 0.025)] }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.sensors.stroke_bias_m[wheel] = v[0];
        }
    },
};
