//! Which of the six wheels, arms or cylinders a cause is on.

use std::fmt;

use xt28_machine::{Axle, Side, Wheel};

/// A group of wheels that tends to have a fault in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// Every wheel; also of a cause that has no wheel.
    All,
    /// Both wheels of an axle.
    Axle(Axle),
    /// The three wheels of a side.
    Side(Side),
    /// One wheel.
    One(Wheel),
}

impl Scope {
    /// Every scope there is.
    pub const EVERY: [Self; 12] = [
        Self::All,
        Self::Axle(Axle::Front),
        Self::Axle(Axle::Middle),
        Self::Axle(Axle::Rear),
        Self::Side(Side::Left),
        Self::Side(Side::Right),
        Self::One(Wheel::Fr),
        Self::One(Wheel::Fl),
        Self::One(Wheel::Mr),
        Self::One(Wheel::Ml),
        Self::One(Wheel::Br),
        Self::One(Wheel::Bl),
    ];

    /// Whether `wheel` is in it.
    #[must_use]
    pub fn holds(self, wheel: Wheel) -> bool {
        match self {
            Self::All => true,
            Self::Axle(axle) => wheel.axle() == axle,
            Self::Side(side) => wheel.side() == side,
            Self::One(one) => wheel == one,
        }
    }

    /// Its wheels, in wire order.
    pub fn wheels(self) -> impl Iterator<Item = Wheel> {
        Wheel::ALL.into_iter().filter(move |&wheel| self.holds(wheel))
    }

    /// Its name in an answer: `all`, `front`, ..., `left`, `right`, `FR`, ...
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Axle(Axle::Front) => "front",
            Self::Axle(Axle::Middle) => "middle",
            Self::Axle(Axle::Rear) => "rear",
            Self::Side(Side::Left) => "left",
            Self::Side(Side::Right) => "right",
            Self::One(wheel) => wheel.name(),
        }
    }
}

impl fmt::Display for Scope {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_differ_and_groups_have_their_wheels() {
        let names: std::collections::BTreeSet<_> = Scope::EVERY.iter().map(|s| s.name()).collect();
        assert_eq!(names.len(), 12);
        let sizes: Vec<usize> = Scope::EVERY.iter().map(|s| s.wheels().count()).collect();
        assert_eq!(sizes, [6, 2, 2, 2, 3, 3, 1, 1, 1, 1, 1, 1]);
        assert!(Scope::Side(Side::Left).holds(Wheel::Bl));
    }
}
