//! `valve-cross-talk`: an arm follows the command of the one beside it.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// A shared pilot gallery with a worn plug. No catalogue has it.
pub(super) const CAUSE: Cause = Cause {
    name: "valve-cross-talk",
    block: Block::Arms,
    is_known: false,
    signal: "stroke",
    scopes: Scopes::Any,
    may_begin_late: false,
    shown_by: Manoeuvre::SingleArm,
    parameters: &[Parameter { name: "share", spans: &[Span(0.25, 0.5)] }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.arms[wheel].cross_talk = v[0];
        }
    },
};
