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
    is_terminal: bool,
    /// The other end hung up; said once, the safety kernel notices the silence.
    gone: bool,
}

impl SerialPort {
    pub(crate) fn open(path: &Path) -> io::Result<Self> {
        let flags = OFlags::RDONLY | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
        let fd = rustix::fs::open(path, flags, Mode::empty())?;
        let is_terminal = isatty(&fd);
        if is_terminal {
            let mut settings = tcgetattr(&fd)?;
            settings.make_raw();
            settings.set_speed(BAUD)?;
            tcsetattr(&fd, OptionalActions::Now, &settings)?;
        }
        Ok(Self { fd, is_terminal, gone: false })
    }

    /// Hands over what has come in, in portions of `buffer`. True when the port was lost just now.
    pub(crate) fn drain(
        &mut self,
        buffer: &mut [u8],
        mut take: impl FnMut(&[u8]),
    ) -> io::Result<bool> {
        while !self.gone {
            match rustix::io::read(&self.fd, &mut *buffer) {
                // A fifo without writer; one may come yet. A terminal says so once it was hung up: a pty whose
                // other end closed, a USB port that was unplugged.
                Ok(0) if !self.is_terminal => break,
                Err(Errno::AGAIN) => break,
                Ok(0) | Err(Errno::IO | Errno::NODEV | Errno::NXIO) => {
                    self.gone = true;
                    return Ok(true);
                }
                Ok(length) => take(&buffer[..length]),
                Err(Errno::INTR) => {}
                Err(errno) => return Err(errno.into()),
            }
        }
        Ok(false)
    }
}

#[cfg(test)]
mod tests {
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};

    use super::*;

    /// What a drain takes, and whether the port was lost by it.
    fn drain(port: &mut SerialPort) -> (Vec<u8>, bool) {
        let mut taken = Vec::new();
        let lost = port.drain(&mut [0; 2], |bytes| taken.extend_from_slice(bytes)).unwrap();
        (taken, lost)
    }

    #[test]
    fn a_port_that_hangs_up_is_lost_once() {
        let receiver = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&receiver).unwrap();
        unlockpt(&receiver).unwrap();
        let path = ptsname(&receiver, Vec::new()).unwrap();
        let mut port = SerialPort::open(Path::new(path.to_str().unwrap())).unwrap();
        assert_eq!(drain(&mut port), (vec![], false), "silence");
        drop(receiver);
        assert_eq!([drain(&mut port), drain(&mut port)], [(vec![], true), (vec![], false)]);
    }

    #[test]
    fn a_file_at_its_end_is_not_lost() {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), [1, 2, 3]).unwrap();
        let mut port = SerialPort::open(file.path()).unwrap();
        assert_eq!([drain(&mut port), drain(&mut port)], [(vec![1, 2, 3], false), (vec![], false)]);
    }
}
