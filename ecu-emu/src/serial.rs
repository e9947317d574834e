//! The receiver's serial port, played on a pseudo-terminal.

use std::io;
use std::os::fd::OwnedFd;
use std::path::{Path, PathBuf};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{Mode, OFlags};
use rustix::io::Errno;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, QueueSelector, tcflush, tcgetattr, tcsetattr};

/// What a reader may tell the receiver between two fixes is taken in portions of this, at most so many.
const PORTION_BYTES: usize = 1024;
const PORTIONS_MAX: usize = 64;

/// A pseudo-terminal in raw mode; readers open its path.
///
/// A serial line keeps nothing for a reader that is not there. A pseudo-terminal keeps some 18 kB, ten seconds
/// of fixes, and the oldest: read as they come in, they would be a place where the machine no longer is.
#[derive(Debug)]
pub(crate) struct Serial {
    port: OwnedFd,
    path: PathBuf,
    link: Option<PathBuf>,
    /// Something was written since the line was last emptied.
    written: bool,
}

impl Serial {
    /// Opens a pseudo-terminal and, if asked, links it to `link`. An error of the link names it.
    pub(crate) fn open(link: Option<&Path>) -> io::Result<Self> {
        let port = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        grantpt(&port)?;
        unlockpt(&port)?;
        let name = ptsname(&port, Vec::new())?;
        let path = PathBuf::from(name.to_string_lossy().into_owned());
        // Its modes last as long as the port. Closed again, the other end hangs up: so we know who listens.
        let terminal = open_terminal(&path)?;
        let mut modes = tcgetattr(&terminal)?;
        modes.make_raw();
        tcsetattr(&terminal, OptionalActions::Now, &modes)?;
        rustix::io::ioctl_fionbio(&port, true)?;
        if let Some(link) = link {
            make_way(link).and_then(|()| std::os::unix::fs::symlink(&path, link)).map_err(
                |error| {
                    let problem = format!("--gnss-link {}: {error}", link.display());
                    io::Error::new(error.kind(), problem)
                },
            )?;
        }
        Ok(Self { port, path, link: link.map(Path::to_owned), written: false })
    }

    /// Where readers find it.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Sends bytes as a serial line does: what no one reads in time is lost. What a reader told the receiver
    /// meanwhile is taken and not heeded; left there, it would block the reader in the end.
    pub(crate) fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.take_what_was_told();
        if !self.is_read()? {
            return self.forget();
        }
        match rustix::io::write(&self.port, bytes) {
            Ok(_) => self.written = true,
            Err(Errno::AGAIN) => {}
            Err(error) => return Err(error.into()),
        }
        Ok(())
    }

    /// Whether somebody has the other end open.
    fn is_read(&self) -> io::Result<bool> {
        let mut ports = [PollFd::new(&self.port, PollFlags::empty())];
        match poll(&mut ports, Some(&Timespec::default())) {
            Ok(_) => Ok(!ports[0].revents().contains(PollFlags::HUP)),
            Err(Errno::INTR) => Ok(true),
            Err(error) => Err(error.into()),
        }
    }

    /// Throws away what the last reader left unread.
    fn forget(&mut self) -> io::Result<()> {
        if core::mem::take(&mut self.written) {
            tcflush(open_terminal(&self.path)?, QueueSelector::IFlush)?;
        }
        Ok(())
    }

    fn take_what_was_told(&self) {
        let mut portion = [0; PORTION_BYTES];
        for _ in 0..PORTIONS_MAX {
            // Nobody there is an error too, and as good as silence.
            if !rustix::io::read(&self.port, &mut portion).is_ok_and(|length| length > 0) {
                return;
            }
        }
    }
}

/// The other end, as a reader opens it.
fn open_terminal(path: &Path) -> rustix::io::Result<OwnedFd> {
    let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
    rustix::fs::open(path, flags, Mode::empty())
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
            "something is there that is no link; give another path",
        )),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use rustix::termios::LocalModes;

    use super::*;

    /// All that is there to be read.
    fn read(reader: &OwnedFd) -> Vec<u8> {
        // The kernel hands bytes over in its own time.
        let waits = |ms: i64| {
            let wait = Timespec { tv_sec: 0, tv_nsec: ms * 1_000_000 };
            poll(&mut [PollFd::new(reader, PollFlags::IN)], Some(&wait)).unwrap() > 0
        };
        let mut all = Vec::new();
        while waits(if all.is_empty() { 900 } else { 20 }) {
            let mut bytes = [0; 4096];
            let length = rustix::io::read(reader, &mut bytes).unwrap();
            all.extend_from_slice(&bytes[..length]);
        }
        all
    }

    #[test]
    fn a_reader_that_comes_late_hears_nothing_of_before() {
        let mut serial = Serial::open(None).unwrap();
        (0..200).for_each(|_| serial.send(b"long ago").unwrap());
        let reader = open_terminal(serial.path()).unwrap();
        serial.send(b"now").unwrap();
        assert_eq!(read(&reader), b"now");
        assert!(!tcgetattr(&reader).unwrap().local_modes.contains(LocalModes::ICANON), "raw");
    }

    #[test]
    fn what_one_reader_leaves_the_next_one_does_not_get() {
        let mut serial = Serial::open(None).unwrap();
        let reader = open_terminal(serial.path()).unwrap();
        serial.send(b"read").unwrap();
        assert_eq!(read(&reader), b"read");
        serial.send(b"left").unwrap();
        drop(reader);
        serial.send(b"to nobody").unwrap();
        let reader = open_terminal(serial.path()).unwrap();
        serial.send(b"now").unwrap();
        assert_eq!(read(&reader), b"now");
    }

    /// A driver sets up the receiver that it opens, and asks it again and again.
    #[test]
    fn a_reader_may_talk_to_the_receiver_for_as_long_as_it_likes() {
        let mut serial = Serial::open(None).unwrap();
        let reader = open_terminal(serial.path()).unwrap();
        for second in 0..40 {
            let told = rustix::io::write(&reader, &[0xB5; 1000]);
            assert_eq!(told, Ok(1000), "second {second}");
            serial.send(b"fix").unwrap();
        }
        assert_eq!(read(&reader), b"fix".repeat(40));
    }

    #[test]
    fn a_link_replaces_a_link_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("gnss");
        std::fs::write(&link, "a file of mine").unwrap();
        let refused = Serial::open(Some(&link)).unwrap_err().to_string();
        assert!(refused.contains("gnss: something is there that is no link"), "{refused}");
        let astray = Serial::open(Some(&folder.path().join("no/gnss"))).unwrap_err().to_string();
        assert!(astray.starts_with("--gnss-link ") && astray.contains("no/gnss: "), "{astray}");
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
