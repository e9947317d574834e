//! One node's view of the virtual bus, behind the common trait.

use core::convert::Infallible;

use xt28_dbc::Frame;
use xt28_machine::SimTime;

use super::{NodeId, VirtualBus};
use crate::{Bus, BusState, Received};

/// A node of a [`VirtualBus`] as a [`Bus`]; lives as long as it is looked at.
#[derive(Debug)]
pub struct Port<'a> {
    bus: &'a mut VirtualBus,
    node: NodeId,
}

impl<'a> Port<'a> {
    pub(super) fn new(bus: &'a mut VirtualBus, node: NodeId) -> Self {
        Self { bus, node }
    }

    /// Lets time pass on the whole bus, see [`VirtualBus::advance`].
    pub fn advance(&mut self, to: SimTime) {
        self.bus.advance(to);
    }
}

impl Bus for Port<'_> {
    type Error = Infallible;

    fn send(&mut self, now: SimTime, frame: &Frame) -> Result<(), Infallible> {
        self.bus.send(self.node, now, frame);
        Ok(())
    }

    fn receive(&mut self) -> Result<Option<Received>, Infallible> {
        Ok(self.bus.receive(self.node))
    }

    fn state(&self) -> BusState {
        self.bus.state(self.node)
    }
}
