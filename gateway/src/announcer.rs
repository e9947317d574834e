//! Lines on stderr that nobody waits for: where it is a pipe that nobody reads, the machine is driven all the same.

use std::io::Write;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::Duration;

/// Most lines that wait; those beyond are lost.
const LINES_MAX: usize = 64;

/// Says a line at once, for where nothing drives. Whoever does not read it misses it.
pub(crate) fn announce(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// A thread that says what it is given.
#[derive(Debug)]
pub(crate) struct Announcer {
    lines: SyncSender<String>,
    /// Hangs up when all was said.
    said: Receiver<()>,
}

impl Announcer {
    /// Starts it.
    pub(crate) fn start() -> std::io::Result<Self> {
        let (lines, given) = sync_channel::<String>(LINES_MAX);
        let (done, said) = sync_channel(0);
        let speak = move || {
            for line in given {
                announce(&line);
            }
            drop(done);
        };
        std::thread::Builder::new().name("announcer".to_owned()).spawn(speak)?;
        Ok(Self { lines, said })
    }

    /// Says a line, now or soon.
    pub(crate) fn say(&self, line: String) {
        let _ = self.lines.try_send(line);
    }

    /// Waits until all was said, but not for ever.
    pub(crate) fn end(self, patience: Duration) {
        drop(self.lines);
        let _ = self.said.recv_timeout(patience);
    }
}
