//! One `can_msgs` frame: a header with a time stamp, then identifier, three flags, length, eight bytes.

use xt28_dbc::{CanId, Frame};
use xt28_machine::SimTime;

/// How a message is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    /// ROS 2: OMG CDR with its header of four bytes, numbers at multiples of their size.
    Cdr,
    /// ROS 1: a sequence number first, little-endian, nothing aligned.
    Packed,
}

/// What a message is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Seen {
    /// A data frame with its instant: its stamp, or where that is zero, when it was recorded.
    Data(SimTime, Frame),
    /// A remote frame.
    Remote,
    /// An error frame.
    Error,
}

/// The frame in `bytes`, recorded at `recorded_ns`; else what is wrong with it.
pub(super) fn decode(bytes: &[u8], encoding: Encoding, recorded_ns: u64) -> Result<Seen, String> {
    let mut from = Cursor::new(bytes, encoding)?;
    if encoding == Encoding::Packed {
        from.word()?;
    }
    let (seconds, nanos) = (from.word()?, from.word()?);
    let name_bytes = from.word()? as usize;
    from.take(name_bytes)?;
    let id = from.word()?;
    let [remote, extended, error, len] = *from.take(4)? else { return Err(SHORT.to_owned()) };
    if error != 0 {
        return Ok(Seen::Error);
    }
    if remote != 0 {
        return Ok(Seen::Remote);
    }
    let data = from.take(8)?;
    let data = data.get(..usize::from(len)).ok_or_else(|| format!("{len} data bytes, of 8"))?;
    let id = if extended == 0 {
        u16::try_from(id).ok().and_then(CanId::standard)
    } else {
        CanId::extended(id)
    }
    .ok_or_else(|| format!("identifier {id:X} is too large"))?;
    let frame = Frame::new(id, data).ok_or_else(|| format!("{len} data bytes, of 8"))?;
    let stamp_ns = u64::from(seconds) * 1_000_000_000 + u64::from(nanos);
    let at_ns = if stamp_ns == 0 { recorded_ns } else { stamp_ns };
    Ok(Seen::Data(SimTime::from_nanos(at_ns), frame))
}

const SHORT: &str = "message is too short for a frame";

/// Reads numbers off bytes, never past their end.
struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    aligned: bool,
    big: bool,
}

impl<'a> Cursor<'a> {
    fn new(bytes: &'a [u8], encoding: Encoding) -> Result<Self, String> {
        if encoding == Encoding::Packed {
            return Ok(Self { bytes, at: 0, aligned: false, big: false });
        }
        let (head, bytes) = bytes.split_first_chunk::<4>().ok_or_else(|| SHORT.to_owned())?;
        match head[..2] {
            [0, endian @ (0 | 1)] => Ok(Self { bytes, at: 0, aligned: true, big: endian == 0 }),
            [a, b] => Err(format!("CDR representation {a:02X}{b:02X} is not known, 0001 is")),
            _ => Err(SHORT.to_owned()),
        }
    }

    fn take(&mut self, n: usize) -> Result<&'a [u8], String> {
        let end = self.at.checked_add(n).filter(|end| *end <= self.bytes.len());
        let end = end.ok_or_else(|| SHORT.to_owned())?;
        let taken = &self.bytes[self.at..end];
        self.at = end;
        Ok(taken)
    }

    fn word(&mut self) -> Result<u32, String> {
        if self.aligned {
            self.at = self.at.next_multiple_of(4);
        }
        let bytes = self.take(4)?.try_into().map_err(|_| SHORT.to_owned())?;
        Ok(if self.big { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) })
    }
}
