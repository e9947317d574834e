//! `speed-asymmetry`: an arm goes out slower than in.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Notches cut alike for both chambers, which the piston sees as different areas.
pub(super) const CAUSE: Cause = Cause {
    name: "speed-asymmetry",
    block: Block::Arms,
    is_known: true,
    signal: "stroke",
    scopes: Scopes::Any,
    may_begin_late: true,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[
        Parameter { name: "extension_factor", spans: &[Span(0.6, 0.8)] },
        Parameter { name: "contraction_factor", spans: &[Span(1.2, 1.45)] },
    ],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.arms[wheel].notches = [v[0], v[1]];
        }
    },
};
