//! `output-stuck`: an output stage freezes now and then.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// The ECU says one current and holds another. No catalogue has it.
pub(super) const CAUSE: Cause = Cause {
    name: "output-stuck",
    block: Block::Arms,
    is_known: false,
    signal: "stroke",
    scopes: Scopes::Any,
    may_begin_late: false,
    shown_by: Manoeuvre::Multisine,
    parameters: &[
        Parameter { name: "stuck_s", spans: &[Span(1.2, 2.2)] },
        Parameter { name: "every_s", spans: &[Span(3.0, 5.0)] },
    ],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.arms[wheel].stuck_s = v[0];
            truth.arms[wheel].stuck_every_s = v[1];
        }
    },
};
