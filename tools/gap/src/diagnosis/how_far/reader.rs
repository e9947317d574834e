//! Samples of what our own ECUs say on the bus.

use std::path::Path;

use xt28_dbc::{CanId, Frame, XT28_DBC};
use xt28_ecus::pins;
use xt28_machine::Wheel;

use super::machine_sample::{MachineSample, Quantity, WIDTH};
use crate::{Channel, Decoder, GapError, Mapping, SteerSide};

/// Keeps the newest frame of each kind, and reads them when a sample is due: most are never read.
#[derive(Clone, Debug)]
pub(super) struct Reader {
    newest: Vec<(CanId, Option<Frame>)>,
}

impl Reader {
    /// The decoder for our own bus.
    pub(super) fn decoder() -> Result<Decoder, GapError> {
        Decoder::parse(XT28_DBC, Path::new("xt28.dbc"), &Mapping::default())
    }

    pub(super) const fn new() -> Self {
        Self { newest: Vec::new() }
    }

    pub(super) fn hear(&mut self, decoder: &Decoder, frames: &[Frame]) {
        for frame in frames {
            let id = frame.id();
            if let Some((_, newest)) = self.newest.iter_mut().find(|(known, _)| *known == id) {
                // What carries no channel is known and never kept.
                if newest.is_some() {
                    *newest = Some(*frame);
                }
            } else {
                let wanted = decoder.tap(id).is_some_and(|tap| tap.channels().any(is_wanted));
                self.newest.push((id, wanted.then_some(*frame)));
            }
        }
    }

    /// What the ECUs said last; no position.
    pub(super) fn sample(&self, decoder: &Decoder) -> MachineSample {
        let mut sample = [f64::NAN; WIDTH];
        let (mut arm_ma, mut steer_ma) = ([[f64::NAN; 6]; 2], [f64::NAN; 4]);
        for frame in self.newest.iter().filter_map(|(_, frame)| frame.as_ref()) {
            let Some(tap) = decoder.tap(frame.id()) else { continue };
            for (channel, value) in tap.values(frame) {
                let Ok(value) = value else { continue };
                match channel {
                    Channel::RetractCurrent(w) => arm_ma[0][w.index()] = value * 1e3,
                    Channel::ExtendCurrent(w) => arm_ma[1][w.index()] = value * 1e3,
                    Channel::SteerCurrent(side) => steer_ma[side as usize] = value * 1e3,
                    channel => {
                        if let Some(column) = Quantity::of(channel) {
                            sample[column] = value;
                        }
                    }
                }
            }
        }
        for k in 0..Wheel::ALL.len() {
            sample[Quantity::Opening.columns().start + k] =
                pins::valve_opening(arm_ma[0][k], arm_ma[1][k]);
        }
        let [front_a, front_b, rear_a, rear_b] = SteerSide::ALL.map(|side| steer_ma[side as usize]);
        let steer = [pins::steer_opening(front_a, front_b), pins::steer_opening(rear_a, rear_b)];
        sample[Quantity::SteerOpening.columns()].copy_from_slice(&steer);
        sample
    }
}

const fn is_wanted(channel: Channel) -> bool {
    Quantity::of(channel).is_some()
        || matches!(
            channel,
            Channel::RetractCurrent(_) | Channel::ExtendCurrent(_) | Channel::SteerCurrent(_)
        )
}
