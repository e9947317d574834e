//! `seal-stiction`: the rod sticks in its seals.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Friction beside the oil: the pressures no longer show what the wheel carries.
pub(super) const CAUSE: Cause = Cause {
    name: "seal-stiction",
    block: Block::Arms,
    is_known: true,
    signal: "load",
    scopes: Scopes::Any,
    may_begin_late: false,
    shown_by: Manoeuvre::Multisine,
    parameters: &[
        Parameter { name: "coulomb_n", spans: &[Span(4000.0, 10_000.0)] },
        Parameter { name: "breakaway_n", spans: &[Span(2000.0, 5000.0)] },
    ],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.arms[wheel].seal.coulomb_n = v[0];
            truth.arms[wheel].seal.breakaway_n = v[1];
        }
    },
};
