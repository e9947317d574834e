//! `throttle-delay`: the pumps get the throttle late.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// From the ECU's demand to the swash plates.
pub(super) const CAUSE: Cause = Cause {
    name: "throttle-delay",
    block: Block::Drive,
    is_known: true,
    signal: "wheel",
    scopes: Scopes::Whole,
    may_begin_late: true,
    shown_by: Manoeuvre::Straight,
    parameters: &[Parameter { name: "delay_s", spans: &[Span(0.15, 0.45)] }],
    apply: |truth, _, v| truth.drive.delay_s = v[0],
};
