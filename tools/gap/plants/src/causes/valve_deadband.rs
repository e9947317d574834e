//! `valve-deadband`: the lands cover the ports for longer than the ECU thinks.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Overlap of the spool beyond its starting current.
pub(super) const CAUSE: Cause = Cause {
    name: "valve-deadband",
    block: Block::Arms,
    is_known: true,
    signal: "stroke",
    scopes: Scopes::Any,
    may_begin_late: true,
    shown_by: Manoeuvre::Multisine,
    parameters: &[Parameter { name: "deadband", spans: &[Span(0.02, 0.06)] }],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.arms[wheel].spool.overlap += v[0];
        }
    },
};
