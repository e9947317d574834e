//! Claiming an address and defending it (SAE J1939-81, 4.4), for a node with one fixed address.

use core::time::Duration;

use xt28_dbc::Frame;
use xt28_machine::SimTime;

use super::id::{GLOBAL, Id, NULL, pgn};
use super::name::Name;

/// Steps of 0.6 ms by which nodes without an address keep out of each other's way, 0 to 255.
const DELAY_STEP: Duration = Duration::from_micros(600);

/// Where a node stands with its address.
#[derive(Clone, Debug)]
pub(crate) struct AddressClaim {
    name: u64,
    address: u8,
    holds: bool,
    /// A claim, or the word that none can be made, is to leave then.
    due: Option<SimTime>,
}

impl AddressClaim {
    /// A node just switched on: its claim is the first thing it says.
    pub(crate) const fn new(name: &Name, address: u8) -> Self {
        Self { name: name.bits(), address, holds: true, due: Some(SimTime::ZERO) }
    }

    /// The address, while the node may use it. Below 128 it may at once (4.4.2.3): its rival, if
    /// any, will answer.
    pub(crate) const fn address(&self) -> Option<u8> {
        if self.holds { Some(self.address) } else { None }
    }

    /// Another node's claim, `name` as it came.
    pub(crate) fn on_claim(&mut self, now: SimTime, from: u8, name: [u8; 8]) {
        let name = u64::from_le_bytes(name);
        if from != self.address || !self.holds || name == self.name {
            // Our own NAME is our own frame come back; two units of one NAME no protocol can part.
            return;
        }
        if name < self.name {
            self.holds = false;
            self.due = Some(now + self.delay());
        } else {
            self.due = Some(now);
        }
    }

    /// Somebody asks who is there.
    pub(crate) fn on_request(&mut self, now: SimTime) {
        let at = if self.holds { now } else { now + self.delay() };
        self.due.get_or_insert(at);
    }

    /// The claim that is to leave now, or the word that none can be made.
    pub(crate) fn poll(&mut self, now: SimTime) -> Option<Frame> {
        self.due.take_if(|due| *due <= now)?;
        let from = if self.holds { self.address } else { NULL };
        let id = Id { priority: 6, pgn: pgn::ADDRESS_CLAIMED, to: GLOBAL, from };
        Frame::new(id.can(), &self.name.to_le_bytes())
    }

    /// Differs from unit to unit, and is the same in every run.
    fn delay(&self) -> Duration {
        let mixed =
            self.name.to_le_bytes().iter().fold(0_u8, |all, byte| all.rotate_left(3) ^ byte);
        DELAY_STEP * u32::from(mixed)
    }
}

#[cfg(test)]
mod tests {
    use xt28_dbc::CanId;

    use super::super::name;
    use super::*;

    const OURS: u64 = name::ARM.bits();

    fn claimed() -> AddressClaim {
        let mut claim = AddressClaim::new(&name::ARM, 0x28);
        let frame = claim.poll(SimTime::ZERO).unwrap();
        assert_eq!(frame.id(), CanId::Extended(0x18EE_FF28));
        assert_eq!(frame.data(), OURS.to_le_bytes());
        assert_eq!(claim.poll(SimTime::ZERO), None);
        claim
    }

    #[test]
    fn a_higher_name_is_answered_with_our_claim() {
        let mut claim = claimed();
        let now = SimTime::from_millis(50);
        claim.on_claim(now, 0x28, (OURS + 1).to_le_bytes());
        assert_eq!(claim.poll(now).unwrap().id(), CanId::Extended(0x18EE_FF28));
        assert_eq!(claim.address(), Some(0x28));
        claim.on_claim(now, 0x29, (OURS - 1).to_le_bytes());
        assert_eq!((claim.poll(now), claim.address()), (None, Some(0x28)), "another address");
        claim.on_claim(now, 0x28, OURS.to_le_bytes());
        assert_eq!((claim.poll(now), claim.address()), (None, Some(0x28)), "an echo");
    }

    #[test]
    fn a_lower_name_takes_the_address_for_good() {
        let mut claim = claimed();
        let now = SimTime::from_millis(50);
        claim.on_claim(now, 0x28, (OURS - 1).to_le_bytes());
        assert_eq!(claim.address(), None);
        let last = now + Duration::from_micros(153_000);
        assert_eq!(claim.poll(last).unwrap().id(), CanId::Extended(0x18EE_FFFE));
        claim.on_request(last);
        let answer = claim.poll(last + Duration::from_micros(153_000)).unwrap();
        assert_eq!(answer.id(), CanId::Extended(0x18EE_FFFE));
        claim.on_claim(last, 0x28, (OURS + 1).to_le_bytes());
        assert_eq!((claim.poll(SimTime::MAX), claim.address()), (None, None));
    }
}
