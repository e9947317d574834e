//! `frame-loss`: frames get lost.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// A worn connector: each by itself, on its way to the ECUs and to the log.
pub(super) const CAUSE: Cause = Cause {
    name: "frame-loss",
    block: Block::Bus,
    is_known: true,
    signal: "bus",
    scopes: Scopes::Whole,
    may_begin_late: false,
    shown_by: Manoeuvre::Straight,
    parameters: &[Parameter { name: "share", spans: &[Span(0.03, 0.12)] }],
    apply: |truth, _, v| truth.bus.loss = v[0],
};
