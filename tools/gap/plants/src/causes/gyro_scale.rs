//! `gyro-scale`: the gyros read another scale.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// The filter believes turns that were not, for seconds. No catalogue has it.
pub(super) const CAUSE: Cause = Cause {
    name: "gyro-scale",
    block: Block::Sensor,
    is_known: false,
    signal: "att",
    scopes: Scopes::Whole,
    may_begin_late: false,
    shown_by: Manoeuvre::Multisine,
    parameters: &[Parameter { name: "factor", spans: &[Span(0.1, 0.4), Span(1.8, 2.5)] }],
    apply: |truth, _, v| truth.sensors.gyro_scale = v[0],
};
