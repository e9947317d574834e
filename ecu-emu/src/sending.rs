//! Frames out to an interface, and what becomes of them where none leaves.

use xt28_bus::socket_can::SocketError;
use xt28_bus::{Bus, SocketCan};
use xt28_dbc::Frame;
use xt28_machine::SimTime;

/// Gives frames to the interface; false where it took none, as nobody is there to acknowledge them yet. It loses them
/// then: the machine goes on, as its ECUs would.
pub(crate) fn send<'a>(
    bus: &mut SocketCan,
    now: SimTime,
    frames: impl IntoIterator<Item = &'a Frame>,
) -> Result<bool, SocketError> {
    let mut left = true;
    for frame in frames {
        match bus.send(now, frame) {
            Err(SocketError::BacklogFull { .. }) => {
                bus.discard_backlog();
                left = false;
            }
            sent => sent?,
        }
    }
    Ok(left)
}

/// What to say of such an interface.
pub(crate) fn no_frame_leaves(interface: &str) -> String {
    format!(
        "{interface}: no frame leaves, and those that wait are thrown away until one does; is another node on the bus, at \
         the same bit rate?"
    )
}
