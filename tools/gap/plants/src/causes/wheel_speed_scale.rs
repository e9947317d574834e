//! `wheel-speed-scale`: a wheel's speed reads too high or too low.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// A pulse ring with another number of teeth, or a worn tyre.
pub(super) const CAUSE: Cause = Cause {
    name: "wheel-speed-scale",
    block: Block::Sensor,
    is_known: true,
    signal: "wheel",
    scopes: Scopes::Any,
    may_begin_late: false,
    shown_by: Manoeuvre::Straight,
    parameters: &[Parameter { name: "factor", spans: &[Span(0.9, 0.96), Span(1.04, 1.1)] }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.sensors.wheel_speed_scale[wheel] = v[0];
        }
    },
};
