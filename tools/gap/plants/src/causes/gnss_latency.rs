//! `gnss-latency`: fixes are older than they say.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// The receiver's own filter and a radio link.
pub(super) const CAUSE: Cause = Cause {
    name: "gnss-latency",
    block: Block::Sensor,
    is_known: true,
    signal: "position",
    scopes: Scopes::Whole,
    may_begin_late: false,
    shown_by: Manoeuvre::Straight,
    parameters: &[Parameter { name: "delay_s", spans: &[Span(0.15, 0.5)] }],
    apply: |truth, _, v| truth.sensors.gnss_latency_s = v[0],
};
