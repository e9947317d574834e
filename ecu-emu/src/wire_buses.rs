//! The machine's other wires on CAN interfaces of their own.

use ecu_emu::{Emulator, Wire};
use xt28_bus::{Bus, SocketCan};
use xt28_machine::SimTime;

use crate::listening::{AT_ONCE, discard};
use crate::sending::Outlet;

type Problem = Box<dyn std::error::Error>;

/// Wires that have an interface.
pub(crate) struct WireBuses {
    buses: Vec<(Wire, SocketCan)>,
    /// Each interface's name and the way out to it.
    outlets: Vec<(String, Outlet)>,
}

impl WireBuses {
    pub(crate) fn open(named: &[(Wire, String)]) -> Result<Self, Problem> {
        let open = |(wire, interface): &(Wire, String)| Ok((*wire, SocketCan::open(interface)?));
        let outlet = |(_, interface): &(Wire, String)| (interface.clone(), Outlet::default());
        let outlets = named.iter().map(outlet).collect();
        Ok(Self { buses: named.iter().map(open).collect::<Result<_, Problem>>()?, outlets })
    }

    /// Takes what others sent since the last tick. An ECU reads its boxes once a tick anyway.
    pub(crate) fn listen(&mut self, now: SimTime, emulator: &mut Emulator) -> Result<(), Problem> {
        for (wire, bus) in &mut self.buses {
            for _ in 0..AT_ONCE {
                let Some(received) = bus.receive()? else { break };
                emulator.on_wire_frame(now, *wire, &received.frame);
            }
        }
        Ok(())
    }

    /// Throws away what others sent since the last tick.
    pub(crate) fn discard(&mut self) -> Result<(), Problem> {
        for (_, bus) in &mut self.buses {
            discard(bus)?;
        }
        Ok(())
    }

    /// Sends what the machine put on its wires in this tick.
    pub(crate) fn send(&mut self, now: SimTime, emulator: &Emulator) -> Result<(), Problem> {
        for ((wire, bus), (name, outlet)) in self.buses.iter_mut().zip(&mut self.outlets) {
            outlet.send((bus, name), now, emulator.on_wire(*wire))?;
        }
        Ok(())
    }

    /// Frames that came on them and were lost, because nobody read them in time.
    pub(crate) fn receive_drops(&self) -> u64 {
        self.buses.iter().filter_map(|(_, bus)| bus.receive_drops()).map(u64::from).sum()
    }
}
