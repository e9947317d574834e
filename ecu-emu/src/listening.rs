//! Hearing a bus until a tick is due: what of it is fresh, and how much at a time.

use core::time::Duration;
use std::time::Instant;

use ecu_emu::Emulator;
use xt28_bus::{Bus, SocketCan};
use xt28_machine::SimTime;

use crate::schedule::Schedule;
use crate::watch::Watch;

/// Frames taken off a bus before the clock is looked at again: more than its socket holds, so that what waited
/// through a halt is gone with one look, and so few that no flood keeps a tick from coming.
pub(crate) const AT_ONCE: usize = 4096;

/// A bus that can be waited for.
pub(crate) trait Waited: Bus {
    /// Until something is there to receive, or the time is over.
    fn wait(&mut self, most: Duration) -> Result<(), Self::Error>;
}

impl Waited for SocketCan {
    fn wait(&mut self, most: Duration) -> Result<(), Self::Error> {
        Self::wait(self, most).map(|_| ())
    }
}

/// Throws away what waits on a bus.
pub(crate) fn discard<B: Bus>(bus: &mut B) -> Result<(), B::Error> {
    for _ in 0..AT_ONCE {
        if bus.receive()?.is_none() {
            break;
        }
    }
    Ok(())
}

/// Takes frames off the bus until the tick of `now` is due; sleeps in between.
///
/// An emulator that is behind hears no frame later than its own time: one that came while it was held up must
/// not count as fresh until it has caught up. After a halt it has heard none of those that waited.
pub(crate) fn until_due<B: Waited>(
    bus: &mut B,
    emulator: &mut Emulator,
    now: SimTime,
    schedule: &Schedule,
    watch: &mut Watch,
) -> Result<(), B::Error> {
    loop {
        for _ in 0..AT_ONCE {
            let Some(received) = bus.receive()? else { break };
            watch.note(&received.frame);
            let at = Instant::now();
            if !schedule.is_stale(now, at) {
                emulator.on_frame(schedule.time(at).min(now), &received.frame);
            }
        }
        let left = schedule.due(now).saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Ok(());
        }
        bus.wait(left)?;
    }
}

#[cfg(test)]
mod tests {
    use core::convert::Infallible;

    use ecu_emu::EmulatorConfig;
    use xt28_bus::{BusState, Received};
    use xt28_dbc::{CanId, Frame};
    use xt28_machine::Machine;
    use xt28_sim::Terrain;

    use super::*;

    /// A bus on which somebody never stops to send, or does after so many frames.
    struct Flood {
        left: usize,
    }

    impl Bus for Flood {
        type Error = Infallible;

        fn send(&mut self, _: SimTime, _: &Frame) -> Result<(), Infallible> {
            Ok(())
        }

        fn receive(&mut self) -> Result<Option<Received>, Infallible> {
            let Some(left) = self.left.checked_sub(1) else { return Ok(None) };
            self.left = left;
            let frame = Frame::new(CanId::Standard(0x7FF), &[0; 8]).unwrap();
            Ok(Some(Received { at: SimTime::ZERO, frame }))
        }

        fn state(&self) -> BusState {
            BusState::ErrorActive
        }
    }

    impl Waited for Flood {
        fn wait(&mut self, _: Duration) -> Result<(), Infallible> {
            Ok(())
        }
    }

    fn hear(bus: &mut Flood) {
        let config = EmulatorConfig::new(Machine::xt28(), Terrain::Flat, None);
        let (mut emulator, mut watch) = (Emulator::set_down(&config), Watch::default());
        let schedule = Schedule::new(Instant::now());
        until_due(bus, &mut emulator, SimTime::from_millis(10), &schedule, &mut watch).unwrap();
    }

    #[test]
    fn no_flood_keeps_a_tick_from_coming() {
        let mut flood = Flood { left: usize::MAX };
        hear(&mut flood);
        discard(&mut flood).unwrap();
    }

    #[test]
    fn all_that_a_socket_holds_is_gone_at_once() {
        let mut some = Flood { left: AT_ONCE };
        discard(&mut some).unwrap();
        assert_eq!(some.left, 0);
    }
}
