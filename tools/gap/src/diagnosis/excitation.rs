//! Which effects a set of runs cannot show, because nothing in them made the machine do what the
//! effect acts on.
//!
//! The thresholds are assumed: each is what makes an effect of twice its tolerance stand out of the
//! noise floors of its block.

mod measure;
mod need;

use xt28_machine::{Machine, Wheel};
use xt28_sim::effects::{Effect, Scope};

use super::floor::Signal;
use super::signals::Signals;
use super::verdict::NotTestable;
use measure::Excitation;
pub(super) use measure::UNLOADED_N;
use need::Need;

/// What an effect needs to show; those not listed show on any machine, and wherever it stands.
const NEEDS: &[(&str, &[Need])] = &[
    ("arm-gain", &[Need::ArmsMove(0.02), Need::ArmsControlled]),
    ("arm-delay", &[Need::ArmsMove(0.02), Need::ArmsJudged]),
    ("valve-lag", &[Need::ArmsMove(0.02), Need::ArmsJudged]),
    ("valve-hysteresis", &[Need::ArmsTurn(0.02), Need::ArmsJudged]),
    ("valve-deadband", &[Need::ArmsMove(0.02), Need::ArmsJudged]),
    ("valve-gain", &[Need::ArmsMove(0.03), Need::ArmsJudged]),
    ("speed-asymmetry", &[Need::ArmsTurn(0.03), Need::ArmsJudged]),
    ("load-dependent-speed", &[Need::ArmsMove(0.03), Need::LoadsDiffer(15e3), Need::ArmsJudged]),
    ("pump-flow-limit", &[Need::SeveralArms(0.8), Need::ArmsJudged]),
    ("leakage-drift", &[Need::ArmsHold(5.0), Need::ArmsJudged]),
    ("unsupported-sag", &[Need::ArmsUnloaded(1.0), Need::ArmsJudged]),
    ("accumulator-gas", &[Need::LoadsDiffer(15e3), Need::ArmsJudged]),
    ("lock-damping", &[Need::LoadsDiffer(15e3), Need::ArmsJudged]),
    ("seal-stiction", &[Need::ArmsTurn(0.02), Need::ArmsJudged]),
    ("steer-delay", &[Need::Steers(0.05)]),
    ("steer-lag", &[Need::Steers(0.05)]),
    ("steer-backlash", &[Need::Steers(0.05)]),
    ("steer-rate", &[Need::Steers(0.1)]),
    ("steer-gain", &[Need::Steers(0.05)]),
    ("rear-follower-lag", &[Need::Steers(0.05)]),
    ("throttle-delay", &[Need::ThrottleSteps(0.2)]),
    ("drive-lag", &[Need::ThrottleSteps(0.2)]),
    ("rolling-resistance", &[Need::Rolls(3.0), Need::Judged(Signal::DriveForce)]),
    ("standstill-drag", &[Need::ArmsMoveStanding(0.03), Need::Judged(Signal::Weight)]),
    ("engine-droop", &[Need::Throttle(0.6)]),
    ("slippery-ground", &[Need::Fixes, Need::Rolls(5.0), Need::Judged(Signal::TravelSpeed)]),
    ("soft-tyres", &[Need::Judged(Signal::Roll)]),
    ("payload", &[Need::Judged(Signal::Weight)]),
    ("com-shift", &[Need::Judged(Signal::WeightX)]),
    ("terrain-slope", &[Need::Judged(Signal::Roll)]),
    ("imu-offset", &[Need::Judged(Signal::Roll)]),
    ("stroke-scale", &[Need::ArmsMove(0.05)]),
    ("pressure-scale", &[Need::LoadsDiffer(15e3)]),
    ("wheel-speed-scale", &[Need::Rolls(3.0), Need::Judged(Signal::WheelSpeed(Wheel::Fr))]),
    ("gnss-latency", &[Need::Fixes, Need::ThrottleSteps(0.2), Need::Judged(Signal::TravelSpeed)]),
    ("gnss-lever-arm", &[Need::Fixes, Need::Steers(0.1), Need::Judged(Signal::TravelCourse)]),
    ("frame-loss", &[Need::Commands]),
    ("command-jitter", &[Need::Commands]),
];

/// What a set of runs made the machine do, and so which effects can show in them.
pub(super) struct Shown(Excitation);

impl Shown {
    /// What `runs` of `machine` made it do.
    pub(super) fn of<'a>(
        runs: impl Iterator<Item = &'a Signals> + Clone,
        machine: &Machine,
    ) -> Self {
        Self(Excitation::of(runs, machine))
    }

    /// Whether an effect at these wheels can show; what others lack does not count.
    pub(super) fn has(&self, effect: &Effect, scope: Scope) -> bool {
        let did = if effect.has_scope() { self.0.at(scope) } else { self.0.clone() };
        needs(effect).iter().all(|need| need.unmet(&did).is_none())
    }

    /// Whether what was done shows an effect at these wheels by itself: what one arm alone has to do, one did.
    pub(super) fn tests(&self, effect: &Effect, scope: Scope) -> bool {
        let mut of_any = needs(effect).iter().filter(|need| need.is_of_any_arm());
        self.has(effect, scope) && of_any.all(|need| need.unmet(&self.0).is_none())
    }

    /// Whether it shows an effect at every wheel.
    pub(super) fn tests_everywhere(&self, effect: &Effect) -> bool {
        needs(effect).iter().all(|need| need.unmet(&self.0).is_none())
    }

    /// What was done in these runs and in those of `other`.
    pub(super) fn with(&self, other: &Self) -> Self {
        Self(self.0.with(&other.0))
    }

    /// The effects of `catalogue` that cannot show at every wheel, each with what they lack and the
    /// scripted manoeuvre that has it; `is_driven` says of which manoeuvres these runs are.
    pub(super) fn not_testable_in(
        &self,
        catalogue: &[&'static Effect],
        is_driven: impl Fn(&str) -> bool,
    ) -> Vec<NotTestable> {
        let mut all = self.not_testable(catalogue);
        for one in all.iter_mut().filter(|one| is_driven(&one.manoeuvre)) {
            let unmet = needs(one.effect).iter().find(|need| need.unmet(&self.0).is_some());
            one.more = unmet.map(|need| need.more());
        }
        all
    }

    /// The same without a word on what was driven.
    fn not_testable(&self, catalogue: &[&'static Effect]) -> Vec<NotTestable> {
        let judge = |effect: &&'static Effect| {
            let mut all = needs(effect).iter();
            let (need, lacks) = all.find_map(|need| Some((need, need.unmet(&self.0)?)))?;
            let at_some = |wheel: Wheel| self.tests(effect, Scope::Wheel(wheel));
            Some(NotTestable {
                effect,
                lacks,
                manoeuvre: need.manoeuvre().to_owned(),
                more: None,
                fit: Vec::new(),
                in_part: effect.has_scope() && Wheel::ALL.into_iter().any(at_some),
            })
        };
        catalogue.iter().filter_map(judge).collect()
    }
}

/// The effects of `catalogue` that `runs` of `machine` cannot show, each with what they lack and the
/// scripted manoeuvre that has it.
pub fn not_testable<'a>(
    runs: impl Iterator<Item = &'a Signals> + Clone,
    machine: &Machine,
    catalogue: &[&'static Effect],
) -> Vec<NotTestable> {
    Shown::of(runs, machine).not_testable(catalogue)
}

fn needs(effect: &Effect) -> &'static [Need] {
    NEEDS.iter().find(|(name, _)| *name == effect.name).map_or(&[], |(_, needs)| needs)
}

#[cfg(test)]
mod tests {
    use super::super::next_drive::Manoeuvre;
    use super::*;

    #[test]
    fn what_is_not_shown_is_fitted_where_it_was_held_out_and_else_driven() {
        let effect = xt28_sim::effects::find("engine-droop").unwrap();
        let nothing = Shown::of(std::iter::empty(), &Machine::xt28());
        let of = |driven: &str| nothing.not_testable_in(&[effect], |name| name == driven).remove(0);
        assert_eq!(of("s-turn").remedy(), "drive straight");
        let more = of("straight");
        assert_eq!(more.remedy(), "drive straight again, with 60 % of throttle or more");
        let held = NotTestable { fit: vec!["run-4.log".to_owned()], ..more };
        assert_eq!(held.remedy(), "fit run-4.log");
        assert!(!nothing.tests(effect, Scope::All) && !held.in_part);
        // Any one arm will do, so that none did is so of every wheel.
        let creeping = xt28_sim::effects::find("leakage-drift").unwrap();
        assert!(!nothing.tests(creeping, Scope::Wheel(Wheel::Fr)));
    }

    #[test]
    fn every_need_is_of_an_effect_there_is_and_stands_once() {
        for (i, (name, needs)) in NEEDS.iter().enumerate() {
            assert!(xt28_sim::effects::find(name).is_some(), "{name}");
            assert!(NEEDS[..i].iter().all(|(other, _)| other != name), "{name}");
            assert!(!needs.is_empty());
            for need in *needs {
                assert!(Manoeuvre::find(need.manoeuvre()).is_some(), "{}", need.manoeuvre());
            }
        }
    }
}
