//! Wheel names and the one order everything per-wheel is in: FR FL MR ML BR BL (facts 1.1).

use core::fmt;
use core::ops::{Index, IndexMut};

/// A wheel, its arm and its cylinder. Front, middle, back; right before left.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Wheel {
    /// Front right.
    Fr,
    /// Front left.
    Fl,
    /// Middle right.
    Mr,
    /// Middle left.
    Ml,
    /// Back right.
    Br,
    /// Back left.
    Bl,
}

/// One of the three frames, each with one pair of wheels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Axle {
    /// Cab and engine.
    Front,
    /// The frame between the two articulation joints.
    Middle,
    /// The bunk.
    Rear,
}

/// Right or left of the machine, looking forward.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// y < 0.
    Right,
    /// y > 0.
    Left,
}

impl Wheel {
    /// All six, in wire order.
    pub const ALL: [Self; 6] = [Self::Fr, Self::Fl, Self::Mr, Self::Ml, Self::Br, Self::Bl];

    /// Position in the wire order, 0 to 5.
    #[must_use]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The frame it hangs on.
    #[must_use]
    pub const fn axle(self) -> Axle {
        match self {
            Self::Fr | Self::Fl => Axle::Front,
            Self::Mr | Self::Ml => Axle::Middle,
            Self::Br | Self::Bl => Axle::Rear,
        }
    }

    /// The side it is on.
    #[must_use]
    pub const fn side(self) -> Side {
        match self {
            Self::Fr | Self::Mr | Self::Br => Side::Right,
            Self::Fl | Self::Ml | Self::Bl => Side::Left,
        }
    }

    /// "FR" to "BL", as on the wire.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Fr => "FR",
            Self::Fl => "FL",
            Self::Mr => "MR",
            Self::Ml => "ML",
            Self::Br => "BR",
            Self::Bl => "BL",
        }
    }

    /// The wheel of that name, `None` for any other text.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|wheel| wheel.name() == name)
    }
}

impl fmt::Display for Wheel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Side {
    /// -1 on the right, +1 on the left: the sign of y.
    #[must_use]
    pub const fn sign(self) -> f64 {
        match self {
            Self::Right => -1.0,
            Self::Left => 1.0,
        }
    }
}

/// One value a wheel, indexed by [`Wheel`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PerWheel<T>(pub [T; 6]);

impl<T> PerWheel<T> {
    /// A value from each wheel, in wire order.
    pub fn from_fn(mut value: impl FnMut(Wheel) -> T) -> Self {
        Self(Wheel::ALL.map(&mut value))
    }

    /// Each value turned into another.
    pub fn map<U>(self, f: impl FnMut(T) -> U) -> PerWheel<U> {
        PerWheel(self.0.map(f))
    }

    /// Wheels with their values, in wire order.
    pub fn iter(&self) -> impl Iterator<Item = (Wheel, &T)> {
        Wheel::ALL.into_iter().zip(&self.0)
    }
}

impl PerWheel<f64> {
    /// Sum over the wheels.
    #[must_use]
    pub fn sum(&self) -> f64 {
        self.0.iter().sum()
    }

    /// Mean over the wheels.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.sum() / 6.0
    }
}

impl<T: Copy> PerWheel<T> {
    /// The same value at every wheel.
    pub const fn splat(value: T) -> Self {
        Self([value; 6])
    }
}

impl<T> Index<Wheel> for PerWheel<T> {
    type Output = T;

    fn index(&self, wheel: Wheel) -> &T {
        &self.0[wheel.index()]
    }
}

impl<T> IndexMut<Wheel> for PerWheel<T> {
    fn index_mut(&mut self, wheel: Wheel) -> &mut T {
        &mut self.0[wheel.index()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_is_right_before_left_front_to_back() {
        let names: Vec<_> = Wheel::ALL.iter().map(|w| w.name()).collect();
        assert_eq!(names, ["FR", "FL", "MR", "ML", "BR", "BL"]);
        for wheel in Wheel::ALL {
            assert_eq!(Wheel::from_name(wheel.name()), Some(wheel));
            assert_eq!(wheel.side() == Side::Right, wheel.index() % 2 == 0);
        }
    }
}
