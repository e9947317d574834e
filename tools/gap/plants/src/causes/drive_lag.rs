//! `drive-lag`: the swash plates move slowly.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// A servo short of control oil.
pub(super) const CAUSE: Cause = Cause {
    name: "drive-lag",
    block: Block::Drive,
    is_known: true,
    signal: "wheel",
    scopes: Scopes::Whole,
    may_begin_late: true,
    shown_by: Manoeuvre::Straight,
    parameters: &[Parameter { name: "time_constant_s", spans: &[Span(0.25, 0.8)] }],
    apply: |truth, _, v| truth.drive.swash_s = v[0],
};
