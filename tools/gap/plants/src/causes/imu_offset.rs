//! `imu-offset`: the inertial unit is not level.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// A bent bracket.
pub(super) const CAUSE: Cause = Cause {
    name: "imu-offset",
    block: Block::Sensor,
    is_known: true,
    signal: "att",
    scopes: Scopes::Whole,
    may_begin_late: false,
    shown_by: Manoeuvre::Straight,
    parameters: &[
        Parameter { name: "roll_rad", spans: &[Span(-0.05, -0.015), Span(0.015, 0.05)] },
        Parameter { name: "pitch_rad", spans: &[Span(-0.05, -0.015), Span(0.015, 0.05)] },
    ],
    apply: |truth, _, v| truth.sensors.imu_tilt_rad = [v[0], v[1]],
};
