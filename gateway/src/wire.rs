//! The CAN interface of a run, with the log of all that passes it.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use xt28_bus::candump::Writer;
use xt28_bus::socket_can::SocketError;
use xt28_bus::{Bus, BusState, SocketCan};
use xt28_dbc::Frame;
use xt28_machine::SimTime;

use crate::problem::Problem;

/// An interface, recorded or not.
pub(crate) struct Wire {
    socket: SocketCan,
    log: Option<Writer<BufWriter<File>>>,
}

impl Wire {
    /// Opens the interface; times in the log count from `start`.
    pub(crate) fn open(
        interface: &str,
        record: Option<&Path>,
        start: SystemTime,
    ) -> Result<Self, Problem> {
        let socket = SocketCan::open(interface)?.starting_at(start);
        let log = match record {
            None => None,
            Some(path) => {
                let file = File::create(path)
                    .map_err(|source| Problem::Record { path: path.to_owned(), source })?;
                let epoch = start.duration_since(UNIX_EPOCH).unwrap_or_default();
                Some(Writer::new(BufWriter::new(file), interface).starting_at(epoch))
            }
        };
        Ok(Self { socket, log })
    }

    pub(crate) fn send(&mut self, now: SimTime, frame: &Frame) -> Result<(), Problem> {
        self.socket.send(now, frame)?;
        self.log(now, frame)
    }

    /// The next frame. Its log line has the kernel's stamp; the caller goes by its own clock, which
    /// does not step.
    pub(crate) fn receive(&mut self) -> Result<Option<Frame>, Problem> {
        let Some(received) = self.socket.receive()? else { return Ok(None) };
        self.log(received.at, &received.frame)?;
        Ok(Some(received.frame))
    }

    /// Sleeps until a frame is there or `timeout` is over.
    pub(crate) fn wait(&mut self, timeout: Duration) -> Result<bool, SocketError> {
        self.socket.wait(timeout)
    }

    pub(crate) fn is_well(&self) -> bool {
        self.socket.state() != BusState::BusOff
    }

    /// Writes out the log.
    pub(crate) fn close(self) -> Result<(), Problem> {
        match self.log {
            None => Ok(()),
            Some(mut log) => log.flush().map_err(Problem::Log),
        }
    }

    fn log(&mut self, at: SimTime, frame: &Frame) -> Result<(), Problem> {
        match &mut self.log {
            None => Ok(()),
            Some(log) => log.write(at, frame).map_err(Problem::Log),
        }
    }
}
