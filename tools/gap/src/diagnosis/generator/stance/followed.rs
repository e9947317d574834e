//! What filtered readings show of something that jumps within a run.

use xt28_sim::Effects;

use crate::diagnosis::belief::{Change, EffectSchedule};
use crate::diagnosis::blend::Blend;
use crate::diagnosis::signals::DT_S;

/// Something believed, and what it was until instants of a run.
#[derive(Clone, Copy)]
pub(super) struct Followed<T> {
    /// What it is at first.
    first: T,
    /// When it becomes something else, s, and what.
    then: [Option<(f64, T)>; 2],
}

impl<T: Blend> Followed<T> {
    /// What `of` makes of the effects of a `schedule`; it jumps where `differs` says so of two of them.
    pub(super) fn new(
        schedule: EffectSchedule<'_>,
        of: impl Fn(&Effects) -> T,
        differs: impl Fn(&Effects, &Effects) -> bool,
    ) -> Self {
        let (mut first, mut then) = (None, [None; 2]);
        for (k, Change { at_s, from_to: [was, is] }) in schedule.changes().enumerate() {
            if differs(was, is) {
                first.get_or_insert_with(|| of(was));
                then[k] = Some((at_s, of(is)));
            }
        }
        Self { first: first.unwrap_or_else(|| of(schedule.effects)), then }
    }

    /// Whether it jumps at all.
    pub(super) fn jumps(&self) -> bool {
        self.then.iter().any(Option::is_some)
    }

    /// As a reading of `sample` shows it, whose filters leave `remains` of a jump so many seconds later.
    pub(super) fn at(&self, sample: usize, remains: impl Fn(f64) -> f64) -> T {
        let at_s = sample as f64 * DT_S;
        let jumped = self.then.iter().flatten().filter(|(from_s, _)| at_s >= *from_s);
        jumped.fold(self.first, |was, (from_s, is)| is.toward(&was, remains(at_s - from_s)))
    }
}

/// Share of a jump that two first-order filters one after the other, of these time constants, s, have yet to show
/// after `time_s`; the constants differ.
pub(super) fn remains_behind([slow_s, quick_s]: [f64; 2], time_s: f64) -> f64 {
    let left = |constant_s: f64| constant_s * (-time_s / constant_s).exp();
    (left(slow_s) - left(quick_s)) / (slow_s - quick_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::generator::stance::motion::lagged;

    #[test]
    fn what_remains_is_what_two_filters_have_yet_to_show() {
        let jump = (0..1000).map(|i| if i < 100 { 0.0 } else { 1.0 });
        let twice = lagged(lagged(jump, 2.0).into_iter(), 0.164);
        for i in [100, 120, 200, 500, 999] {
            let remains = remains_behind([2.0, 0.164], (i - 100) as f64 * DT_S);
            assert!((1.0 - twice[i] - remains).abs() < 0.01, "{i}: {} {remains}", twice[i]);
        }
    }

    #[test]
    fn a_jump_shows_by_and_by() {
        let mut off = Effects::default();
        off.sensors.imu_offset.roll_rad = 0.02;
        let sound = Effects::default();
        let schedule = EffectSchedule::late(&sound, 3.0, &off);
        let of = |effects: &Effects| effects.sensors.imu_offset.roll_rad;
        let roll = Followed::new(schedule, of, |was, is| of(was) != of(is));
        let at = |sample| roll.at(sample, |time_s| (-time_s / 2.0).exp());
        assert_eq!((at(299), at(300)), (0.0, 0.0));
        assert!((at(500) - 0.02 * (1.0 - (-1.0_f64).exp())).abs() < 1e-12);
    }
}
