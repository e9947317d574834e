//! One node's view of a bus: what every backend and every wrapper offers.

use xt28_dbc::Frame;
use xt28_machine::SimTime;

/// A classic CAN bus as one node sees it. A node does not hear its own frames.
pub trait Bus {
    /// A fault of the host (a socket, a file), never of the bus: those are data, see
    /// [`Bus::state`].
    type Error: core::error::Error + Send + Sync + 'static;

    /// Queues `frame` for transmission; `now` is the sender's time.
    ///
    /// # Errors
    /// The backend cannot take the frame.
    fn send(&mut self, now: SimTime, frame: &Frame) -> Result<(), Self::Error>;

    /// The oldest frame not yet taken, `None` when there is none. Never waits.
    ///
    /// # Errors
    /// The backend cannot be read.
    fn receive(&mut self) -> Result<Option<Received>, Self::Error>;

    /// The error state of this node's controller.
    fn state(&self) -> BusState;
}

impl<B: Bus + ?Sized> Bus for &mut B {
    type Error = B::Error;

    fn send(&mut self, now: SimTime, frame: &Frame) -> Result<(), Self::Error> {
        (**self).send(now, frame)
    }

    fn receive(&mut self) -> Result<Option<Received>, Self::Error> {
        (**self).receive()
    }

    fn state(&self) -> BusState {
        (**self).state()
    }
}

/// A frame and the instant it was complete on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Received {
    /// End of frame: on the virtual bus exact, on SocketCAN as the kernel stamped it.
    pub at: SimTime,
    /// The frame.
    pub frame: Frame,
}

/// Fault confinement of a CAN controller (ISO 11898-1): how far it still takes part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum BusState {
    /// Takes part in full. Error counters below 128, the warning level of 96 included.
    #[default]
    ErrorActive,
    /// Sends and receives, but may no longer stop others with an active error flag.
    ErrorPassive,
    /// Takes no part until restarted.
    BusOff,
}
