//! The receiver's serial port, or a pty that stands for one: raw bytes, never blocking.

use std::io;
use std::os::fd::OwnedFd;
use std::path::Path;

use rustix::fs::{Mode, OFlags};
use rustix::io::Errno;
use rustix::termios::{OptionalActions, isatty, tcgetattr, tcsetattr};

/// A ZED-F9P talks at any rate over USB; this is for a real UART (assumed).
const BAUD: u32 = 460_800;

/// An open port.
#[derive(Debug)]
pub(crate) struct SerialPort {
    fd: OwnedFd,
    /// The other end hung up; said once, the safety kernel notices the silence.
    gone: bool,
}

impl SerialPort {
    pub(crate) fn open(path: &Path) -> io::Result<Self> {
        let flags = OFlags::RDONLY | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
        let fd = rustix::fs::open(path, flags, Mode::empty())?;
        if isatty(&fd) {
            let mut settings = tcgetattr(&fd)?;
            settings.make_raw();
            settings.set_speed(BAUD)?;
            tcsetattr(&fd, OptionalActions::Now, &settings)?;
        }
        Ok(Self { fd, gone: false })
    }

    /// Hands over what has come in, in portions of `buffer`. True when the port was lost just now.
    pub(crate) fn drain(
        &mut self,
        buffer: &mut [u8],
        mut take: impl FnMut(&[u8]),
    ) -> io::Result<bool> {
        while !self.gone {
            match rustix::io::read(&self.fd, &mut *buffer) {
                // A fifo or pty without writer; one may come yet.
                Ok(0) | Err(Errno::AGAIN) => break,
                Ok(length) => take(&buffer[..length]),
                Err(Errno::INTR) => {}
                // What a pty says when its other end closed, and a USB port when it was unplugged.
                Err(Errno::IO | Errno::NODEV | Errno::NXIO) => {
                    self.gone = true;
                    return Ok(true);
                }
                Err(errno) => return Err(errno.into()),
            }
        }
        Ok(false)
    }
}
