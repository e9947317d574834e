//! `pump-hunting`: the pump's regulator hunts.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// All flows swing together. No catalogue has it.
pub(super) const CAUSE: Cause = Cause {
    name: "pump-hunting",
    block: Block::Arms,
    is_known: false,
    signal: "stroke",
    scopes: Scopes::Whole,
    may_begin_late: false,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[
        Parameter { name: "share", spans: &[Span(0.55, 0.85)] },
        Parameter { name: "rate_rad_s", spans: &[Span(2.5, 8.0)] },
    ],
    apply: |truth, _, v| (truth.supply.hunting, truth.supply.hunting_rad_s) = (v[0], v[1]),
};
