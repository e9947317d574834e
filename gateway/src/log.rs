//! The log of a run, written by a thread of its own: a disk that is slow or full must not keep the machine waiting.

use std::io::{self, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TryRecvError, sync_channel};
use std::time::Duration;

use xt28_bus::candump::Writer;
use xt28_dbc::Frame;
use xt28_machine::SimTime;

/// Most records that wait for the disk: some seconds of a whole bus.
const WAITING_MAX: usize = 16_384;
/// So long is waited for the disk once the run is over.
const PATIENCE: Duration = Duration::from_secs(5);

type Record = (SimTime, Frame);

/// A log whose disk may be full: the bus goes on without it, since the machine is still to be stopped.
pub(crate) struct Log {
    records: SyncSender<Record>,
    /// How it ended: once, when all was written or something went wrong.
    ended: Receiver<io::Result<()>>,
    is_whole: Arc<AtomicBool>,
    /// More waited than may.
    is_overrun: bool,
}

impl Log {
    /// Starts its thread.
    pub(crate) fn start<W: Write + Send + 'static>(writer: Writer<W>) -> io::Result<Self> {
        Self::with_room(writer, WAITING_MAX)
    }

    fn with_room<W: Write + Send + 'static>(writer: Writer<W>, most: usize) -> io::Result<Self> {
        let (records, given) = sync_channel(most);
        let (done, ended) = sync_channel(1);
        let is_whole = Arc::new(AtomicBool::new(true));
        let whole = Arc::clone(&is_whole);
        let write = move || {
            let result = write_all(writer, &given);
            whole.fetch_and(result.is_ok(), Ordering::Relaxed);
            let _ = done.send(result);
        };
        std::thread::Builder::new().name("log".to_owned()).spawn(write)?;
        Ok(Self { records, ended, is_whole, is_overrun: false })
    }

    /// Takes a record, to be written soon. Behind one that was lost none is.
    pub(crate) fn write(&mut self, at: SimTime, frame: &Frame) {
        if !self.is_overrun && self.records.try_send((at, *frame)).is_err() {
            // Where the thread has ended, it says why.
            self.is_overrun = true;
            self.is_whole.store(false, Ordering::Relaxed);
        }
    }

    /// Whether nothing was lost so far.
    pub(crate) fn is_whole(&self) -> bool {
        self.is_whole.load(Ordering::Relaxed)
    }

    /// Waits until all is written; what went wrong first.
    pub(crate) fn close(self) -> io::Result<()> {
        drop(self.records);
        let slow = || io::Error::new(io::ErrorKind::TimedOut, "the disk is too slow for the bus");
        match self.ended.recv_timeout(PATIENCE) {
            Ok(Ok(())) if self.is_overrun => Err(slow()),
            Ok(result) => result,
            Err(RecvTimeoutError::Timeout) => Err(slow()),
            Err(RecvTimeoutError::Disconnected) => Err(io::Error::other("its thread is gone")),
        }
    }
}

/// Writes until nobody gives any more. What is written waits in no buffer while nothing else does: who does not wait
/// for the end of a run has its log all the same.
fn write_all<W: Write>(mut writer: Writer<W>, given: &Receiver<Record>) -> io::Result<()> {
    loop {
        let record = match given.try_recv() {
            Ok(record) => Some(record),
            Err(TryRecvError::Empty) => {
                writer.flush()?;
                given.recv().ok()
            }
            Err(TryRecvError::Disconnected) => None,
        };
        let Some((at, frame)) = record else { return writer.flush() };
        writer.write(at, &frame)?;
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;
    use std::sync::mpsc::Sender;

    use xt28_dbc::CanId;

    use super::*;

    const LINE: &str = "(0.000000) can0 001#\n";

    fn frame() -> Frame {
        Frame::new(CanId::Standard(1), &[]).unwrap()
    }

    /// A disk with so much room left.
    #[derive(Clone)]
    struct Disk(Arc<Mutex<Vec<u8>>>, usize);

    impl Disk {
        fn new(room: usize) -> Self {
            Self(Arc::default(), room)
        }

        fn text(&self) -> String {
            String::from_utf8(self.0.lock().unwrap().clone()).unwrap()
        }
    }

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let mut disk = self.0.lock().unwrap();
            let takes = bytes.len().min(self.1 - disk.len());
            disk.extend(&bytes[..takes]);
            Ok(takes)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_log_that_is_closed_has_all_of_it() {
        let disk = Disk::new(1 << 20);
        let mut log = Log::start(Writer::new(io::BufWriter::new(disk.clone()), "can0")).unwrap();
        (0..1000).for_each(|_| log.write(SimTime::ZERO, &frame()));
        assert!(log.is_whole());
        log.close().unwrap();
        assert_eq!(disk.text(), LINE.repeat(1000));
    }

    #[test]
    fn a_log_keeps_its_first_fault_to_the_end_and_writes_nothing_behind_it() {
        let disk = Disk::new(LINE.len() + 3);
        let mut log = Log::start(Writer::new(disk.clone(), "can0")).unwrap();
        while log.is_whole() {
            log.write(SimTime::ZERO, &frame());
        }
        assert_eq!(log.close().unwrap_err().kind(), io::ErrorKind::WriteZero);
        assert_eq!(disk.text(), format!("{LINE}(0."));
    }

    /// A disk that takes nothing before it is told to.
    struct Stalled(Receiver<()>, Disk);

    impl Write for Stalled {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let _ = self.0.recv();
            self.1.write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_disk_that_stalls_holds_nobody_up_and_what_it_missed_is_said() {
        let (go, stalled): (Sender<()>, _) = std::sync::mpsc::channel();
        let disk = Disk::new(1 << 20);
        let writer = Writer::new(Stalled(stalled, disk.clone()), "can0");
        let mut log = Log::with_room(writer, 4).unwrap();
        let written = (0..100).take_while(|_| {
            log.write(SimTime::ZERO, &frame());
            log.is_whole()
        });
        assert!((4..=5).contains(&written.count()), "four wait, and one may be on its way");
        drop(go);
        log.write(SimTime::ZERO, &frame());
        assert_eq!(log.close().unwrap_err().kind(), io::ErrorKind::TimedOut);
        assert!(disk.text().lines().count() <= 5, "nothing behind what was lost");
    }
}
