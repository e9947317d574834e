//! `command-jitter`: commands come late, each by its own time.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// A gateway that shares its processor.
pub(super) const CAUSE: Cause = Cause {
    name: "command-jitter",
    block: Block::Bus,
    is_known: true,
    signal: "bus",
    scopes: Scopes::Whole,
    may_begin_late: false,
    shown_by: Manoeuvre::Straight,
    parameters: &[Parameter { name: "latest_s", spans: &[Span(0.02, 0.06)] }],
    apply: |truth, _, v| truth.bus.late_s = v[0],
};
