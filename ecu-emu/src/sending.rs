//! Frames out to an interface, and what is said where none leaves.

use xt28_bus::socket_can::SocketError;
use xt28_bus::{Bus, SocketCan};
use xt28_dbc::Frame;
use xt28_machine::SimTime;

use crate::tell;

/// The way out to one interface.
#[derive(Debug, Default)]
pub(crate) struct Outlet {
    /// It was said that no frame leaves.
    told: bool,
}

impl Outlet {
    /// Gives frames to `bus`, which is called `name`. One that takes none, as nobody is there to acknowledge them yet,
    /// loses them, which is said once: the machine goes on, as its ECUs would.
    pub(crate) fn send<'a>(
        &mut self,
        (bus, name): (&mut SocketCan, &str),
        now: SimTime,
        frames: impl IntoIterator<Item = &'a Frame>,
    ) -> Result<(), SocketError> {
        for frame in frames {
            match bus.send(now, frame) {
                Err(SocketError::BacklogFull { .. }) => {
                    bus.discard_backlog();
                    self.stuck(name).into_iter().for_each(tell);
                }
                sent => sent?,
            }
        }
        Ok(())
    }

    /// What to say of an interface that takes nothing, the first time.
    fn stuck(&mut self, name: &str) -> Option<String> {
        let is_news = !std::mem::replace(&mut self.told, true);
        is_news.then(|| {
            format!(
                "{name}: no frame leaves, and those that wait are thrown away until one does; is another node on the bus, \
                 at the same bit rate?"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bus_that_takes_nothing_is_told_once() {
        let mut outlet = Outlet::default();
        for told in [true, false] {
            let line = outlet.stuck("can0");
            assert_eq!(line.is_some_and(|line| line.contains("can0: no frame leaves")), told);
        }
    }
}
