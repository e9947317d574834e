//! `payload`: logs in a bunk that was declared empty.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;
use crate::truth::Logs;

/// Three bundles along the bunk.
pub(super) const CAUSE: Cause = Cause {
    name: "payload",
    block: Block::Payload,
    is_known: true,
    signal: "load",
    scopes: Scopes::Whole,
    may_begin_late: false,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[
        Parameter { name: "mass_kg", spans: &[Span(2000.0, 9000.0)] },
        Parameter { name: "lateral_m", spans: &[Span(-0.2, 0.2)] },
        Parameter { name: "ahead_m", spans: &[Span(-0.3, 0.3)] },
    ],
    apply: |truth, _, v| truth.body.logs = Logs { mass_kg: v[0], lateral_m: v[1], ahead_m: v[2] },
};
