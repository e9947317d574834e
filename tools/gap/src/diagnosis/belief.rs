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

impl<'e> EffectSchedule<'e> {
    /// The schedule as it was until the last of its effects set in, and when that was, s; none where they always were
    /// there. Before the base there is nothing but what is `sound`.
    pub(super) fn earlier(&self, sound: &'e Effects) -> Option<(Self, f64)> {
        let (before, until_s) = if self.from_s > self.since_s {
            (self.before, self.from_s)
        } else {
            (sound, self.since_s)
        };
        (until_s > 0.0).then_some((Self { from_s: 0.0, effects: before, ..*self }, until_s))
    }

    /// What `of` makes of the effects that hold when. Where the base changes nothing of it, the belief may before.
    pub(super) fn of<T: PartialEq>(&self, of: impl Fn(&Effects) -> T) -> Scheduled<T> {
        let (sound, before, is) = (of(&Effects::default()), of(self.before), of(self.effects));
        let since_s = if before == sound { 0.0 } else { self.since_s };
        Scheduled { sound, before, is, since_s, from_s: self.from_s }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_belief_is_there_before_a_base_that_is_about_something_else() {
        let (mut before, mut effects) = (Effects::default(), Effects::default());
        before.sensors.gnss_latency.delay_s = 0.2;
        effects.sensors.gnss_latency.delay_s = 0.2;
        effects.sensors.imu_offset.roll_rad = 0.1;
        let schedule =
            EffectSchedule { before: &before, from_s: 4.0, effects: &effects, since_s: 8.0 };
        let late_s = schedule.of(|effects| effects.sensors.gnss_latency.delay_s);
        let roll_rad = schedule.of(|effects| effects.sensors.imu_offset.roll_rad);
        let told = [3.0, 6.0, 9.0].map(|at_s| (*late_s.at(at_s), *roll_rad.at(at_s)));
        assert_eq!(told, [(0.0, 0.0), (0.0, 0.1), (0.2, 0.1)]);
    }
}
