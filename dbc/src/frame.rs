//! Frames and identifiers: classic CAN, 11 or 29 bits, up to eight bytes.

use core::fmt;

/// A CAN identifier, 11 or 29 bits.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CanId {
    /// 11 bits.
    Standard(u16),
    /// 29 bits.
    Extended(u32),
}

impl CanId {
    /// An 11-bit identifier, `None` above 0x7FF.
    #[must_use]
    pub const fn standard(raw: u16) -> Option<Self> {
        if raw <= 0x7FF { Some(Self::Standard(raw)) } else { None }
    }

    /// A 29-bit identifier, `None` above 0x1FFF_FFFF.
    #[must_use]
    pub const fn extended(raw: u32) -> Option<Self> {
        if raw <= 0x1FFF_FFFF { Some(Self::Extended(raw)) } else { None }
    }

    /// The identifier's bits, without the extended flag.
    #[must_use]
    pub const fn raw(self) -> u32 {
        match self {
            Self::Standard(raw) => raw as u32,
            Self::Extended(raw) => raw,
        }
    }

    /// The identifier as a DBC file writes it: bit 31 marks 29 bits.
    #[must_use]
    pub const fn dbc(self) -> u32 {
        match self {
            Self::Standard(raw) => raw as u32,
            Self::Extended(raw) => raw | 0x8000_0000,
        }
    }

    /// True for 29 bits.
    #[must_use]
    pub const fn is_extended(self) -> bool {
        matches!(self, Self::Extended(_))
    }
}

impl fmt::Display for CanId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Standard(raw) => write!(f, "{raw:03X}"),
            Self::Extended(raw) => write!(f, "{raw:08X}"),
        }
    }
}

impl fmt::Debug for CanId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// A classic CAN data frame. Unused bytes are zero, so equal frames compare equal.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Frame {
    id: CanId,
    len: u8,
    bytes: [u8; 8],
}

impl Frame {
    /// A data frame, `None` for more than eight bytes.
    #[must_use]
    pub fn new(id: CanId, data: &[u8]) -> Option<Self> {
        let mut bytes = [0; 8];
        bytes.get_mut(..data.len())?.copy_from_slice(data);
        #[allow(clippy::cast_possible_truncation)] // at most 8
        Some(Self { id, len: data.len() as u8, bytes })
    }

    /// Its identifier.
    #[must_use]
    pub const fn id(&self) -> CanId {
        self.id
    }

    /// Its data, as many bytes as its DLC says.
    #[must_use]
    pub fn data(&self) -> &[u8] {
        &self.bytes[..usize::from(self.len)]
    }

    /// Its data, to change in place.
    #[must_use]
    pub fn data_mut(&mut self) -> &mut [u8] {
        &mut self.bytes[..usize::from(self.len)]
    }
}

impl fmt::Debug for Frame {
    /// As candump writes it: `0CFF4027#5555555555551299`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}#", self.id)?;
        self.data().iter().try_for_each(|byte| write!(f, "{byte:02X}"))
    }
}

/// Frames a node wants sent, in order. Keeps its memory when cleared, so a tick allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct Outbox {
    frames: Vec<Frame>,
}

impl Outbox {
    /// Room for `frames` frames without allocating.
    #[must_use]
    pub fn with_capacity(frames: usize) -> Self {
        Self { frames: Vec::with_capacity(frames) }
    }

    /// Adds a frame behind the others.
    pub fn push(&mut self, frame: Frame) {
        self.frames.push(frame);
    }

    /// The frames, oldest first.
    #[must_use]
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// Empties it.
    pub fn clear(&mut self) {
        self.frames.clear();
    }
}
