//! Writes a log line by line.

use core::time::Duration;
use std::io::{self, Write};

use xt28_dbc::{CanId, Frame};
use xt28_machine::SimTime;

/// Digits behind the decimal point of a time; what is finer is cut off, so order is kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// Six, as candump writes unless told otherwise.
    #[default]
    Micros,
    /// Nine: exact.
    Nanos,
}

/// Writes frames as candump does. Buffer what it writes to; a log is complete when that has been
/// flushed ([`Writer::flush`]).
#[derive(Debug)]
pub struct Writer<W> {
    out: W,
    interface: String,
    start: Duration,
    precision: Precision,
    line: Vec<u8>,
}

impl<W: Write> Writer<W> {
    /// Writes to `out`, naming `interface` in each line; white space in the name becomes `_`.
    pub fn new(out: W, interface: &str) -> Self {
        let interface = interface.replace(|c: char| c.is_whitespace() || c == '#', "_");
        Self {
            out,
            interface: if interface.is_empty() { "_".to_owned() } else { interface },
            start: Duration::ZERO,
            precision: Precision::default(),
            line: Vec::with_capacity(80),
        }
    }

    /// Adds `start`, the run's start since 1970, to every time.
    #[must_use]
    pub fn starting_at(mut self, start: Duration) -> Self {
        self.start = start;
        self
    }

    /// Sets the digits behind the decimal point.
    #[must_use]
    pub fn with_precision(mut self, precision: Precision) -> Self {
        self.precision = precision;
        self
    }

    /// Writes one line.
    ///
    /// # Errors
    /// The writer below fails.
    pub fn write(&mut self, at: SimTime, frame: &Frame) -> io::Result<()> {
        let at = (at + self.start).as_nanos();
        let (seconds, nanos) = (at / 1_000_000_000, at % 1_000_000_000);
        self.line.clear();
        match self.precision {
            Precision::Micros => write!(self.line, "({seconds}.{:06}) ", nanos / 1_000)?,
            Precision::Nanos => write!(self.line, "({seconds}.{nanos:09}) ")?,
        }
        self.line.extend_from_slice(self.interface.as_bytes());
        self.line.push(b' ');
        let digits = if matches!(frame.id(), CanId::Standard(_)) { 3 } else { 8 };
        for digit in (0..digits).rev() {
            self.line.push(nibble(frame.id().raw() >> (4 * digit)));
        }
        self.line.push(b'#');
        for &byte in frame.data() {
            self.line.extend([nibble(u32::from(byte >> 4)), nibble(u32::from(byte))]);
        }
        self.line.push(b'\n');
        self.out.write_all(&self.line)
    }

    /// Flushes the writer below.
    ///
    /// # Errors
    /// The writer below fails.
    pub fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }

    /// The writer below, not flushed.
    pub fn into_inner(self) -> W {
        self.out
    }
}

/// The lowest four bits as a digit.
fn nibble(bits: u32) -> u8 {
    b"0123456789ABCDEF"[(bits & 0xF) as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(writer: impl FnOnce(Writer<Vec<u8>>) -> Writer<Vec<u8>>, frame: &Frame) -> String {
        let mut writer = writer(Writer::new(Vec::new(), "can0"));
        writer.write(SimTime::from_nanos(1_005_006_999), frame).unwrap();
        String::from_utf8(writer.into_inner()).unwrap()
    }

    #[test]
    fn writes_as_candump_does() {
        let command = Frame::new(CanId::Extended(0x0CFF_4027), &[0x55, 0x0A]).unwrap();
        assert_eq!(written(|w| w, &command), "(1.005006) can0 0CFF4027#550A\n");
        let empty = Frame::new(CanId::Standard(0x1F), &[]).unwrap();
        assert_eq!(written(|w| w, &empty), "(1.005006) can0 01F#\n");
    }

    #[test]
    fn adds_the_start_and_keeps_nanoseconds_where_asked() {
        let empty = Frame::new(CanId::Standard(0x1F), &[]).unwrap();
        let start = Duration::from_secs(1_758_440_579);
        let line = written(|w| w.starting_at(start).with_precision(Precision::Nanos), &empty);
        assert_eq!(line, "(1758440580.005006999) can0 01F#\n");
    }

    #[test]
    fn a_name_that_would_break_the_line_is_mended() {
        let mut writer = Writer::new(Vec::new(), "can 0\n");
        writer.write(SimTime::ZERO, &Frame::new(CanId::Standard(1), &[]).unwrap()).unwrap();
        assert_eq!(writer.into_inner(), b"(0.000000) can_0_ 001#\n");
    }
}
