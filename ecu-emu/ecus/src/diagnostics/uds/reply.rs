//! A response under construction, in a fixed buffer.

/// Longest response, bytes: 96 codes of four bytes and their head fit.
pub(crate) const REPLY_MAX: usize = 512;

/// Bytes so far; more than fit are noticed, not written.
#[derive(Clone, Debug)]
pub(crate) struct Reply {
    bytes: [u8; REPLY_MAX],
    length: usize,
    overflowed: bool,
}

impl Reply {
    pub(crate) const fn new() -> Self {
        Self { bytes: [0; REPLY_MAX], length: 0, overflowed: false }
    }

    pub(crate) const fn clear(&mut self) {
        (self.length, self.overflowed) = (0, false);
    }

    pub(crate) fn bytes(&self) -> &[u8] {
        &self.bytes[..self.length]
    }

    pub(crate) const fn overflowed(&self) -> bool {
        self.overflowed
    }

    pub(crate) fn push(&mut self, bytes: &[u8]) {
        match self.bytes.get_mut(self.length..self.length + bytes.len()) {
            Some(room) => {
                room.copy_from_slice(bytes);
                self.length += bytes.len();
            }
            None => self.overflowed = true,
        }
    }

    /// Two bytes, high first, as UDS has them; what does not fit is the nearest that does.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // `as` saturates; NaN is 0
    pub(crate) fn unsigned(&mut self, values: &[f64]) {
        values.iter().for_each(|value| self.push(&(value.round() as u16).to_be_bytes()));
    }

    /// The same with a sign.
    #[allow(clippy::cast_possible_truncation)] // `as` saturates; NaN is 0
    pub(crate) fn signed(&mut self, values: &[f64]) {
        values.iter().for_each(|value| self.push(&(value.round() as i16).to_be_bytes()));
    }
}
