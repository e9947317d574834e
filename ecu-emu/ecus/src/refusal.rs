//! Why a command was refused, as the status frames say it.

use xt28_dbc::DecodeError;
use xt28_dbc::messages::{ArmStatusReason, DriveStatusReason};

/// Why the last refused command was refused.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Refusal {
    /// Nothing was refused yet.
    #[default]
    None,
    /// The frame was damaged: checksum or length.
    Crc,
    /// The frame came again, or too many before it were lost.
    Counter,
    /// A value is outside what the machine has.
    Range,
    /// The mode does not exist here.
    Mode,
    /// The sender wants to drive without saying so (`Enable`).
    NotEnabled,
    /// No good frame for three periods.
    Deadline,
    /// An input that the control needs is broken.
    SensorFault,
    /// After a safe stop the sender must ask for rest first.
    Rearm,
}

macro_rules! on_the_wire {
    ($($reason:ident),*) => {
        $(impl From<Refusal> for $reason {
            fn from(refusal: Refusal) -> Self {
                match refusal {
                    Refusal::None => Self::None,
                    Refusal::Crc => Self::Crc,
                    Refusal::Counter => Self::Counter,
                    Refusal::Range => Self::Range,
                    Refusal::Mode => Self::Mode,
                    Refusal::NotEnabled => Self::NotEnabled,
                    Refusal::Deadline => Self::Deadline,
                    Refusal::SensorFault => Self::SensorFault,
                    Refusal::Rearm => Self::Rearm,
                }
            }
        })*
    };
}

on_the_wire!(ArmStatusReason, DriveStatusReason);

impl From<DecodeError> for Refusal {
    fn from(error: DecodeError) -> Self {
        match error {
            DecodeError::Id { .. } | DecodeError::Length { .. } | DecodeError::Crc { .. } => {
                Self::Crc
            }
            DecodeError::Range { .. } => Self::Range,
            // The mode is the only named value in a command.
            DecodeError::Value { .. } => Self::Mode,
        }
    }
}
