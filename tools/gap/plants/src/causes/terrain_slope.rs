//! `terrain-slope`: the yard is not level.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// The whole ground leans.
pub(super) const CAUSE: Cause = Cause {
    name: "terrain-slope",
    block: Block::Ground,
    is_known: true,
    signal: "att",
    scopes: Scopes::Whole,
    may_begin_late: false,
    shown_by: Manoeuvre::Straight,
    parameters: &[
        Parameter { name: "grade_x_rad", spans: &[Span(-0.05, -0.02), Span(0.02, 0.05)] },
        Parameter { name: "grade_y_rad", spans: &[Span(-0.04, -0.01), Span(0.01, 0.04)] },
    ],
    apply: |truth, _, v| truth.body.slope_rad = [v[0], v[1]],
};
