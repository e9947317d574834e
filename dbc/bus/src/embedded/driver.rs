//! Somebody's `embedded-can` driver as a bus of ours.

use std::collections::{BTreeMap, VecDeque};

use embedded_can::nb::Can;
use embedded_can::{Error as _, ErrorKind, Frame as _};
use xt28_dbc::Frame;
use xt28_machine::SimTime;

use super::frame::{from_embedded_id, to_embedded_id};
use crate::{Bus, BusState, Received};

/// Frames that wait for a mailbox of the driver; beyond it sending is an error.
const BACKLOG_FRAMES: usize = 256;

/// Any [`embedded_can::nb::Can`] as a [`Bus`].
///
/// Errors of the driver are faults of the bus, so they are counted ([`Driver::faults`]); a frame
/// whose transmission fails is not tried again. A received frame is stamped with the time last
/// told ([`Driver::set_now`], or sending).
#[derive(Clone, Debug)]
pub struct Driver<C> {
    driver: C,
    now: SimTime,
    state: BusState,
    backlog: VecDeque<Frame>,
    faults: BTreeMap<ErrorKind, u64>,
    remote: u64,
}

/// A [`Driver`] could not take a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DriverError {
    /// The mailboxes are full and so is the backlog.
    #[error(
        "{frames} frames wait and none leaves; is another node on the bus at the same bit rate?"
    )]
    BacklogFull {
        /// How many frames wait.
        frames: usize,
    },
    /// No frame of theirs has this identifier.
    #[error("identifier {id} has more bits than its format; use 11 or 29")]
    Identifier {
        /// Which.
        id: xt28_dbc::CanId,
    },
}

impl<C: Can> Driver<C> {
    /// A bus on `driver`, at time zero, error active.
    pub fn new(driver: C) -> Self {
        Self {
            driver,
            now: SimTime::ZERO,
            state: BusState::default(),
            backlog: VecDeque::new(),
            faults: BTreeMap::new(),
            remote: 0,
        }
    }

    /// Sets the time of frames received from here on.
    pub fn set_now(&mut self, now: SimTime) {
        self.now = now;
    }

    /// Sets what [`Bus::state`] says, read from the controller by whoever knows it.
    pub fn set_state(&mut self, state: BusState) {
        self.state = state;
    }

    /// How often the driver reported which error.
    #[must_use]
    pub fn faults(&self) -> &BTreeMap<ErrorKind, u64> {
        &self.faults
    }

    /// Remote frames received, and passed over.
    #[must_use]
    pub fn remote(&self) -> u64 {
        self.remote
    }

    /// Frames that wait for a mailbox.
    #[must_use]
    pub fn backlog(&self) -> usize {
        self.backlog.len()
    }

    /// The driver below.
    pub fn driver(&mut self) -> &mut C {
        &mut self.driver
    }

    /// Offers waiting frames to the driver, as many as it takes.
    pub fn flush(&mut self) {
        // A driver may hand back a frame for each it takes: go round once, then it is enough.
        for _ in 0..self.backlog.len() {
            let Some(frame) = self.backlog.pop_front() else {
                return;
            };
            let theirs = to_embedded_id(frame.id()).and_then(|id| C::Frame::new(id, frame.data()));
            let Some(theirs) = theirs else {
                *self.faults.entry(ErrorKind::Other).or_default() += 1;
                continue;
            };
            match self.driver.transmit(&theirs) {
                Ok(None) => {}
                // It made room by taking a less urgent frame out: that one is next again.
                Ok(Some(replaced)) => {
                    if let Some(frame) = data_frame(&replaced) {
                        self.backlog.push_front(frame);
                    }
                }
                Err(nb::Error::WouldBlock) => {
                    self.backlog.push_front(frame);
                    return;
                }
                Err(nb::Error::Other(error)) => {
                    *self.faults.entry(error.kind()).or_default() += 1;
                }
            }
        }
    }
}

/// Their frame as ours, `None` for a remote frame.
fn data_frame(frame: &impl embedded_can::Frame) -> Option<Frame> {
    if frame.is_remote_frame() {
        return None;
    }
    Frame::new(from_embedded_id(frame.id()), frame.data())
}

impl<C: Can> Bus for Driver<C> {
    type Error = DriverError;

    fn send(&mut self, now: SimTime, frame: &Frame) -> Result<(), DriverError> {
        self.now = now;
        let id = frame.id();
        to_embedded_id(id).ok_or(DriverError::Identifier { id })?;
        self.flush();
        if self.backlog.len() >= BACKLOG_FRAMES {
            return Err(DriverError::BacklogFull { frames: self.backlog.len() });
        }
        self.backlog.push_back(*frame);
        self.flush();
        Ok(())
    }

    fn receive(&mut self) -> Result<Option<Received>, DriverError> {
        self.flush();
        loop {
            match self.driver.receive() {
                Ok(theirs) => match data_frame(&theirs) {
                    Some(frame) => {
                        return Ok(Some(Received { at: self.now, frame }));
                    }
                    None => self.remote += 1,
                },
                Err(nb::Error::WouldBlock) => return Ok(None),
                // One error a call, so that a driver that only fails does not hold us here.
                Err(nb::Error::Other(error)) => {
                    *self.faults.entry(error.kind()).or_default() += 1;
                    return Ok(None);
                }
            }
        }
    }

    fn state(&self) -> BusState {
        self.state
    }
}
