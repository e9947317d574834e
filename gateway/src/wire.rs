//! The CAN interface of a run, with the log of all that passes it.
//!
//! The log has what was on the bus: a frame of ours when the kernel takes it, and none that it never took.
//! It goes by one clock, the run's own, which does not step. Received frames bear the kernel's
//! wall-clock stamp; what counts of it is how long ago that was when the frame was taken.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use xt28_bus::candump::Writer;
use xt28_bus::socket_can::SocketError;
use xt28_bus::{Bus, SocketCan};
use xt28_dbc::Frame;
use xt28_machine::SimTime;

use crate::departures::Departures;
use crate::problem::Problem;

/// How much longer than since the last look a frame seems to have waited, by the wall clock's pace.
const SLACK: Duration = Duration::from_millis(10);
/// How long is slept at most while frames wait for the kernel.
const RETRY_AFTER: Duration = Duration::from_millis(1);

/// An interface, recorded or not.
pub(crate) struct Wire {
    socket: SocketCan,
    start: SystemTime,
    log: Option<Log<BufWriter<File>>>,
    departures: Departures,
    /// Frames that had left when the queue was found full to the brim: until another one leaves, the bus
    /// carries nothing.
    stuck_at: Option<u64>,
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
                Some(Log::new(Writer::new(BufWriter::new(file), interface).starting_at(epoch)))
            }
        };
        Ok(Self { socket, start, log, departures: Departures::default(), stuck_at: None })
    }

    /// Gives a frame to the kernel. A bus that takes none is no fault of the host: its frames are thrown
    /// away and counted, and [`Wire::is_well`] says so.
    pub(crate) fn send(&mut self, now: SimTime, frame: &Frame) -> Result<(), Problem> {
        if self.stuck_at.is_some() {
            // One frame at a time asks whether it takes any again.
            self.socket.discard_backlog();
        }
        // What was thrown away since the last call is forgotten before another frame leaves in its place.
        self.settle(now);
        match self.socket.send(now, frame) {
            Ok(()) => self.departures.add(frame),
            Err(SocketError::BacklogFull { .. }) => {
                self.stuck_at = Some(self.socket.counters().sent);
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
        self.stuck_at = self.stuck_at.filter(|at| *at == left);
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
        !self.socket.take_bus_off() && self.stuck_at.is_none()
    }

    /// Whether all that passed is in the log, if one is wanted.
    pub(crate) fn log_is_whole(&self) -> bool {
        self.log.as_ref().is_none_or(|log| log.broke.is_none())
    }

    /// Writes out the log so far: of a run that is about to end nothing is lost to whoever does not wait for it.
    pub(crate) fn keep(&mut self) {
        if let Some(log) = &mut self.log {
            log.keep();
        }
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

/// A log whose disk may be full: the bus goes on without it, since the machine is still to be stopped.
struct Log<W> {
    writer: Writer<W>,
    broke: Option<io::Error>,
}

impl<W: Write> Log<W> {
    const fn new(writer: Writer<W>) -> Self {
        Self { writer, broke: None }
    }

    fn write(&mut self, at: SimTime, frame: &Frame) {
        if self.broke.is_none() {
            self.broke = self.writer.write(at, frame).err();
        }
    }

    fn keep(&mut self) {
        if self.broke.is_none() {
            self.broke = self.writer.flush().err();
        }
    }

    /// What went wrong first.
    fn close(mut self) -> io::Result<()> {
        self.keep();
        self.broke.map_or(Ok(()), Err)
    }
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
    use xt28_dbc::CanId;

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
    fn a_log_keeps_its_first_fault_to_the_end_and_writes_nothing_behind_it() {
        let frame = Frame::new(CanId::Standard(1), &[]).unwrap();
        let line = "(0.000000) can0 001#\n";
        let mut disk = vec![0; line.len() + 3];
        let mut log = Log::new(Writer::new(&mut disk[..], "can0"));
        log.write(SimTime::ZERO, &frame);
        assert!(log.broke.is_none());
        (0..3).for_each(|_| log.write(SimTime::ZERO, &frame));
        assert_eq!(log.close().unwrap_err().kind(), io::ErrorKind::WriteZero);
        assert_eq!(disk, format!("{line}(0.").into_bytes());
    }

    #[test]
    fn a_log_that_is_kept_waits_in_no_buffer() {
        let frame = Frame::new(CanId::Standard(1), &[]).unwrap();
        let mut log = Log::new(Writer::new(BufWriter::new(Vec::new()), "can0"));
        log.write(SimTime::ZERO, &frame);
        log.keep();
        log.write(SimTime::ZERO, &frame);
        let disk = log.writer.into_inner();
        assert_eq!(disk.get_ref(), b"(0.000000) can0 001#\n", "the second waits still");
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
