//! A stream that gives so much at a time and then says that it would block.
//!
//! What is read from a socket has no end of its own: a message of frames without bytes goes on for as long as its
//! sender likes, and whoever reads it to its end has time for nobody else.

use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What may still be read this time, bytes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ration(Arc<AtomicUsize>);

impl Ration {
    /// Allows so much from now on.
    pub(crate) fn refill(&self, bytes: usize) {
        self.0.store(bytes, Ordering::Relaxed);
    }

    fn spend(&self, bytes: usize) {
        self.0.fetch_sub(bytes, Ordering::Relaxed);
    }

    /// Whether nothing is left.
    pub(crate) fn is_used_up(&self) -> bool {
        self.0.load(Ordering::Relaxed) == 0
    }
}

/// The stream.
#[derive(Debug)]
pub(crate) struct Rationed {
    stream: TcpStream,
    ration: Ration,
}

impl Rationed {
    pub(crate) const fn new(stream: TcpStream, ration: Ration) -> Self {
        Self { stream, ration }
    }
}

impl Read for Rationed {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = self.ration.0.load(Ordering::Relaxed);
        if left == 0 {
            return Err(ErrorKind::WouldBlock.into());
        }
        let most = left.min(buffer.len());
        let read = self.stream.read(&mut buffer[..most])?;
        self.ration.spend(read);
        Ok(read)
    }
}

impl Write for Rationed {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}
