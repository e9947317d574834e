//! What is believed beside the tolerances: the base that stands, and what is tried beside it.

use xt28_sim::Effects;

use super::onset::Onset;

/// What is believed already, and from when on; what was before is not looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct Base {
    /// The effects.
    pub effects: Effects,
    /// Since when.
    pub since: Onset,
}

impl From<Effects> for Base {
    fn from(effects: Effects) -> Self {
        Self { effects, since: Onset::ALWAYS }
    }
}

/// Something to believe, and from when on.
#[derive(Clone, Copy, Debug)]
pub struct Belief<'e> {
    /// The effects.
    pub effects: &'e Effects,
    /// Before it the base holds.
    pub onset: Onset,
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

/// Something that effects decide, over one run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scheduled<T> {
    /// What a sound machine has before the base sets in, what the base has, and what the belief has.
    sound: T,
    before: T,
    is: T,
    since_s: f64,
    from_s: f64,
}

impl EffectSchedule<'_> {
    /// The schedule as it was until the last of its effects set in; none where they always were there.
    pub(super) fn earlier(&self) -> Option<Self> {
        let before = Self { from_s: 0.0, effects: self.before, ..*self };
        (self.from_s > 0.0).then_some(before)
    }

    /// What `of` makes of the effects that hold when.
    pub(super) fn of<T>(&self, of: impl Fn(&Effects) -> T) -> Scheduled<T> {
        let (sound, before, is) = (of(&Effects::default()), of(self.before), of(self.effects));
        Scheduled { sound, before, is, since_s: self.since_s, from_s: self.from_s }
    }
}

impl<T> Scheduled<T> {
    /// At an instant of the run, s.
    pub(super) fn at(&self, at_s: f64) -> &T {
        match at_s.max(0.0) {
            at_s if at_s < self.since_s => &self.sound,
            at_s if at_s < self.from_s => &self.before,
            _ => &self.is,
        }
    }
}

impl<'e> From<&'e Effects> for EffectSchedule<'e> {
    fn from(effects: &'e Effects) -> Self {
        Self { before: effects, from_s: 0.0, effects, since_s: 0.0 }
    }
}

impl<'e> From<&'e Effects> for Belief<'e> {
    fn from(effects: &'e Effects) -> Self {
        Self { effects, onset: Onset::ALWAYS }
    }
}
