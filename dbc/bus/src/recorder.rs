//! Any bus, with all that passes one node written to a candump log.

use std::io::{self, Write};

use xt28_dbc::Frame;
use xt28_machine::SimTime;

use crate::candump::Writer;
use crate::{Bus, BusState, Received};

/// Passes everything on to the bus below, and logs it: a sent frame at the time of sending, a
/// received one at its own. So lines need not be in order of time; for the bus order of a
/// [`crate::VirtualBus`] write its tap instead ([`crate::VirtualBus::drain_tap`]).
#[derive(Debug)]
pub struct Recorder<B, W> {
    bus: B,
    log: Writer<W>,
}

/// The bus or the log failed.
#[derive(Debug, thiserror::Error)]
pub enum RecordError<E> {
    /// The bus below failed.
    #[error(transparent)]
    Bus(E),
    /// The log could not be written. A frame was sent or received nevertheless.
    #[error("cannot write the log: {0}; is the disk full?")]
    Log(io::Error),
}

impl<B: Bus, W: Write> Recorder<B, W> {
    /// Records `bus` to `log`.
    pub fn new(bus: B, log: Writer<W>) -> Self {
        Self { bus, log }
    }

    /// The bus below, for what the trait does not offer.
    pub fn bus(&mut self) -> &mut B {
        &mut self.bus
    }

    /// Writes out what is still buffered.
    ///
    /// # Errors
    /// The writer below fails.
    pub fn flush(&mut self) -> io::Result<()> {
        self.log.flush()
    }

    /// The bus and the log.
    pub fn into_parts(self) -> (B, Writer<W>) {
        (self.bus, self.log)
    }
}

impl<B: Bus, W: Write> Bus for Recorder<B, W> {
    type Error = RecordError<B::Error>;

    fn send(&mut self, now: SimTime, frame: &Frame) -> Result<(), Self::Error> {
        self.bus.send(now, frame).map_err(RecordError::Bus)?;
        self.log.write(now, frame).map_err(RecordError::Log)
    }

    fn receive(&mut self) -> Result<Option<Received>, Self::Error> {
        let received = self.bus.receive().map_err(RecordError::Bus)?;
        if let Some(Received { at, frame }) = &received {
            self.log.write(*at, frame).map_err(RecordError::Log)?;
        }
        Ok(received)
    }

    fn state(&self) -> BusState {
        self.bus.state()
    }
}

#[cfg(test)]
mod tests {
    use xt28_dbc::CanId;

    use super::*;
    use crate::{Bitrate, VirtualBus};

    #[test]
    fn logs_what_a_node_sends_and_hears_and_passes_it_on() {
        let mut bus = VirtualBus::new(Bitrate::MBIT_1);
        let (a, b) = (bus.attach("a"), bus.attach("b"));
        let [ping, pong] = [1, 2].map(|id| Frame::new(CanId::Standard(id), &[0xA5]).unwrap());
        bus.send(b, SimTime::ZERO, &pong);
        bus.advance(SimTime::from_millis(1));

        let mut recorder = Recorder::new(bus.port(a), Writer::new(Vec::new(), "vcan0"));
        recorder.send(SimTime::from_millis(1), &ping).unwrap();
        let heard = recorder.receive().unwrap().unwrap();
        assert_eq!(heard.frame, pong);
        assert_eq!(recorder.receive().unwrap(), None);
        let log = String::from_utf8(recorder.into_parts().1.into_inner()).unwrap();
        let heard_us = heard.at.as_nanos() / 1_000;
        assert_eq!(log, format!("(0.001000) vcan0 001#A5\n(0.{heard_us:06}) vcan0 002#A5\n"));

        bus.advance(SimTime::from_millis(2));
        assert_eq!(bus.receive(b).unwrap().frame, ping);
    }

    #[test]
    fn a_log_that_cannot_be_written_is_an_error() {
        let mut bus = VirtualBus::default();
        let a = bus.attach("a");
        let mut full: [u8; 4] = [0; 4];
        let mut recorder = Recorder::new(bus.port(a), Writer::new(&mut full[..], "vcan0"));
        let frame = Frame::new(CanId::Standard(1), &[]).unwrap();
        assert!(matches!(recorder.send(SimTime::ZERO, &frame), Err(RecordError::Log(_))));
    }
}
