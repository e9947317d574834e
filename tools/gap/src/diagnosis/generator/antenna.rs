//! Where the receiver's antenna was, and when, that a fix tells.

use xt28_sim::effects::GnssLeverArm;

use crate::diagnosis::belief::{EffectSchedule, Scheduled};

/// The receiver as believed over a run.
pub(super) struct Antenna {
    /// How late it is, s.
    late_s: Scheduled<f64>,
    /// How far its antenna is from where it is believed to be.
    lever: Scheduled<GnssLeverArm>,
}

impl Antenna {
    /// The receiver over a schedule of effects.
    pub(super) fn new(schedule: EffectSchedule<'_>) -> Self {
        Self {
            late_s: schedule.of(|effects| effects.sensors.gnss_latency.delay_s),
            lever: schedule.of(|effects| effects.sensors.gnss_lever_arm),
        }
    }

    /// How late a fix at `at_s` is, s.
    pub(super) fn late_s(&self, at_s: f64) -> f64 {
        *self.late_s.at(at_s)
    }

    /// How far the antenna is ahead and to the left of where it is believed to be, by a fix at `at_s`, m.
    pub(super) fn lever_m(&self, at_s: f64) -> [f64; 2] {
        let lever = self.lever.at(at_s);
        [lever.x_m, lever.y_m]
    }

    /// How far fixes of a machine at rest go from `from_s` to `to_s`, ahead and to the left, m: a mast that is bent
    /// meanwhile moves them.
    pub(super) fn jumped_m(&self, [from_s, to_s]: [f64; 2]) -> [f64; 2] {
        let [was, is] = [from_s, to_s].map(|at_s| self.lever_m(at_s));
        [is[0] - was[0], is[1] - was[1]]
    }

    /// Time between what fixes at `from_s` and `to_s` tell, s.
    pub(super) fn passed_s(&self, [from_s, to_s]: [f64; 2]) -> f64 {
        to_s - self.late_s(to_s) - (from_s - self.late_s(from_s))
    }
}

#[cfg(test)]
mod tests {
    use xt28_sim::Effects;

    use super::*;
    use crate::diagnosis::belief::Base;
    use crate::diagnosis::onset::Onset;

    #[test]
    fn a_receiver_is_what_it_is_when_it_speaks() {
        let (sound, mut off) = (Effects::default(), Effects::default());
        off.sensors.gnss_latency.delay_s = 0.3;
        off.sensors.gnss_lever_arm.y_m = -0.5;
        let late = EffectSchedule::late(&sound, 4.0, &off);
        let antenna = Antenna::new(late);
        assert_eq!((antenna.late_s(3.9), antenna.late_s(4.0)), (0.0, 0.3));
        assert_eq!(antenna.jumped_m([3.5, 4.5]), [0.0, -0.5]);
        assert!((antenna.passed_s([3.5, 4.5]) - 0.7).abs() < 1e-12);
        assert!((antenna.passed_s([4.5, 5.5]) - 1.0).abs() < 1e-12);
        let always = Antenna::new((&off).into());
        assert_eq!((always.late_s(0.0), always.jumped_m([0.0, 9.0])), (0.3, [0.0; 2]));
        let base = Base { effects: off, since: Onset::in_every_run(4.0), before: sound };
        let base = base.schedule(base.belief(), 0.0);
        assert_eq!(Antenna::new(base).jumped_m([3.5, 4.5]), [0.0, -0.5]);
    }
}
