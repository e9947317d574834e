//! The machine's other wires on CAN interfaces of their own.

use ecu_emu::{Emulator, Wire};
use xt28_bus::{Bus, SocketCan};
use xt28_machine::SimTime;

type Problem = Box<dyn std::error::Error>;

/// Wires that have an interface.
pub(crate) struct WireBuses {
    buses: Vec<(Wire, SocketCan)>,
}

impl WireBuses {
    pub(crate) fn open(named: &[(Wire, String)]) -> Result<Self, Problem> {
        let open = |(wire, interface): &(Wire, String)| Ok((*wire, SocketCan::open(interface)?));
        Ok(Self { buses: named.iter().map(open).collect::<Result<_, Problem>>()? })
    }

    /// Takes what others sent since the last tick. An ECU reads its boxes once a tick anyway.
    pub(crate) fn listen(&mut self, now: SimTime, emulator: &mut Emulator) -> Result<(), Problem> {
        for (wire, bus) in &mut self.buses {
            while let Some(received) = bus.receive()? {
                emulator.on_wire_frame(now, *wire, &received.frame);
            }
        }
        Ok(())
    }

    /// Throws away what others sent since the last tick.
    pub(crate) fn discard(&mut self) -> Result<(), Problem> {
        for (_, bus) in &mut self.buses {
            while bus.receive()?.is_some() {}
        }
        Ok(())
    }

    /// Sends what the machine put on its wires in this tick.
    pub(crate) fn send(&mut self, now: SimTime, emulator: &Emulator) -> Result<(), Problem> {
        for (wire, bus) in &mut self.buses {
            for frame in emulator.on_wire(*wire) {
                bus.send(now, frame)?;
            }
        }
        Ok(())
    }
}
