//! What is believed beside the tolerances: the base that stands, and what is tried beside it.

use xt28_sim::Effects;

/// What is believed already, and from when on in every run; what was before is not looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct Base {
    /// The effects.
    pub effects: Effects,
    /// Since when, s.
    pub since_s: f64,
}

impl From<Effects> for Base {
    fn from(effects: Effects) -> Self {
        Self { effects, since_s: 0.0 }
    }
}

/// Something to believe, and from when on in every run, s.
#[derive(Clone, Copy, Debug)]
pub struct Belief<'e> {
    /// The effects.
    pub effects: &'e Effects,
    /// Before this instant of every run the base holds.
    pub from_s: f64,
}

/// Which effects hold when in one run: a belief beside its base, `before` until `from_s` and `effects` after.
#[derive(Clone, Copy, Debug)]
pub(super) struct EffectSchedule<'e> {
    /// Effects before [`Self::from_s`].
    pub(super) before: &'e Effects,
    /// From when on the others hold, s.
    pub(super) from_s: f64,
    /// Effects from then on.
    pub(super) effects: &'e Effects,
    /// Nothing before this is looked at, as `before` set in here, s.
    pub(super) since_s: f64,
}

impl<'e> From<&'e Effects> for EffectSchedule<'e> {
    fn from(effects: &'e Effects) -> Self {
        Self { before: effects, from_s: 0.0, effects, since_s: 0.0 }
    }
}

impl<'e> From<&'e Effects> for Belief<'e> {
    fn from(effects: &'e Effects) -> Self {
        Self { effects, from_s: 0.0 }
    }
}
