//! `stroke-scale`: a position sensor reads a share too much or too little.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Calibrated over another length.
pub(super) const CAUSE: Cause = Cause {
    name: "stroke-scale",
    block: Block::Sensor,
    is_known: true,
    signal: "stroke",
    scopes: Scopes::Any,
    may_begin_late: false,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[Parameter { name: "factor", spans: &[Span(0.92, 0.96), Span(1.04, 1.08)] }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.sensors.stroke_scale[wheel] = v[0];
        }
    },
};
