//! The machine's other CAN wires: what was on each of them in the last tick (facts 2).

use xt28_dbc::{Frame, Outbox};

/// A CAN wire other than the bus that both ECUs sit on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Wire {
    /// Inertial unit and arm ECU (its `CAN_2`).
    Inertial,
    /// Left armrest and arm ECU (its `CAN_3`).
    LeftArmrest,
    /// Right armrest and drive ECU (its `CAN_2`).
    RightArmrest,
    /// Engine and drive ECU (its `CAN_3`).
    Engine,
    /// Display and both ECUs (`CAN_4`).
    Display,
}

impl Wire {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Inertial, Self::LeftArmrest, Self::RightArmrest, Self::Engine, Self::Display];
}

/// Frames of one tick, a box a wire. Keeps its memory, so that a tick allocates nothing.
#[derive(Debug, Default)]
pub(crate) struct Wires {
    boxes: [Outbox; Wire::ALL.len()],
}

impl Wires {
    pub(crate) fn clear(&mut self) {
        self.boxes.iter_mut().for_each(Outbox::clear);
    }

    pub(crate) fn extend(&mut self, wire: Wire, frames: &[Frame]) {
        let outbox = &mut self.boxes[wire as usize];
        frames.iter().for_each(|frame| outbox.push(*frame));
    }

    pub(crate) fn frames(&self, wire: Wire) -> &[Frame] {
        self.boxes[wire as usize].frames()
    }
}
