//! The CAN interface of a run, with the log of all that passes it.
//!
//! The log has what was on the bus: a frame of ours when the kernel takes it, and none that it never took.
//! It goes by one clock, the run's own, which does not step. Received frames bear the kernel's
//! wall-clock stamp; what counts of it is how long ago that was when the frame was taken.

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::Path;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use xt28_bus::candump::Writer;
use xt28_bus::socket_can::SocketError;
use xt28_bus::{Bus, SocketCan};
use xt28_dbc::Frame;
use xt28_machine::SimTime;

use crate::departures::Departures;
use crate::log::Log;
use crate::problem::Problem;

/// How much longer than since the last look a frame seems to have waited, by the wall clock's pace.
const SLACK: Duration = Duration::from_millis(10);
/// So long a bus that took no frame counts as one that carries none, where nothing is sent that could tell (assumed).
const STUCK: Duration = Duration::from_secs(1);
/// How long is slept at most while frames wait for the kernel.
const RETRY_AFTER: Duration = Duration::from_millis(1);

/// An interface, recorded or not.
pub(crate) struct Wire {
    socket: SocketCan,
    start: SystemTime,
    log: Option<Log>,
    departures: Departures,
    /// Frames that had left when the queue was found full to the brim, and when that was: the bus carries nothing
    /// then until another frame leaves, or for [`STUCK`].
    stuck: Option<(u64, SimTime)>,
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
                let file = create(path)
                    .map_err(|source| Problem::Record { path: path.to_owned(), source })?;
                let epoch = start.duration_since(UNIX_EPOCH).unwrap_or_default();
                let writer = Writer::new(BufWriter::new(file), interface).starting_at(epoch);
                Some(Log::start(writer).map_err(Problem::Thread)?)
            }
        };
        Ok(Self { socket, start, log, departures: Departures::default(), stuck: None })
    }

    /// Gives a frame to the kernel. A bus that takes none is no fault of the host: its frames are thrown
    /// away and counted, and [`Wire::is_well`] says so.
    pub(crate) fn send(&mut self, now: SimTime, frame: &Frame) -> Result<(), Problem> {
        if self.stuck.is_some() {
            // One frame at a time asks whether it takes any again.
            self.socket.discard_backlog();
        }
        // What was thrown away since the last call is forgotten before another frame leaves in its place.
        self.settle(now);
        match self.socket.send(now, frame) {
            Ok(()) => self.departures.add(frame),
            Err(SocketError::BacklogFull { .. }) => {
                self.stuck = Some((self.socket.counters().sent, now));
                self.socket.discard_backlog();
            }
            Err(error) => return Err(error.into()),
        }
        self.settle(now);
        Ok(())
    }

    /// Logs what has left by `now`.
    fn settle(&mut self, now: SimTime) {
        let left = self.socket.counters().sent;
        self.stuck = self.stuck.filter(|(at, since)| *at == left && now.since(*since) < STUCK);
        let gone = self.departures.settle(left, self.socket.backlog());
        gone.iter().for_each(|frame| self.log(now, frame));
    }

    /// The next frame; `since_start` is the run's clock, and `emptied` when no frame was left by it.
    pub(crate) fn receive(
        &mut self,
        since_start: impl Fn() -> Duration,
        emptied: Duration,
    ) -> Result<Option<Frame>, Problem> {
        let Some(received) = self.socket.receive()? else { return Ok(None) };
        let now = since_start();
        let wall = SystemTime::now().duration_since(self.start).unwrap_or_default();
        let waited = now.saturating_sub(emptied) + SLACK;
        let at = heard_at(now, waited, wall, received.at.since(SimTime::ZERO));
        self.log(at, &received.frame);
        Ok(Some(received.frame))
    }

    /// Sleeps until a frame is there or `timeout` is over, or less while frames of ours wait.
    pub(crate) fn wait(
        &mut self,
        timeout: Duration,
        since_start: impl Fn() -> Duration,
    ) -> Result<(), Problem> {
        let most = if self.departures.wait() { RETRY_AFTER } else { timeout };
        self.socket.wait(timeout.min(most))?;
        self.settle(SimTime::ZERO + since_start());
        Ok(())
    }

    /// Throws away what the kernel has not taken yet.
    pub(crate) fn discard_waiting(&mut self) {
        self.socket.discard_backlog();
    }

    /// Frames of ours that were thrown away: the bus was off or took none, or they were too old.
    pub(crate) fn discarded(&self) -> u64 {
        let counters = self.socket.counters();
        counters.discarded + counters.refused
    }

    /// Received frames that the kernel dropped because nobody read them in time; none where it does not say.
    pub(crate) fn lost(&self) -> Option<u32> {
        self.socket.receive_drops()
    }

    /// Whether the bus carries frames: the controller is not off it, was not since the last call, and some leave.
    pub(crate) fn is_well(&mut self) -> bool {
        !self.socket.take_bus_off() && self.stuck.is_none()
    }

    /// Whether all that passed is in the log, if one is wanted.
    pub(crate) fn log_is_whole(&self) -> bool {
        self.log.as_ref().is_none_or(Log::is_whole)
    }

    /// Writes out the log.
    pub(crate) fn close(self) -> Result<(), Problem> {
        self.log.map_or(Ok(()), Log::close).map_err(Problem::Log)
    }

    fn log(&mut self, at: SimTime, frame: &Frame) {
        if let Some(log) = &mut self.log {
            log.write(at, frame);
        }
    }
}

/// An empty file for the log. One that holds something stays as it is: the last drive's log is as easily named twice
/// as it is hard to drive again.
fn create(path: &Path) -> io::Result<File> {
    let file = File::options().write(true).create(true).truncate(false).open(path)?;
    let there = file.metadata()?;
    if there.is_file() && there.len() > 0 {
        return Err(io::Error::new(io::ErrorKind::AlreadyExists, "it holds something already"));
    }
    Ok(file)
}

/// When a frame came in, on the run's clock: `now` less its age, which is what the wall clock says now
/// (`wall`) less what it said then (`stamp`), all since the start. An age beyond `waited` says that the wall
/// clock was set in between.
fn heard_at(now: Duration, waited: Duration, wall: Duration, stamp: Duration) -> SimTime {
    let age = wall.checked_sub(stamp).filter(|age| *age <= waited).unwrap_or_default();
    SimTime::ZERO + now.saturating_sub(age)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_that_is_there_is_not_written_over() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run-1.log");
        create(&path).unwrap();
        create(&path).expect("nothing is in it");
        std::fs::write(&path, "(0.0) can0 001#").unwrap();
        assert_eq!(create(&path).unwrap_err().kind(), io::ErrorKind::AlreadyExists);
        assert_eq!(std::fs::read(&path).unwrap(), b"(0.0) can0 001#");
        create(Path::new("/dev/null")).expect("no file to lose");
    }

    #[test]
    fn a_frame_is_logged_when_it_came_in_whatever_the_wall_clock_says() {
        let ms = Duration::from_millis;
        let heard = |now, waited, wall, stamp| {
            heard_at(ms(now), ms(waited), ms(wall), ms(stamp)).as_nanos() / 1_000_000
        };
        let at = |now, wall, stamp| heard(now, 20, wall, stamp);
        assert_eq!(at(5_000, 5_000, 4_991), 4_991);
        // Set by an hour before the frame came: only its age counts.
        assert_eq!(at(5_000, 3_605_000, 3_604_991), 4_991);
        // Set back before the start, where both read zero.
        assert_eq!(at(5_000, 0, 0), 5_000);
        // Set between stamp and taking, either way.
        assert_eq!(at(5_000, 3_605_000, 4_991), 5_000);
        assert_eq!(at(5_000, 1_000, 4_991), 5_000);
        // Read after a halt of ten seconds.
        assert_eq!(heard(15_000, 10_010, 15_000, 5_100), 5_100);
    }
}
