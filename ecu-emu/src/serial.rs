//! The receiver's serial port, played on a pseudo-terminal.

use std::io;
use std::os::fd::OwnedFd;
use std::path::{Path, PathBuf};

use rustix::fs::{Mode, OFlags};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

/// A pseudo-terminal in raw mode; readers open its path.
#[derive(Debug)]
pub(crate) struct Serial {
    port: OwnedFd,
    /// Held open so that bytes wait for a reader that comes late instead of failing.
    _terminal: OwnedFd,
    path: PathBuf,
    link: Option<PathBuf>,
}

impl Serial {
    /// Opens a pseudo-terminal and, if asked, links it to `link`.
    pub(crate) fn open(link: Option<&Path>) -> io::Result<Self> {
        let port = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        grantpt(&port)?;
        unlockpt(&port)?;
        let name = ptsname(&port, Vec::new())?;
        let path = PathBuf::from(name.to_string_lossy().into_owned());
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC;
        let terminal = rustix::fs::open(&path, flags, Mode::empty())?;
        let mut modes = tcgetattr(&terminal)?;
        modes.make_raw();
        tcsetattr(&terminal, OptionalActions::Now, &modes)?;
        rustix::io::ioctl_fionbio(&port, true)?;
        if let Some(link) = link {
            match std::fs::remove_file(link) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
                _ => std::os::unix::fs::symlink(&path, link)?,
            }
        }
        Ok(Self { port, _terminal: terminal, path, link: link.map(Path::to_owned) })
    }

    /// Where readers find it.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Sends bytes as a serial line does: what no one reads in time is lost.
    pub(crate) fn send(&self, bytes: &[u8]) -> io::Result<()> {
        match rustix::io::write(&self.port, bytes) {
            Ok(_) | Err(rustix::io::Errno::AGAIN) => Ok(()),
            Err(error) => Err(error.into()),
        }
    }
}

impl Drop for Serial {
    fn drop(&mut self) {
        if let Some(link) = &self.link {
            let _ = std::fs::remove_file(link);
        }
    }
}
