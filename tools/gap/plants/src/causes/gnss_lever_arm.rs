//! `gnss-lever-arm`: the antenna is not where it was measured.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Moved on the roof.
pub(super) const CAUSE: Cause = Cause {
    name: "gnss-lever-arm",
    block: Block::Sensor,
    is_known: true,
    signal: "position",
    scopes: Scopes::Whole,
    may_begin_late: false,
    shown_by: Manoeuvre::STurn,
    parameters: &[
        Parameter { name: "x_m", spans: &[Span(-1.0, -0.4), Span(0.4, 1.0)] },
        Parameter { name: "y_m", spans: &[Span(-0.8, -0.3), Span(0.3, 0.8)] },
    ],
    apply: |truth, _, v| truth.sensors.antenna_shift_m = [v[0], v[1]],
};
