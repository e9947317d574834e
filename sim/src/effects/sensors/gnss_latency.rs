//! `gnss-latency`: a fix comes later than its time says.

use crate::effects::{Block, Effect, Parameter, Slot};

/// The age of a fix when it is sent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GnssLatency {
    /// Beyond the nominal machine's, s.
    pub delay_s: f64,
}

/// Solving and sending take time: the machine has gone on meanwhile.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "gnss-latency",
    block: Block::Sensor,
    meaning: "a fix shows where the antenna was some time ago",
    source: "assumed: receivers with corrections take 20 to 150 ms and are told of by their makers",
    parameters: &[Parameter {
        name: "delay_s",
        neutral: 0.0,
        tolerance: 0.02,
        range: [0.0, 2.0],
        acts_alone: true,
        slot: Slot::Whole(|effects| &mut effects.sensors.gnss_latency.delay_s),
    }],
};
