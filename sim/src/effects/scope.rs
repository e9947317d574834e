//! Which wheels an effect acts on: all, an axle, a side or one.

use core::fmt;
use core::str::FromStr;

use xt28_machine::{Axle, Side, Wheel};

/// A set of wheels with a name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Scope {
    /// Every wheel, or an effect that has no wheel.
    #[default]
    All,
    /// The two of an axle.
    Axle(Axle),
    /// The three of a side.
    Side(Side),
    /// One.
    Wheel(Wheel),
}

/// A name that is none of a scope's.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("\"{0}\" is no scope; write one of all front middle rear left right FR FL MR ML BR BL")]
pub struct UnknownScope(pub String);

impl Scope {
    /// Every scope there is, wide ones first.
    pub const ALL: [Self; 12] = [
        Self::All,
        Self::Axle(Axle::Front),
        Self::Axle(Axle::Middle),
        Self::Axle(Axle::Rear),
        Self::Side(Side::Left),
        Self::Side(Side::Right),
        Self::Wheel(Wheel::Fr),
        Self::Wheel(Wheel::Fl),
        Self::Wheel(Wheel::Mr),
        Self::Wheel(Wheel::Ml),
        Self::Wheel(Wheel::Br),
        Self::Wheel(Wheel::Bl),
    ];

    /// Whether `wheel` is one of them.
    #[must_use]
    pub fn contains(self, wheel: Wheel) -> bool {
        match self {
            Self::All => true,
            Self::Axle(axle) => wheel.axle() == axle,
            Self::Side(side) => wheel.side() == side,
            Self::Wheel(one) => wheel == one,
        }
    }

    /// Its wheels, in wire order; at least one.
    pub fn wheels(self) -> impl Iterator<Item = Wheel> {
        Wheel::ALL.into_iter().filter(move |&wheel| self.contains(wheel))
    }
}

impl fmt::Display for Scope {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::All => "all",
            Self::Axle(Axle::Front) => "front",
            Self::Axle(Axle::Middle) => "middle",
            Self::Axle(Axle::Rear) => "rear",
            Self::Side(Side::Left) => "left",
            Self::Side(Side::Right) => "right",
            Self::Wheel(Wheel::Fr) => "FR",
            Self::Wheel(Wheel::Fl) => "FL",
            Self::Wheel(Wheel::Mr) => "MR",
            Self::Wheel(Wheel::Ml) => "ML",
            Self::Wheel(Wheel::Br) => "BR",
            Self::Wheel(Wheel::Bl) => "BL",
        })
    }
}

impl FromStr for Scope {
    type Err = UnknownScope;

    fn from_str(name: &str) -> Result<Self, UnknownScope> {
        let known = Self::ALL.into_iter().find(|scope| scope.to_string() == name);
        known.ok_or_else(|| UnknownScope(name.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_reads_back() {
        for scope in Scope::ALL {
            assert_eq!(scope.to_string().parse(), Ok(scope));
        }
        assert!("centre".parse::<Scope>().unwrap_err().to_string().contains("FR FL"));
    }

    #[test]
    fn scopes_hold_six_two_three_and_one() {
        let sizes = Scope::ALL.map(|scope| scope.wheels().count());
        assert_eq!(sizes, [6, 2, 2, 2, 3, 3, 1, 1, 1, 1, 1, 1]);
    }
}
