//! What generated messages share: errors, and numbers put into and taken out of frames.

use xt28_dbc_model::{Field, ValueError};

use crate::{CanId, Frame};

/// Why a message cannot be said.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{signal}: {source}")]
pub struct EncodeError {
    /// Message and signal.
    pub signal: &'static str,
    /// What is wrong with the number.
    pub source: ValueError,
}

/// Why a frame is not believed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum DecodeError {
    /// The frame has another identifier.
    #[error("{message}: frame {got} is another message")]
    Id {
        /// The message asked for.
        message: &'static str,
        /// The frame's identifier.
        got: CanId,
    },
    /// The frame has another length.
    #[error("{message}: {got} bytes instead of {want}")]
    Length {
        /// The message.
        message: &'static str,
        /// Its length.
        want: u8,
        /// The frame's.
        got: usize,
    },
    /// The CRC is not that of the data.
    #[error("{message}: crc {got:02X} instead of {want:02X}")]
    Crc {
        /// The message.
        message: &'static str,
        /// The CRC of the data.
        want: u8,
        /// The CRC in the frame.
        got: u8,
    },
    /// A number is outside its range.
    #[error("{signal}: {source}")]
    Range {
        /// Message and signal.
        signal: &'static str,
        /// What is wrong with it.
        source: ValueError,
    },
    /// A value the database has no name for.
    #[error("{signal}: {raw} has no meaning")]
    Value {
        /// Message and signal.
        signal: &'static str,
        /// The raw value.
        raw: u64,
    },
}

pub(crate) fn put(
    data: &mut [u8],
    field: &Field,
    value: f64,
    signal: &'static str,
) -> Result<(), EncodeError> {
    field.write(data, value).map_err(|source| EncodeError { signal, source })
}

pub(crate) fn get(data: &[u8], field: &Field, signal: &'static str) -> Result<f64, DecodeError> {
    field.read(data).map_err(|source| DecodeError::Range { signal, source })
}

/// The frame's data, if it is this message.
pub(crate) fn expect<'a>(
    frame: &'a Frame,
    id: CanId,
    want: u8,
    message: &'static str,
) -> Result<&'a [u8], DecodeError> {
    if frame.id() != id {
        return Err(DecodeError::Id { message, got: frame.id() });
    }
    if frame.data().len() != usize::from(want) {
        return Err(DecodeError::Length { message, want, got: frame.data().len() });
    }
    Ok(frame.data())
}
