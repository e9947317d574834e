//! `engine-droop`: the engine gives way under load.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// A governor without integral action on an engine that has lost power.
pub(super) const CAUSE: Cause = Cause {
    name: "engine-droop",
    block: Block::Drive,
    is_known: true,
    signal: "wheel",
    scopes: Scopes::Whole,
    may_begin_late: false,
    shown_by: Manoeuvre::Straight,
    parameters: &[
        Parameter { name: "droop_per_20kw", spans: &[Span(0.2, 0.45)] },
        Parameter { name: "power_w", spans: &[Span(3000.0, 5000.0)] },
    ],
    apply: |truth, _, v| (truth.drive.droop, truth.drive.power_w) = (v[0], v[1]),
};
