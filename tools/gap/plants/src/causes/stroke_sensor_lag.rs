//! `stroke-sensor-lag`: a position sensor is slow.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Filtered in its own electronics; the loop about it overshoots. No catalogue has it.
pub(super) const CAUSE: Cause = Cause {
    name: "stroke-sensor-lag",
    block: Block::Sensor,
    is_known: false,
    signal: "stroke",
    scopes: Scopes::Any,
    may_begin_late: false,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[Parameter { name: "time_constant_s", spans: &[Span(0.25, 0.7)] }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.sensors.stroke_lag_s[wheel] = v[0];
        }
    },
};
