//! Lines on stderr that nobody waits for: where it is a pipe that nobody reads, the machine is driven all the same.

use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::JoinHandle;

/// Most lines that wait; those beyond are lost.
const LINES_MAX: usize = 64;

/// A thread that says what it is given.
#[derive(Debug)]
pub(crate) struct Talk {
    lines: SyncSender<String>,
    _thread: JoinHandle<()>,
}

impl Talk {
    /// Starts it.
    pub(crate) fn start() -> std::io::Result<Self> {
        let (lines, said) = sync_channel::<String>(LINES_MAX);
        let thread = std::thread::Builder::new().name("talk".to_owned());
        let _thread = thread.spawn(move || said.iter().for_each(|line| eprintln!("{line}")))?;
        Ok(Self { lines, _thread })
    }

    /// Says a line, now or soon.
    pub(crate) fn say(&self, line: String) {
        let _ = self.lines.try_send(line);
    }
}
