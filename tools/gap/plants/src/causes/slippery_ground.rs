//! `slippery-ground`: wheels turn faster than the machine travels.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Slip at which wet soil has 63 % of its friction (assumed; Wong has a shear deformation of 25 to
/// 60 mm under a contact of some 0.4 m).
const SHEAR: f64 = 0.08;

/// The ground's top layer gives way, and holds less.
pub(super) const CAUSE: Cause = Cause {
    name: "slippery-ground",
    block: Block::Drive,
    is_known: true,
    signal: "position",
    scopes: Scopes::Any,
    may_begin_late: false,
    shown_by: Manoeuvre::Straight,
    parameters: &[
        Parameter { name: "friction", spans: &[Span(0.15, 0.4)] },
        Parameter { name: "slip", spans: &[Span(0.05, 0.2)] },
    ],
    apply: |truth, scope, v| {
        for wheel in scope.wheels() {
            truth.body.tyres[wheel].friction = v[0];
            truth.body.tyres[wheel].slip = v[1];
            truth.body.tyres[wheel].shear = SHEAR;
        }
    },
};
