//! The four kinds of frame payload (ISO 15765-2, 9.4), read and written.

use core::time::Duration;

use super::{FrameData, PADDING};

/// Bytes of a message in a single, first and consecutive frame.
pub(super) const SINGLE_MAX: usize = 7;
pub(super) const IN_FIRST: usize = 6;
pub(super) const IN_CONSECUTIVE: usize = 7;

/// What a flow control says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FlowStatus {
    /// Go on.
    Continue,
    /// Wait for the next flow control.
    Wait,
    /// The message is too long.
    Overflow,
    /// Not one of the three.
    Invalid,
}

/// One frame's payload.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pdu<'a> {
    /// A whole message.
    Single(&'a [u8]),
    /// The beginning of a message of `length` bytes.
    First { length: u32, data: &'a [u8; IN_FIRST] },
    /// The next part; `sequence` counts modulo 16.
    Consecutive { sequence: u8, data: &'a [u8] },
    /// The receiver's word to the sender.
    FlowControl { status: FlowStatus, block_size: u8, separation: Duration },
}

impl<'a> Pdu<'a> {
    /// `None` for a payload that the standard tells a receiver to ignore.
    pub(super) fn parse(data: &'a [u8]) -> Option<Self> {
        let (&head, rest) = data.split_first()?;
        let low = head & 0x0F;
        match head >> 4 {
            0 => {
                let length = usize::from(low);
                (1..=SINGLE_MAX)
                    .contains(&length)
                    .then(|| rest.get(..length))
                    .flatten()
                    .map(Pdu::Single)
            }
            1 => Self::first(low, rest),
            2 if !rest.is_empty() => Some(Self::Consecutive { sequence: low, data: rest }),
            3 => {
                let &[block_size, separation, ..] = rest else { return None };
                let status = match low {
                    0 => FlowStatus::Continue,
                    1 => FlowStatus::Wait,
                    2 => FlowStatus::Overflow,
                    _ => FlowStatus::Invalid,
                };
                let separation = separation_of(separation);
                Some(Self::FlowControl { status, block_size, separation })
            }
            _ => None,
        }
    }

    /// A first frame is always full; its length is above what a single frame holds.
    fn first(low: u8, rest: &'a [u8]) -> Option<Self> {
        let (&length, data) = rest.split_first()?;
        let data: &[u8; IN_FIRST] = data.first_chunk()?;
        let length = u32::from(low) << 8 | u32::from(length);
        if length == 0 {
            // The escape to 32 bits: no such length fits a message of ours, which is all that
            // matters of it.
            let length = u32::from_be_bytes(*data.first_chunk()?);
            return (length > 4095).then_some(Self::First { length, data });
        }
        (length > 7).then_some(Self::First { length, data })
    }
}

/// A payload padded to the frame.
pub(super) fn padded(bytes: &[u8]) -> FrameData {
    let mut frame = [PADDING; 8];
    let length = bytes.len().min(8);
    frame[..length].copy_from_slice(&bytes[..length]);
    frame
}

/// A flow control.
pub(super) fn flow_control(status: FlowStatus, block_size: u8, separation: Duration) -> FrameData {
    let status = match status {
        FlowStatus::Continue => 0x30,
        FlowStatus::Wait => 0x31,
        FlowStatus::Overflow | FlowStatus::Invalid => 0x32,
    };
    padded(&[status, block_size, separation_code(separation)])
}

/// `STmin` (9.6.5.4): ms up to 127, then hundreds of us; what is reserved counts as the longest.
fn separation_of(code: u8) -> Duration {
    match code {
        0..=0x7F => Duration::from_millis(u64::from(code)),
        0xF1..=0xF9 => Duration::from_micros(100 * u64::from(code - 0xF0)),
        _ => Duration::from_millis(127),
    }
}

/// The shortest code that is no shorter than `separation`.
#[allow(clippy::cast_possible_truncation)] // bounded before each cast
fn separation_code(separation: Duration) -> u8 {
    let us = separation.as_micros();
    match us {
        0 => 0,
        1..=900 => 0xF0 + us.div_ceil(100) as u8,
        _ => us.div_ceil(1000).min(127) as u8,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn separation_times_go_both_ways_and_reserved_ones_are_long() {
        for code in (0..=0x7F).chain(0xF1..=0xF9) {
            assert_eq!(separation_code(separation_of(code)), code);
        }
        for code in [0x80, 0xF0, 0xFA, 0xFF] {
            assert_eq!(separation_of(code), Duration::from_millis(127));
        }
        assert_eq!(separation_code(Duration::from_micros(950)), 1);
    }

    #[test]
    fn what_the_standard_says_to_ignore_is_ignored() {
        let ignored: [&[u8]; 9] = [
            &[],
            &[0x00, 1],
            &[0x08, 1, 2, 3, 4, 5, 6, 7],
            &[0x03, 1, 2],
            &[0x10, 7, 1, 2, 3, 4, 5, 6],
            &[0x10, 20, 1, 2, 3],
            &[0x20],
            &[0x30, 0],
            &[0x40, 0, 0],
        ];
        for data in ignored {
            assert_eq!(Pdu::parse(data), None, "{data:02X?}");
        }
        let escaped = Pdu::parse(&[0x10, 0, 0, 0, 0x20, 0, 1, 2]);
        assert!(matches!(escaped, Some(Pdu::First { length: 8192, .. })));
    }
}
