//! The machine's other CAN wires: what was on each of them in the last tick (facts 2).

use core::fmt;
use core::str::FromStr;

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

    /// As the command line names it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Inertial => "inertial",
            Self::LeftArmrest => "left-armrest",
            Self::RightArmrest => "right-armrest",
            Self::Engine => "engine",
            Self::Display => "display",
        }
    }
}

impl fmt::Display for Wire {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A name that is no wire's.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no wire {0:?}; give inertial, left-armrest, right-armrest, engine or display")]
pub struct UnknownWire(String);

impl FromStr for Wire {
    type Err = UnknownWire;

    fn from_str(name: &str) -> Result<Self, UnknownWire> {
        let named = |wire: &Self| wire.name() == name;
        Self::ALL.into_iter().find(named).ok_or_else(|| UnknownWire(name.to_owned()))
    }
}

/// Frames of one tick, a box a wire. Keeps its memory, so that a tick allocates nothing.
#[derive(Clone, Debug, Default)]
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_wire_is_found_by_its_name() {
        for wire in Wire::ALL {
            assert_eq!(wire.to_string().parse(), Ok(wire));
        }
        let error = "can3".parse::<Wire>().unwrap_err().to_string();
        assert!(error.starts_with("no wire \"can3\"; give inertial, "), "{error}");
    }
}
