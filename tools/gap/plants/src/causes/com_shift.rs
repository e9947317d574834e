//! `com-shift`: the front frame's centre of mass is elsewhere.

use crate::causes::{Block, Cause, Parameter, Scopes, Span};
use crate::manoeuvre::Manoeuvre;

/// Counterweights or a crane that nobody wrote down.
pub(super) const CAUSE: Cause = Cause {
    name: "com-shift",
    block: Block::Payload,
    is_known: true,
    signal: "load",
    scopes: Scopes::Whole,
    may_begin_late: false,
    shown_by: Manoeuvre::ArmStep,
    parameters: &[
        Parameter { name: "x_m", spans: &[Span(-0.45, -0.2), Span(0.2, 0.45)] },
        Parameter { name: "y_m", spans: &[Span(-0.25, -0.1), Span(0.1, 0.25)] },
        Parameter { name: "z_m", spans: &[Span(-0.3, 0.3)] },
    ],
    apply: |truth, _, v| {
        for (shift_m, by_m) in truth.body.com_shift_m.iter_mut().zip(v) {
            *shift_m += by_m;
        }
    },
};
