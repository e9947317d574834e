//! `valve-hysteresis`: dry friction holds the spool.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Half the width is what friction holds the spool off, either way.
pub(super) const CAUSE: Cause = Cause {
    name: "valve-hysteresis",
    block: Block::Arms,
    is_known: true,
    signal: "stroke",
    scopes: Scopes::Any,
    may_begin_late: true,
    shown_by: Manoeuvre::Multisine,
    parameters: &[Parameter { name: "width", spans: &[Span(0.04, 0.09)] }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.arms[wheel].spool.friction = 0.5 * v[0];
        }
    },
};
