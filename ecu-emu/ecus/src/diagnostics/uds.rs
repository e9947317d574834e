//! UDS (ISO 14229-1): sessions, data by identifier, trouble codes.
//!
//! Sans-IO and total: any bytes get a response that the standard allows, or none where it says so.

pub mod identifier;
mod reply;
mod trouble;

use core::time::Duration;

use xt28_machine::SimTime;

pub(crate) use self::identifier::{Identity, Readings};
pub(crate) use self::reply::{REPLY_MAX, Reply};
use super::fault_memory::FaultMemory;

/// A session other than the default one ends after this long without a request (S3).
pub const SESSION_TIMEOUT: Duration = Duration::from_secs(5);
/// A response comes within this (P2).
pub const RESPONSE_MAX: Duration = Duration::from_millis(50);
/// The same once more time was asked for (P2*). It never is.
pub const RESPONSE_EXTENDED_MAX: Duration = Duration::from_secs(5);
/// Identifiers that one request may ask for.
pub const IDENTIFIERS_MAX: usize = 8;

const SESSION_CONTROL: u8 = 0x10;
const CLEAR: u8 = 0x14;
const READ_TROUBLE: u8 = 0x19;
const READ_DATA: u8 = 0x22;
const TESTER_PRESENT: u8 = 0x3E;
/// Services known here.
const SERVICES: [u8; 5] = [SESSION_CONTROL, CLEAR, READ_TROUBLE, READ_DATA, TESTER_PRESENT];

const NEGATIVE: u8 = 0x7F;
const POSITIVE: u8 = 0x40;
/// In a sub-function: do not answer if all is well.
const SUPPRESS: u8 = 0x80;

/// Why a request is refused (ISO 14229-1, annex A).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Refused {
    /// No such service.
    Service = 0x11,
    /// No such sub-function.
    SubFunction = 0x12,
    /// Too long or too short.
    Length = 0x13,
    /// The response would be too long.
    TooLong = 0x14,
    /// No such identifier or code, or not in this session.
    OutOfRange = 0x31,
}

/// To whom a request went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Addressing {
    /// This ECU.
    Physical,
    /// All that listen.
    Functional,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
enum Session {
    Default = 1,
    Extended = 3,
}

/// One ECU's server.
#[derive(Clone, Debug)]
pub(crate) struct Server {
    identity: Identity,
    session: Session,
    /// When the last request came.
    heard: SimTime,
}

impl Server {
    /// In the default session.
    pub(crate) const fn new(identity: Identity) -> Self {
        Self { identity, session: Session::Default, heard: SimTime::ZERO }
    }

    /// Ends a session that nobody keeps up.
    pub(crate) fn tick(&mut self, now: SimTime) {
        if now.since(self.heard) > SESSION_TIMEOUT {
            self.session = Session::Default;
        }
    }

    /// A session lasts while its tester is being answered.
    pub(crate) const fn keep_up(&mut self, now: SimTime) {
        self.heard = now;
    }

    /// Writes the response to `request` into `reply`; leaves it empty where there is to be none.
    pub(crate) fn respond<R: Readings>(
        &mut self,
        now: SimTime,
        request: &[u8],
        addressing: Addressing,
        (readings, memory): (&R, &mut FaultMemory),
        reply: &mut Reply,
    ) {
        self.tick(now);
        self.heard = now;
        reply.clear();
        let Some((&service, rest)) = request.split_first() else { return };
        let outcome = self.serve(service, rest, readings, memory, reply);
        let outcome = if reply.overflowed() { Err(Refused::TooLong) } else { outcome };
        let Err(why) = outcome else { return };
        reply.clear();
        // Who asks all does not want to hear from those it does not concern (7.5.5).
        let concerns_others =
            matches!(why, Refused::Service | Refused::SubFunction | Refused::OutOfRange);
        if addressing == Addressing::Physical || !concerns_others {
            reply.push(&[NEGATIVE, service, why as u8]);
        }
    }

    fn serve<R: Readings>(
        &mut self,
        service: u8,
        rest: &[u8],
        readings: &R,
        memory: &mut FaultMemory,
        reply: &mut Reply,
    ) -> Result<(), Refused> {
        if !SERVICES.contains(&service) {
            return Err(Refused::Service);
        }
        match service {
            CLEAR => {
                trouble::clear(rest, memory)?;
                reply.push(&[service | POSITIVE]);
                return Ok(());
            }
            READ_DATA => return self.read(rest, readings, reply),
            _ => {}
        }
        let (&sub, rest) = rest.split_first().ok_or(Refused::Length)?;
        let (sub, quiet) = (sub & !SUPPRESS, sub & SUPPRESS != 0);
        reply.push(&[service | POSITIVE, sub]);
        match service {
            SESSION_CONTROL => self.enter(sub, rest, reply)?,
            READ_TROUBLE => trouble::read(sub, rest, memory, reply)?,
            _ if sub != 0 => return Err(Refused::SubFunction),
            _ if !rest.is_empty() => return Err(Refused::Length),
            _ => {}
        }
        if quiet {
            reply.clear();
        }
        Ok(())
    }

    fn enter(&mut self, sub: u8, rest: &[u8], reply: &mut Reply) -> Result<(), Refused> {
        let session = match sub {
            1 => Session::Default,
            3 => Session::Extended,
            _ => return Err(Refused::SubFunction),
        };
        if !rest.is_empty() {
            return Err(Refused::Length);
        }
        self.session = session;
        // P2 in ms, P2* in 10 ms.
        let [p2, p2_extended] = [RESPONSE_MAX, RESPONSE_EXTENDED_MAX].map(|p| p.as_millis());
        #[allow(clippy::cast_possible_truncation)] // 50 and 500
        let timing = [p2 as u16, (p2_extended / 10) as u16].map(u16::to_be_bytes);
        reply.push(timing.as_flattened());
        Ok(())
    }

    fn read<R: Readings>(
        &self,
        rest: &[u8],
        readings: &R,
        reply: &mut Reply,
    ) -> Result<(), Refused> {
        let (dids, odd) = rest.as_chunks::<2>();
        if dids.is_empty() || !odd.is_empty() || dids.len() > IDENTIFIERS_MAX {
            return Err(Refused::Length);
        }
        reply.push(&[READ_DATA | POSITIVE]);
        let extended = self.session == Session::Extended;
        let mut any = false;
        for did in dids.iter().copied().map(u16::from_be_bytes) {
            let session = self.session as u8;
            any |= identifier::read(did, session, extended, &self.identity, readings, reply);
        }
        // Those that there are are answered, those that there are not left out (11.2.4).
        if any { Ok(()) } else { Err(Refused::OutOfRange) }
    }
}
