//! Frames out.

use xt28_dbc::{EncodeError, Frame, Outbox};

/// Puts a frame in the outbox.
///
/// # Panics
/// On a value that its frame cannot say: the ECU bounds every reading to its frame, so one outside
/// is a defect here, and not to be sent as something else.
pub(crate) fn send(out: &mut Outbox, frame: &Result<Frame, EncodeError>) {
    match frame {
        Ok(frame) => out.push(*frame),
        Err(error) => panic!("a reading left its frame's range: {error}"),
    }
}
