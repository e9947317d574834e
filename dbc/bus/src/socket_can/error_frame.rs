//! What an error frame of the kernel says about the controller's state (linux/can/error.h).

use socketcan::CanErrorFrame;
use socketcan::errors::{ControllerProblems, ErrorCause};

use crate::BusState;

/// The state an error frame reports, `None` where it does not speak of it.
///
/// Warnings (a counter above 96) are within error active. Drivers report a state when it
/// changes; the counters are not used, as not all drivers send them.
pub(super) fn reported_state(frame: CanErrorFrame) -> Option<BusState> {
    let passive = ControllerProblems::RX_PASSIVE | ControllerProblems::TX_PASSIVE;
    let active = ControllerProblems::ACTIVE
        | ControllerProblems::RX_WARNING
        | ControllerProblems::TX_WARNING;
    let error = frame.into_error();
    let of = |cause: &ErrorCause| match cause {
        ErrorCause::BusOff => Some(BusState::BusOff),
        ErrorCause::Controller(flags) if flags.intersects(passive) => Some(BusState::ErrorPassive),
        ErrorCause::Controller(flags) if flags.intersects(active) => Some(BusState::ErrorActive),
        ErrorCause::Restarted => Some(BusState::ErrorActive),
        _ => None,
    };
    // One frame may report several: the worst holds.
    error.causes().filter_map(of).max()
}

#[cfg(test)]
mod tests {
    use super::*;

    // Classes and flags of linux/can/error.h.
    const CONTROLLER: u32 = 0x004;
    const NO_ACKNOWLEDGE: u32 = 0x020;
    const BUS_OFF: u32 = 0x040;
    const RESTARTED: u32 = 0x100;

    fn reported(class: u32, controller: u8) -> Option<BusState> {
        reported_state(CanErrorFrame::new_error(class, &[0, controller]).unwrap())
    }

    #[test]
    fn follows_a_controller_to_bus_off_and_back() {
        assert_eq!(reported(CONTROLLER, 0x08), Some(BusState::ErrorActive)); // transmit warning
        assert_eq!(reported(CONTROLLER, 0x20), Some(BusState::ErrorPassive)); // transmit passive
        assert_eq!(reported(CONTROLLER, 0x10), Some(BusState::ErrorPassive)); // receive passive
        assert_eq!(reported(BUS_OFF, 0), Some(BusState::BusOff));
        assert_eq!(reported(RESTARTED, 0), Some(BusState::ErrorActive));
        assert_eq!(reported(CONTROLLER, 0x40), Some(BusState::ErrorActive)); // recovered
    }

    #[test]
    fn an_error_without_a_state_changes_none() {
        assert_eq!(reported(NO_ACKNOWLEDGE, 0), None);
        assert_eq!(reported(CONTROLLER, 0x01), None); // receive buffer overflow
    }

    #[test]
    fn the_worst_of_several_holds() {
        assert_eq!(reported(CONTROLLER | BUS_OFF, 0x20), Some(BusState::BusOff));
    }
}
