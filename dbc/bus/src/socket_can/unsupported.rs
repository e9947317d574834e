//! What stands for SocketCAN where there is none: it cannot be opened.

use core::convert::Infallible;
use core::time::Duration;
use std::time::SystemTime;

use xt28_dbc::Frame;
use xt28_machine::SimTime;

use super::{OpenError, OpenReason, SocketCounters, SocketError};
use crate::{Bus, BusState, Received};

/// A CAN interface of the Linux kernel; on this system there is none.
#[derive(Debug)]
pub struct SocketCan(Infallible);

impl SocketCan {
    /// Says that this system has no SocketCAN.
    ///
    /// # Errors
    /// Always.
    pub fn open(interface: &str) -> Result<Self, OpenError> {
        Err(OpenError { interface: interface.to_owned(), reason: OpenReason::NotLinux })
    }

    /// As on Linux.
    #[must_use]
    pub fn starting_at(self, _: SystemTime) -> Self {
        match self.0 {}
    }

    /// As on Linux.
    ///
    /// # Errors
    /// As on Linux.
    pub fn with_priority(self, _: u32) -> std::io::Result<Self> {
        match self.0 {}
    }

    /// As on Linux.
    #[must_use]
    pub fn interface(&self) -> &str {
        match self.0 {}
    }

    /// As on Linux.
    #[must_use]
    pub fn counters(&self) -> SocketCounters {
        match self.0 {}
    }

    /// As on Linux.
    pub fn take_bus_off(&mut self) -> bool {
        match self.0 {}
    }

    /// As on Linux.
    #[must_use]
    pub fn backlog(&self) -> usize {
        match self.0 {}
    }

    /// As on Linux.
    pub fn discard_backlog(&mut self) -> usize {
        match self.0 {}
    }

    /// As on Linux.
    ///
    /// # Errors
    /// As on Linux.
    pub fn flush(&mut self) -> Result<(), SocketError> {
        match self.0 {}
    }

    /// As on Linux.
    ///
    /// # Errors
    /// As on Linux.
    pub fn wait(&mut self, _: Duration) -> Result<bool, SocketError> {
        match self.0 {}
    }

    /// As on Linux.
    #[must_use]
    pub fn receive_drops(&self) -> Option<u32> {
        match self.0 {}
    }
}

impl Bus for SocketCan {
    type Error = SocketError;

    fn send(&mut self, _: SimTime, _: &Frame) -> Result<(), SocketError> {
        match self.0 {}
    }

    fn receive(&mut self) -> Result<Option<Received>, SocketError> {
        match self.0 {}
    }

    fn state(&self) -> BusState {
        match self.0 {}
    }
}
