//! `pressure-scale`: a bore pressure sensor reads a share too much or too little.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Of another range than the ECU thinks.
pub(super) const CAUSE: Cause = Cause {
    name: "pressure-scale",
    block: Block::Sensor,
    is_known: true,
    signal: "load",
    scopes: Scopes::Any,
    may_begin_late: false,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[Parameter { name: "factor", spans: &[Span(0.82, 0.91), Span(1.09, 1.18)] }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.sensors.pressure_scale[wheel] = v[0];
        }
    },
};
