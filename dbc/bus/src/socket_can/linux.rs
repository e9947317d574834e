//! The open interface: sends without blocking, receives with the kernel's time stamps.

use core::time::Duration;
use std::collections::VecDeque;
use std::io;
use std::os::fd::{AsFd, BorrowedFd};
use std::time::SystemTime;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;
use socket2::SockRef;
use socketcan::{CanDataFrame, CanFrame, CanSocket, EmbeddedFrame, Socket, SocketOptions};
use xt28_dbc::Frame;
use xt28_machine::SimTime;

use super::error_frame::reported_state;
use super::{BACKLOG_FRAMES, OpenError, SocketCounters, SocketError, open};
use crate::embedded::{from_embedded_id, to_embedded_id};
use crate::{Bus, BusState, Received};

/// How long to wait at most before frames in the backlog are tried again.
const RETRY_AFTER: Duration = Duration::from_millis(1);

/// A CAN interface of the Linux kernel. See the [module](super) for bus-off and time.
///
/// ```no_run
/// use core::time::Duration;
/// use std::time::SystemTime;
///
/// use xt28_bus::{Bus, SocketCan};
///
/// fn listen(start: SystemTime) -> Result<(), Box<dyn std::error::Error>> {
///     let mut bus = SocketCan::open("vcan0")?.starting_at(start);
///     while bus.wait(Duration::from_millis(100))? {
///         while let Some(received) = bus.receive()? {
///             // received.at, received.frame
///         }
///     }
///     Ok(())
/// }
/// ```
#[derive(Debug)]
pub struct SocketCan {
    socket: CanSocket,
    interface: String,
    zero: SystemTime,
    /// What the kernel would not take yet, oldest first.
    backlog: VecDeque<Frame>,
    state: BusState,
    /// The controller was bus-off since somebody last asked.
    was_off: bool,
    counters: SocketCounters,
}

impl SocketCan {
    /// Opens an interface by name. Its state counts as error active until an error frame says
    /// otherwise.
    ///
    /// # Errors
    /// Names the interface, the reason and the remedy in one line.
    pub fn open(interface: &str) -> Result<Self, OpenError> {
        Ok(Self {
            socket: open::open(interface)?,
            interface: interface.to_owned(),
            zero: SystemTime::UNIX_EPOCH,
            backlog: VecDeque::with_capacity(BACKLOG_FRAMES),
            state: BusState::ErrorActive,
            was_off: false,
            counters: SocketCounters::default(),
        })
    }

    /// Sets the wall-clock time that is zero in the times of received frames: the run's start.
    /// 1970 unless set. What was received before it is at zero.
    #[must_use]
    pub fn starting_at(mut self, zero: SystemTime) -> Self {
        self.zero = zero;
        self
    }

    /// Sets the priority of its frames in the interface's queues (`SO_PRIORITY` of socket(7)): 0 unless set, 6 at most
    /// without a privilege. What queues make of it is told them by tc(8).
    ///
    /// # Errors
    /// What the kernel says, as to a higher one.
    pub fn with_priority(self, priority: u32) -> io::Result<Self> {
        SockRef::from(&self.socket).set_priority(priority)?;
        Ok(self)
    }

    /// The interface's name.
    #[must_use]
    pub fn interface(&self) -> &str {
        &self.interface
    }

    /// What was counted since opening.
    #[must_use]
    pub fn counters(&self) -> SocketCounters {
        self.counters
    }

    /// Whether the controller is bus-off, or was since the last call: one that restarts soon is well again before
    /// anybody asks for its state, and has lost frames all the same.
    pub fn take_bus_off(&mut self) -> bool {
        core::mem::replace(&mut self.was_off, self.state == BusState::BusOff)
    }

    /// Frames that wait because the kernel's transmit queue is full.
    #[must_use]
    pub fn backlog(&self) -> usize {
        self.backlog.len()
    }

    /// Throws the waiting frames away, and counts them; says how many they were.
    pub fn discard_backlog(&mut self) -> usize {
        let frames = self.backlog.len();
        self.counters.discarded += frames as u64;
        self.backlog.clear();
        frames
    }

    /// Frames the kernel dropped because they were not received in time; `None` where it does
    /// not say.
    #[must_use]
    pub fn receive_drops(&self) -> Option<u32> {
        // asm-generic/socket.h; a few old architectures number these differently.
        const SOL_SOCKET: i32 = 1;
        const SO_MEMINFO: i32 = 55;
        const DROPS: usize = 8;
        let mut info = [0; 4 * (DROPS + 1)];
        let len = self.socket.get_socket_option_bytes(SOL_SOCKET, SO_MEMINFO, &mut info).ok()?;
        let drops = info.get(..len)?.chunks_exact(4).nth(DROPS)?;
        Some(u32::from_ne_bytes(drops.try_into().ok()?))
    }

    /// Waits until there is something to receive or `timeout` is over; true if there is. Frames
    /// in the backlog are tried again meanwhile. May come back early with false when a signal
    /// arrives.
    ///
    /// # Errors
    /// The interface is down or gone.
    pub fn wait(&mut self, timeout: Duration) -> Result<bool, SocketError> {
        let mut left = timeout;
        loop {
            self.flush()?;
            let slice = if self.backlog.is_empty() { left } else { left.min(RETRY_AFTER) };
            let spec =
                Timespec::try_from(slice).unwrap_or(Timespec { tv_sec: i64::MAX, tv_nsec: 0 });
            let mut sockets = [PollFd::new(&self.socket, PollFlags::IN)];
            match poll(&mut sockets, Some(&spec)) {
                Ok(0) => {}
                // An error of the socket counts as something: receiving says what.
                Ok(_) => return Ok(true),
                Err(Errno::INTR) => return Ok(false),
                Err(errno) => return Err(self.error("wait", errno.into())),
            }
            left = left.saturating_sub(slice);
            if left.is_zero() {
                return Ok(false);
            }
        }
    }

    /// Hands waiting frames to the kernel, as many as it takes.
    ///
    /// # Errors
    /// The interface is down or gone.
    pub fn flush(&mut self) -> Result<(), SocketError> {
        while let Some(frame) = self.backlog.front() {
            if !self.write(&frame.clone())? {
                break;
            }
            self.backlog.pop_front();
        }
        Ok(())
    }

    /// Offers one frame to the kernel; false if its queue is full.
    fn write(&mut self, frame: &Frame) -> Result<bool, SocketError> {
        let Some(raw) =
            to_embedded_id(frame.id()).and_then(|id| CanDataFrame::new(id, frame.data()))
        else {
            let error = io::Error::new(io::ErrorKind::InvalidInput, "identifier out of range");
            return Err(self.error("send", error));
        };
        let Err(error) = self.socket.write_frame(&raw) else {
            self.counters.sent += 1;
            return Ok(true);
        };
        match Errno::from_io_error(&error) {
            Some(Errno::NOBUFS | Errno::AGAIN) => {
                self.counters.queue_full += 1;
                Ok(false)
            }
            _ => Err(self.error("send", error)),
        }
    }

    /// The next frame of any kind, with the kernel's time.
    fn read(&mut self) -> Result<Option<(CanFrame, SystemTime)>, SocketError> {
        loop {
            let error = match self.socket.read_frame_with_timestamp() {
                Ok(read) => return Ok(Some(read)),
                Err(error) => error,
            };
            match Errno::from_io_error(&error) {
                Some(Errno::AGAIN) => return Ok(None),
                Some(Errno::INTR) => {}
                _ => return Err(self.error("receive", error)),
            }
        }
    }

    fn enter(&mut self, state: BusState) {
        self.state = state;
        if state == BusState::BusOff {
            self.was_off = true;
            self.discard_backlog();
        }
    }

    fn error(&self, doing: &'static str, source: io::Error) -> SocketError {
        let interface = self.interface.clone();
        match Errno::from_io_error(&source) {
            Some(Errno::NETDOWN) => SocketError::Down { interface },
            Some(Errno::NODEV | Errno::NXIO) => SocketError::Gone { interface },
            _ => SocketError::Io { interface, doing, source },
        }
    }
}

impl Bus for SocketCan {
    type Error = SocketError;

    /// Hands the frame to the kernel, or keeps it in order where the kernel's queue is full. While the
    /// controller is known to be bus-off it is thrown away: the kernel would send it after the restart.
    fn send(&mut self, _: SimTime, frame: &Frame) -> Result<(), SocketError> {
        if self.state == BusState::BusOff {
            self.counters.discarded += 1;
            return Ok(());
        }
        self.flush()?;
        if self.backlog.is_empty() && self.write(frame)? {
            return Ok(());
        }
        if self.backlog.len() >= BACKLOG_FRAMES {
            self.counters.refused += 1;
            let (interface, frames) = (self.interface.clone(), self.backlog.len());
            return Err(SocketError::BacklogFull { interface, frames });
        }
        self.backlog.push_back(*frame);
        Ok(())
    }

    /// The next data frame. Call it until it gives none: the socket's buffer is finite.
    fn receive(&mut self) -> Result<Option<Received>, SocketError> {
        while let Some((frame, stamp)) = self.read()? {
            match frame {
                CanFrame::Data(data) => {
                    self.counters.received += 1;
                    if self.state == BusState::BusOff {
                        // A controller that receives has been restarted, reported or not.
                        self.enter(BusState::ErrorActive);
                    }
                    let id = from_embedded_id(data.id());
                    let Some(frame) = Frame::new(id, data.data()) else {
                        continue;
                    };
                    let since_start = stamp.duration_since(self.zero).unwrap_or_default();
                    return Ok(Some(Received { at: SimTime::ZERO + since_start, frame }));
                }
                CanFrame::Remote(_) => self.counters.remote += 1,
                CanFrame::Error(error) => {
                    self.counters.error += 1;
                    if let Some(state) = reported_state(error) {
                        self.enter(state);
                    }
                }
            }
        }
        Ok(None)
    }

    fn state(&self) -> BusState {
        self.state
    }
}

impl AsFd for SocketCan {
    /// For waiting on several things at once.
    fn as_fd(&self) -> BorrowedFd<'_> {
        self.socket.as_fd()
    }
}

#[cfg(test)]
mod tests;
