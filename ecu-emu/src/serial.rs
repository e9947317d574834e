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
            make_way(link)?;
            std::os::unix::fs::symlink(&path, link)?;
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
        // Another emulator may have put its own link there meanwhile.
        if let Some(link) = &self.link
            && std::fs::read_link(link).is_ok_and(|target| target == self.path)
        {
            let _ = std::fs::remove_file(link);
        }
    }
}

/// Takes away a link that an earlier run left; anything else that is there stays.
fn make_way(link: &Path) -> io::Result<()> {
    match std::fs::symlink_metadata(link) {
        Ok(there) if there.is_symlink() => std::fs::remove_file(link),
        Ok(_) => Err(io::Error::new(
            io::ErrorKind::AlreadyExists,
            format!("{} is there and no link; give --gnss-link another path", link.display()),
        )),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_link_replaces_a_link_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("gnss");
        std::fs::write(&link, "a file of mine").unwrap();
        let refused = Serial::open(Some(&link)).unwrap_err().to_string();
        assert!(refused.contains("is there and no link"), "{refused}");
        assert_eq!(std::fs::read_to_string(&link).unwrap(), "a file of mine");
        std::fs::remove_file(&link).unwrap();
        let first = Serial::open(Some(&link)).unwrap();
        let second = Serial::open(Some(&link)).unwrap();
        drop(first);
        assert_eq!(std::fs::read_link(&link).unwrap(), second.path());
        drop(second);
        assert!(std::fs::symlink_metadata(&link).is_err());
    }
}
