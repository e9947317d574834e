//! A bus of ours as an `embedded-can` controller, for code written against those traits.

use embedded_can::ErrorKind;
use xt28_machine::SimTime;

use super::CanFrame;
use super::frame::to_embedded_id;
use crate::Bus;

/// Any [`Bus`] as [`embedded_can::nb::Can`].
#[derive(Clone, Debug)]
pub struct Controller<B> {
    bus: B,
    now: SimTime,
}

/// Why a [`Controller`] could not send or receive.
#[derive(Debug, thiserror::Error)]
pub enum ControllerError<E> {
    /// The bus below failed.
    #[error(transparent)]
    Bus(E),
    /// Our buses carry data frames only.
    #[error("remote frames are not sent; ask with a data frame")]
    Remote,
}

impl<E: core::fmt::Debug> embedded_can::Error for ControllerError<E> {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Other
    }
}

impl<B: Bus> Controller<B> {
    /// A controller on `bus`, at time zero.
    pub fn new(bus: B) -> Self {
        Self { bus, now: SimTime::ZERO }
    }

    /// Sets the time at which frames are sent from here on.
    pub fn set_now(&mut self, now: SimTime) {
        self.now = now;
    }

    /// The bus below.
    pub fn bus(&mut self) -> &mut B {
        &mut self.bus
    }

    /// The bus below, for good.
    pub fn into_inner(self) -> B {
        self.bus
    }

    fn send(&mut self, frame: &CanFrame) -> Result<(), ControllerError<B::Error>> {
        let CanFrame::Data(frame) = frame else {
            return Err(ControllerError::Remote);
        };
        self.bus.send(self.now, frame).map_err(ControllerError::Bus)
    }

    fn take(&mut self) -> Result<Option<CanFrame>, ControllerError<B::Error>> {
        while let Some(received) = self.bus.receive().map_err(ControllerError::Bus)? {
            // An identifier beyond its format cannot be shown, and never was on a real bus.
            if to_embedded_id(received.frame.id()).is_some() {
                return Ok(Some(CanFrame::Data(received.frame)));
            }
        }
        Ok(None)
    }
}

impl<B: Bus> embedded_can::nb::Can for Controller<B> {
    type Frame = CanFrame;
    type Error = ControllerError<B::Error>;

    fn transmit(&mut self, frame: &CanFrame) -> nb::Result<Option<CanFrame>, Self::Error> {
        self.send(frame)?;
        Ok(None)
    }

    fn receive(&mut self) -> nb::Result<CanFrame, Self::Error> {
        self.take()?.ok_or(nb::Error::WouldBlock)
    }
}

/// Any [`Bus`] as [`embedded_can::blocking::Can`]: while there is nothing to receive, `wait`
/// lets time pass and says what time it is then.
///
/// On SocketCAN `wait` polls the socket; on a virtual bus it advances it. A `wait` that never
/// brings a frame makes receiving last for ever, as the trait wants it; an error ends it.
#[derive(Clone, Debug)]
pub struct BlockingController<B, W> {
    controller: Controller<B>,
    wait: W,
}

impl<B: Bus, W: FnMut(&mut B) -> Result<SimTime, B::Error>> BlockingController<B, W> {
    /// A controller on `bus`, at time zero.
    pub fn new(bus: B, wait: W) -> Self {
        Self { controller: Controller::new(bus), wait }
    }

    /// The controller without the waiting.
    pub fn controller(&mut self) -> &mut Controller<B> {
        &mut self.controller
    }
}

impl<B: Bus, W: FnMut(&mut B) -> Result<SimTime, B::Error>> embedded_can::blocking::Can
    for BlockingController<B, W>
{
    type Frame = CanFrame;
    type Error = ControllerError<B::Error>;

    fn transmit(&mut self, frame: &CanFrame) -> Result<(), Self::Error> {
        self.controller.send(frame)
    }

    fn receive(&mut self) -> Result<CanFrame, Self::Error> {
        loop {
            if let Some(frame) = self.controller.take()? {
                return Ok(frame);
            }
            let now = (self.wait)(&mut self.controller.bus).map_err(ControllerError::Bus)?;
            self.controller.set_now(now);
        }
    }
}
