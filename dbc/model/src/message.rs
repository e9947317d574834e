//! Messages of a database: their signals, and frames decoded and encoded by name.

use crate::{Field, Kind, ValueError};

/// A named number in a message.
#[derive(Clone, Debug, PartialEq)]
pub struct Signal {
    /// Name, as in the database.
    pub name: String,
    /// Where and how it is stored.
    pub field: Field,
    /// Unit, as in the database; empty for none.
    pub unit: String,
    /// Names of raw values.
    pub values: Vec<(i64, String)>,
    /// The database's comment.
    pub comment: String,
    /// When it is there; always, without one.
    pub present: Option<Presence>,
    /// Others are there depending on it.
    pub is_switch: bool,
}

/// A multiplexed signal is there while its switch is there and reads a value in one of the ranges.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Presence {
    /// Name of the switch.
    pub switch: String,
    /// Raw values, both ends included.
    pub ranges: Vec<(u64, u64)>,
}

/// A frame layout.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    /// Identifier as the database writes it: bit 31 set for 29 bits.
    pub id: u32,
    /// Name.
    pub name: String,
    /// Length, bytes.
    pub len: u8,
    /// Who sends it.
    pub sender: String,
    /// The database's comment.
    pub comment: String,
    /// Period, ms; zero for none.
    pub period_ms: u32,
    /// Data ID of its end-to-end protection; zero for none.
    pub data_id: u16,
    /// It carries an alive counter.
    pub alive: bool,
    /// Signals, in the order of the database.
    pub signals: Vec<Signal>,
}

/// Why a frame was not decoded or encoded.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CodecError {
    /// The frame has another length than the message.
    #[error("{message}: {got} bytes instead of {len}")]
    Length {
        /// The message.
        message: String,
        /// Its length.
        len: u8,
        /// The frame's.
        got: usize,
    },
    /// A value is not one the database allows.
    #[error("{message}.{signal}: {source}")]
    Value {
        /// The message.
        message: String,
        /// The signal.
        signal: String,
        /// What is wrong with it.
        source: ValueError,
    },
    /// A signal that should be there was not given.
    #[error("{message}.{signal} is missing")]
    Missing {
        /// The message.
        message: String,
        /// The signal.
        signal: String,
    },
    /// A name the message does not have, or not with the switches given.
    #[error("{message} has no signal {signal} here")]
    Unknown {
        /// The message.
        message: String,
        /// The name.
        signal: String,
    },
}

/// Bit of the CRC byte of a protected message.
const CRC_START: u16 = 56;

impl Message {
    /// True if its frames carry the CRC of our end-to-end protection: a data ID, and an 8-bit signal
    /// `Crc` in the last of eight bytes.
    #[must_use]
    pub fn is_protected(&self) -> bool {
        self.data_id != 0 && self.len == 8 && self.signals.iter().any(Signal::is_crc)
    }

    /// The signal of that name.
    #[must_use]
    pub fn signal(&self, name: &str) -> Option<&Signal> {
        self.signals.iter().find(|signal| signal.name == name)
    }

    /// Values of all signals that are there, in the order of the database.
    ///
    /// # Errors
    /// [`CodecError::Length`] or [`CodecError::Value`].
    pub fn decode(&self, data: &[u8]) -> Result<Vec<(&Signal, f64)>, CodecError> {
        self.check_length(data.len())?;
        let mut values = Vec::with_capacity(self.signals.len());
        for signal in &self.signals {
            if self.is_present(signal, data) {
                let value = signal.field.read(data).map_err(|e| self.value_error(signal, e))?;
                values.push((signal, value));
            }
        }
        Ok(values)
    }

    /// The frame's bytes from named values; every signal that is there must be given, no other.
    ///
    /// # Errors
    /// [`CodecError`].
    pub fn encode(&self, values: &[(&str, f64)]) -> Result<Vec<u8>, CodecError> {
        let mut data = vec![0; usize::from(self.len)];
        let given = |name: &str| values.iter().find(|(n, _)| *n == name).map(|(_, value)| *value);
        // Switches first and outermost first, so that what they select is known.
        let mut written: Vec<&str> = Vec::new();
        loop {
            let next = self.signals.iter().find(|s| {
                !written.contains(&s.name.as_str())
                    && s.present.as_ref().is_none_or(|p| written.contains(&p.switch.as_str()))
                    && self.is_present(s, &data)
            });
            let Some(signal) = next else { break };
            let value = given(&signal.name).ok_or_else(|| CodecError::Missing {
                message: self.name.clone(),
                signal: signal.name.clone(),
            })?;
            signal.field.write(&mut data, value).map_err(|e| self.value_error(signal, e))?;
            written.push(&signal.name);
        }
        match values.iter().find(|(name, _)| !written.contains(name)) {
            Some((name, _)) => {
                Err(CodecError::Unknown { message: self.name.clone(), signal: (*name).to_owned() })
            }
            None => Ok(data),
        }
    }

    /// Whether a signal is there in a frame with these bytes, switches of switches included.
    #[must_use]
    pub fn is_present(&self, signal: &Signal, data: &[u8]) -> bool {
        let mut signal = signal;
        // A chain of switches is no longer than the list of signals, unless it is a ring.
        for _ in 0..=self.signals.len() {
            let Some(presence) = &signal.present else { return true };
            let Some(switch) = self.signal(&presence.switch) else { return false };
            let raw = switch.field.raw(data);
            if !presence.ranges.iter().any(|&(low, high)| (low..=high).contains(&raw)) {
                return false;
            }
            signal = switch;
        }
        false
    }

    /// The signal itself and the switches it hangs on, outermost last. A ring of them is cut.
    pub(crate) fn switches<'a>(&'a self, signal: &'a Signal) -> impl Iterator<Item = &'a Signal> {
        let outer = |signal: &&'a Signal| self.signal(&signal.present.as_ref()?.switch);
        core::iter::successors(Some(signal), outer).take(self.signals.len() + 1)
    }

    fn check_length(&self, got: usize) -> Result<(), CodecError> {
        if got == usize::from(self.len) {
            return Ok(());
        }
        Err(CodecError::Length { message: self.name.clone(), len: self.len, got })
    }

    fn value_error(&self, signal: &Signal, source: ValueError) -> CodecError {
        CodecError::Value { message: self.name.clone(), signal: signal.name.clone(), source }
    }
}

impl Signal {
    /// True for a CRC where end-to-end protection has it.
    pub(crate) fn is_crc(&self) -> bool {
        let field = &self.field;
        self.name == "Crc" && field.length == 8 && field.start == CRC_START && !field.big_endian
    }

    /// True for a whole number without unit: a count, a state, a flag.
    #[must_use]
    pub fn is_plain_integer(&self) -> bool {
        self.unit.is_empty()
            && (self.field.factor - 1.0).abs() < f64::EPSILON
            && self.field.offset.abs() < f64::EPSILON
            && matches!(self.field.kind, Kind::Unsigned | Kind::Signed)
    }
}
