//! Little-endian fields at fixed offsets of a payload of known size.

/// A payload of `N` bytes, read by offset. Offsets are constants, so a wrong one fails in any test.
#[derive(Clone, Copy)]
pub(crate) struct Payload<const N: usize>(pub(crate) [u8; N]);

impl<const N: usize> Payload<N> {
    /// The payload, `None` when `bytes` has another length.
    pub(crate) fn read(bytes: &[u8]) -> Option<Self> {
        bytes.try_into().ok().map(Self)
    }

    fn take<const K: usize>(&self, at: usize) -> [u8; K] {
        let mut bytes = [0; K];
        bytes.copy_from_slice(&self.0[at..at + K]);
        bytes
    }

    pub(crate) fn u8(&self, at: usize) -> u8 {
        self.0[at]
    }

    pub(crate) fn i8(&self, at: usize) -> i8 {
        i8::from_le_bytes(self.take(at))
    }

    pub(crate) fn u16(&self, at: usize) -> u16 {
        u16::from_le_bytes(self.take(at))
    }

    pub(crate) fn u32(&self, at: usize) -> u32 {
        u32::from_le_bytes(self.take(at))
    }

    pub(crate) fn i32(&self, at: usize) -> i32 {
        i32::from_le_bytes(self.take(at))
    }

    /// Writes `bytes` at `at`; reserved bytes stay zero.
    pub(crate) fn put<const K: usize>(&mut self, at: usize, bytes: [u8; K]) {
        self.0[at..at + K].copy_from_slice(&bytes);
    }
}
