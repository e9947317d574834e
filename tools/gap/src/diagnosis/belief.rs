//! What is believed beside the tolerances: the base that stands, and what is tried beside it.

use xt28_sim::Effects;

use super::onset::Onset;

/// What is believed already, and from when on.
#[derive(Clone, Debug, PartialEq)]
pub struct Base {
    /// The effects.
    pub effects: Effects,
    /// Since when.
    pub since: Onset,
    /// Effects until then.
    pub before: Effects,
}

/// Something to believe, and from when on.
#[derive(Clone, Copy, Debug)]
pub struct Belief<'e> {
    /// The effects, those of the base among them.
    pub effects: &'e Effects,
    /// The same where the base has not set in yet.
    pub before_base: &'e Effects,
    /// Before it there is nothing but the base.
    pub onset: Onset,
}

/// Something to believe, as effects of its own: with the base, and without it.
#[derive(Clone, Debug)]
pub(super) struct Supposed {
    pub(super) effects: Effects,
    before_base: Effects,
}

/// Which effects hold when in one run: a base sets in at one instant, and a belief beside it at another.
#[derive(Clone, Copy, Debug)]
pub(super) struct EffectSchedule<'e> {
    /// Effects before either.
    sound: &'e Effects,
    /// With the belief, and without the base.
    before_base: &'e Effects,
    /// With the base, and without the belief.
    before: &'e Effects,
    /// With both.
    pub(super) effects: &'e Effects,
    /// When the base sets in, s.
    since_s: f64,
    /// When the belief does, s.
    from_s: f64,
}

/// Something that effects decide, over one run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scheduled<T> {
    sound: T,
    before_base: T,
    before: T,
    is: T,
    since_s: f64,
    from_s: f64,
}

/// One of a schedule's instants.
#[derive(Clone, Copy, Debug)]
pub(super) struct Change<'e> {
    /// When, s.
    pub(super) at_s: f64,
    /// Effects until then, and from then on.
    pub(super) from_to: [&'e Effects; 2],
}

impl Base {
    /// What is believed with `change` made to it, whether the base has set in or not.
    pub(super) fn with(&self, change: impl Fn(&Effects) -> Effects) -> Supposed {
        Supposed { effects: change(&self.effects), before_base: change(&self.before) }
    }

    /// The base itself.
    pub(super) const fn belief(&self) -> Belief<'_> {
        Belief { effects: &self.effects, before_base: &self.before, onset: Onset::ALWAYS }
    }

    /// What holds in a run that began `began_s` s into the day with nothing else, `belief` beside it.
    pub(super) fn schedule<'e>(&'e self, belief: Belief<'e>, began_s: f64) -> EffectSchedule<'e> {
        EffectSchedule {
            sound: &self.before,
            before_base: belief.before_base,
            before: &self.effects,
            effects: belief.effects,
            since_s: self.since.in_run(began_s),
            from_s: belief.onset.in_run(began_s),
        }
    }
}

impl From<Effects> for Base {
    fn from(effects: Effects) -> Self {
        Self { before: effects.clone(), effects, since: Onset::ALWAYS }
    }
}

impl Supposed {
    /// As a belief from `onset` on.
    pub(super) const fn from(&self, onset: Onset) -> Belief<'_> {
        Belief { effects: &self.effects, before_base: &self.before_base, onset }
    }
}

impl<'e> EffectSchedule<'e> {
    /// Effects that set in at an instant of the run, s; until then what is `before`.
    pub(super) const fn late(before: &'e Effects, from_s: f64, effects: &'e Effects) -> Self {
        let (sound, before_base) = (before, effects);
        Self { sound, before_base, before, effects, since_s: 0.0, from_s }
    }

    /// The same until the base sets in, as if it never did.
    pub(super) const fn without_base(self) -> Self {
        Self::late(self.sound, self.from_s, self.before_base)
    }

    /// The same where something else than the base is what the belief takes over from.
    pub(super) const fn taking_over(self, before: &'e Effects) -> Self {
        Self { before, ..self }
    }

    /// When the base sets in, s of the run; 0 where it was there from the start.
    pub(super) const fn since_s(&self) -> f64 {
        self.since_s
    }

    /// When something sets in underway, and what, in their order.
    pub(super) fn changes(&self) -> impl DoubleEndedIterator<Item = Change<'e>> + use<'e> {
        let change = |at_s: f64, from_to| (at_s > 0.0).then_some(Change { at_s, from_to });
        let both = if self.since_s > self.from_s {
            [
                change(self.from_s, [self.sound, self.before_base]),
                change(self.since_s, [self.before_base, self.effects]),
            ]
        } else {
            [
                change(self.since_s, [self.sound, self.before]),
                change(self.from_s, [self.before, self.effects]),
            ]
        };
        both.into_iter().flatten()
    }

    /// The schedule without the last of its changes, and when that was, s; none where there is none.
    pub(super) fn earlier(&self) -> Option<(Self, f64)> {
        let until_s = self.changes().next_back()?.at_s;
        let earlier = if self.since_s > self.from_s {
            self.without_base()
        } else {
            Self::late(self.sound, self.since_s, self.before)
        };
        Some((earlier, until_s))
    }

    /// What `of` makes of the effects that hold when.
    pub(super) fn of<T>(&self, of: impl Fn(&Effects) -> T) -> Scheduled<T> {
        Scheduled {
            sound: of(self.sound),
            before_base: of(self.before_base),
            before: of(self.before),
            is: of(self.effects),
            since_s: self.since_s,
            from_s: self.from_s,
        }
    }
}

impl<T> Scheduled<T> {
    /// At an instant of the run, s.
    pub(super) fn at(&self, at_s: f64) -> &T {
        let at_s = at_s.max(0.0);
        match (at_s < self.since_s, at_s < self.from_s) {
            (true, true) => &self.sound,
            (true, false) => &self.before_base,
            (false, true) => &self.before,
            (false, false) => &self.is,
        }
    }
}

impl<'e> From<&'e Effects> for EffectSchedule<'e> {
    fn from(effects: &'e Effects) -> Self {
        Self::late(effects, 0.0, effects)
    }
}

/// There from the start, beside a base that is as well.
impl<'e> From<&'e Effects> for Belief<'e> {
    fn from(effects: &'e Effects) -> Self {
        Self { effects, before_base: effects, onset: Onset::ALWAYS }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A receiver that is late from 8 s on, and beside it a unit that is loose.
    fn late_and_loose() -> (Base, Supposed) {
        let mut base = Base::from(Effects::default());
        base.effects.sensors.gnss_latency.delay_s = 0.2;
        base.since = Onset::in_every_run(8.0);
        let loose = base.with(|effects| {
            let mut effects = effects.clone();
            effects.sensors.imu_offset.roll_rad = 0.1;
            effects
        });
        (base, loose)
    }

    /// How late the one is and how far off the other, rad, at 3, 6 and 9 s, where the unit comes loose at `from_s`.
    fn told(from_s: f64) -> [(f64, f64); 3] {
        let (base, loose) = late_and_loose();
        let schedule = base.schedule(loose.from(Onset::in_every_run(from_s)), 0.0);
        let late_s = schedule.of(|effects| effects.sensors.gnss_latency.delay_s);
        let roll_rad = schedule.of(|effects| effects.sensors.imu_offset.roll_rad);
        [3.0, 6.0, 9.0].map(|at_s| (*late_s.at(at_s), *roll_rad.at(at_s)))
    }

    #[test]
    fn a_belief_and_its_base_set_in_each_at_its_own_instant() {
        assert_eq!(told(4.0), [(0.0, 0.0), (0.0, 0.1), (0.2, 0.1)]);
        assert_eq!(told(0.0), [(0.0, 0.1), (0.0, 0.1), (0.2, 0.1)]);
        assert_eq!(told(9.0), [(0.0, 0.0), (0.0, 0.0), (0.2, 0.1)]);
        assert_eq!(told(10.0), [(0.0, 0.0), (0.0, 0.0), (0.2, 0.0)]);
    }

    #[test]
    fn changes_come_in_their_order_and_the_last_can_be_undone() {
        let (base, loose) = late_and_loose();
        for (from_s, order, left) in [(4.0, vec![4.0, 8.0], 0.1), (9.0, vec![8.0, 9.0], 0.0)] {
            let schedule = base.schedule(loose.from(Onset::in_every_run(from_s)), 0.0);
            let at_s: Vec<f64> = schedule.changes().map(|change| change.at_s).collect();
            assert_eq!(at_s, order);
            let (earlier, until_s) = schedule.earlier().unwrap();
            assert_eq!((until_s, earlier.changes().count()), (order[1], 1));
            let roll_rad = earlier.of(|effects| effects.sensors.imu_offset.roll_rad);
            assert_eq!(*roll_rad.at(20.0), left);
        }
        assert_eq!(EffectSchedule::from(&base.before).changes().count(), 0);
    }
}
