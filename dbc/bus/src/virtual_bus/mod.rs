//! A CAN bus in simulated time: bit-exact durations, arbitration, load; single-threaded and
//! deterministic.
//!
//! # What is modelled
//!
//! - A frame occupies the bus for its exact length in bits, stuff bits and intermission included
//!   ([`wire_bits`]); one bit lasts a whole number of nanoseconds ([`Bitrate`]).
//! - When the bus falls idle, the pending frame with the most dominant arbitration field wins
//!   ([`arbitration`]); a frame once begun is never interrupted.
//! - Every node has one transmit queue, first in first out. That is how a Linux interface or a
//!   controller in FIFO mode sends: a node's urgent frame waits behind its own less urgent ones
//!   (head-of-line blocking). A controller with priority mailboxes would reorder them; no node
//!   of this machine is known to.
//! - Receivers get a frame at the last bit of its end-of-frame. Senders do not hear themselves.
//!
//! # What is not
//!
//! Bit errors, acknowledgement and error counters: every node stays error active, and a frame
//! needs no second node. Two nodes that arbitrate with the same identifier would collide in the
//! data field; here both frames pass, in order of attachment, and the [`Collision`] is reported.

pub mod arbitration;
mod bus;
mod load;
mod node;
mod port;
pub mod wire_bits;

use core::fmt;
use core::time::Duration;

pub use bus::{Collision, Sent, VirtualBus};
pub use node::{NodeCounters, NodeId, QUEUE_FRAMES};
pub use port::Port;

/// A bit rate at which a bit lasts a whole number of nanoseconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bitrate {
    bit_ns: u32,
}

impl Bitrate {
    /// 1 Mbit/s, the rate of CAN_1.
    pub const MBIT_1: Self = Self { bit_ns: 1_000 };
    /// 500 kbit/s.
    pub const KBIT_500: Self = Self { bit_ns: 2_000 };
    /// 250 kbit/s, the rate of J1939.
    pub const KBIT_250: Self = Self { bit_ns: 4_000 };

    /// A rate in bit/s.
    ///
    /// # Errors
    /// Outside 5 kbit/s to 1 Mbit/s (what classic CAN controllers offer), or a bit would not
    /// last whole nanoseconds.
    pub const fn new(bits_per_s: u32) -> Result<Self, BitrateError> {
        if bits_per_s < 5_000 || bits_per_s > 1_000_000 || 1_000_000_000 % bits_per_s != 0 {
            return Err(BitrateError { bits_per_s });
        }
        Ok(Self { bit_ns: 1_000_000_000 / bits_per_s })
    }

    /// The rate in bit/s.
    #[must_use]
    pub const fn bits_per_s(self) -> u32 {
        1_000_000_000 / self.bit_ns
    }

    /// How long `bits` last.
    #[must_use]
    pub const fn duration(self, bits: u32) -> Duration {
        Duration::from_nanos(self.nanos(bits))
    }

    /// How many nanoseconds `bits` last.
    const fn nanos(self, bits: u32) -> u64 {
        bits as u64 * self.bit_ns as u64
    }
}

impl Default for Bitrate {
    fn default() -> Self {
        Self::MBIT_1
    }
}

impl fmt::Display for Bitrate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} bit/s", self.bits_per_s())
    }
}

/// A bit rate the virtual bus does not run at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "bit rate {bits_per_s} bit/s: must be 5000 to 1000000 and divide 1000000000, e.g. 1000000, \
     500000, 250000 or 125000"
)]
pub struct BitrateError {
    /// The rate asked for, in bit/s.
    pub bits_per_s: u32,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn named_rates_are_what_they_say() {
        assert_eq!(Bitrate::MBIT_1, Bitrate::new(1_000_000).unwrap());
        assert_eq!(Bitrate::KBIT_500.bits_per_s(), 500_000);
        assert_eq!(Bitrate::new(5_000).unwrap().duration(1), Duration::from_micros(200));
        assert_eq!(Bitrate::KBIT_250.duration(3), Duration::from_micros(12));
    }

    #[test]
    fn a_rate_that_would_round_is_refused() {
        for bits_per_s in [0, 4_999, 33_333, 83_333, 999_999, 1_000_001, 2_000_000] {
            assert_eq!(Bitrate::new(bits_per_s), Err(BitrateError { bits_per_s }));
        }
    }
}
