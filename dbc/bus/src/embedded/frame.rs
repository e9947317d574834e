//! Frames and identifiers, there and back.

use embedded_can::{ExtendedId, Id, StandardId};
use xt28_dbc::{CanId, Frame};

/// The identifier as ours.
#[must_use]
pub fn from_embedded_id(id: Id) -> CanId {
    match id {
        Id::Standard(id) => CanId::Standard(id.as_raw()),
        Id::Extended(id) => CanId::Extended(id.as_raw()),
    }
}

/// The identifier as theirs, `None` where it has more bits than its format.
#[must_use]
pub fn to_embedded_id(id: CanId) -> Option<Id> {
    match id {
        CanId::Standard(raw) => StandardId::new(raw).map(Id::Standard),
        CanId::Extended(raw) => ExtendedId::new(raw).map(Id::Extended),
    }
}

/// A frame as `embedded-can` knows it: ours, or a remote frame, which our buses do not carry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CanFrame {
    /// A data frame.
    Data(Frame),
    /// A request for data.
    Remote {
        /// Its identifier.
        id: Id,
        /// Bytes asked for, 0 to 8.
        dlc: u8,
    },
}

impl embedded_can::Frame for CanFrame {
    fn new(id: impl Into<Id>, data: &[u8]) -> Option<Self> {
        Frame::new(from_embedded_id(id.into()), data).map(Self::Data)
    }

    fn new_remote(id: impl Into<Id>, dlc: usize) -> Option<Self> {
        let dlc = u8::try_from(dlc).ok().filter(|dlc| *dlc <= 8)?;
        Some(Self::Remote { id: id.into(), dlc })
    }

    fn is_extended(&self) -> bool {
        matches!(self.id(), Id::Extended(_))
    }

    fn is_remote_frame(&self) -> bool {
        matches!(self, Self::Remote { .. })
    }

    fn id(&self) -> Id {
        match self {
            // An identifier beyond its format reaches no bus; here it shows as the largest there is.
            Self::Data(frame) => to_embedded_id(frame.id()).unwrap_or(match frame.id() {
                CanId::Standard(_) => Id::Standard(StandardId::MAX),
                CanId::Extended(_) => Id::Extended(ExtendedId::MAX),
            }),
            Self::Remote { id, .. } => *id,
        }
    }

    fn dlc(&self) -> usize {
        match self {
            Self::Data(frame) => frame.data().len(),
            Self::Remote { dlc, .. } => usize::from(*dlc),
        }
    }

    fn data(&self) -> &[u8] {
        match self {
            Self::Data(frame) => frame.data(),
            Self::Remote { .. } => &[],
        }
    }
}

#[cfg(test)]
mod tests {
    use embedded_can::Frame as _;

    use super::*;

    #[test]
    fn keeps_the_format_of_an_identifier() {
        for id in [CanId::Standard(0x123), CanId::Extended(0x123), CanId::Extended(0x1FFF_FFFF)] {
            assert_eq!(from_embedded_id(to_embedded_id(id).unwrap()), id);
        }
        assert_eq!(to_embedded_id(CanId::Standard(0x800)), None);
        assert_eq!(to_embedded_id(CanId::Extended(0x2000_0000)), None);
    }

    #[test]
    fn remote_frames_have_a_length_and_no_data() {
        let remote = CanFrame::new_remote(StandardId::new(0x123).unwrap(), 8).unwrap();
        assert!(remote.is_remote_frame() && !remote.is_extended());
        assert_eq!((remote.dlc(), remote.data()), (8, &[][..]));
        assert_eq!(CanFrame::new_remote(StandardId::ZERO, 9), None);
    }
}
