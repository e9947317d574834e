//! `pump-flow-limit`: the pump of arms and steering runs short.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Its regulator stops short of full stroke; the margin over all valves then falls together.
pub(super) const CAUSE: Cause = Cause {
    name: "pump-flow-limit",
    block: Block::Arms,
    is_known: true,
    signal: "stroke",
    scopes: Scopes::Whole,
    may_begin_late: true,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[Parameter { name: "flow_m3_s", spans: &[Span(5.0e-4, 0.0012)] }],
    apply: |truth, _, v| truth.supply.flow_m3_s = v[0],
};
