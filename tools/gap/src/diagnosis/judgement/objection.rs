//! What speaks against the best cause or pair: a signal that it leaves, an echo of itself in that, a size that
//! is not one, or tolerances that would have to bend.

use super::super::candidate::Candidate;
use super::super::evidence::Left;
use super::super::floor::Signal;
use super::super::generator::Generator;
use super::super::hypothesis::Fit;
use super::super::knob::Knob;
use super::super::vague_laws::is_vague;
use super::allowed::{echoing, excess, parting, recurring};
use super::{Findings, HeldOut, HeldOutSignal, SignalFindings};

/// Squares of the tolerances' shifts, each by its own, that a right answer may take, all together: what
/// is not in the catalogue bends them by more.
const SHIFTS: f64 = 53.0;
/// The share of the best evidence, nats, by which that rises: what a law leaves of a large gap bends
/// tolerances too.
const SHIFTS_SHARE: f64 = 0.01;
/// How far the one that goes furthest may go, by its own.
const SHIFT: f64 = 4.4;

/// How much more a right answer may leave of a signal of the runs held out: they are few, and no scale was
/// settled on them.
const HELD: f64 = 1.5;
/// How strongly it speaks against a cause that its one number is where its law ends: it would go on. Of right answers
/// none whose number is known is there.
const AT_ITS_END: f64 = 2.0;
/// Evidence of the cause from which that counts, nats, which makes it as likely as none: what bends to next to
/// nothing bends as far as it can.
const ENDED_MIN: f64 = 18.0;
/// Share of a range within which a number is at the end of it.
const END: f64 = 1e-3;
/// Standard deviation, in tolerances, from which a number may as well be well within its range.
const WIDE: f64 = 0.15;
/// Share of a gap's square beyond which the causes believed explain none of it there.
const STRANGE: f64 = 0.64;

/// Something that a right answer would not leave so large.
#[derive(Clone, Debug)]
pub(super) struct Objection {
    /// How large it is beside the largest that a right answer leaves.
    pub(super) times: f64,
    /// What it is, after `because`.
    pub(super) why: String,
    /// The signal that it is about; none where it is about tolerances.
    pub(super) at: Option<(Generator, Signal)>,
    /// Whether it is of the runs held out.
    pub(super) is_held_out: bool,
}

impl Findings {
    /// The strongest objection to the best cause or pair; about one, or less, where it is right.
    pub(super) fn objection(&self) -> Objection {
        let of_runs = self.signals_left().chain(self.recurring());
        let of_signals =
            of_runs.chain(self.held_left()).chain(self.echoing()).chain(self.parting());
        let all = of_signals
            .chain(self.furthest(&self.shifts))
            .chain([self.bending()])
            .chain(self.at_its_end());
        all.max_by(|a, b| a.times.total_cmp(&b.times)).expect("tolerances are always there")
    }

    /// Effects of the causes that are believed.
    fn names(&self) -> Vec<&'static str> {
        self.believed().map(Candidate::name).collect()
    }

    fn signals_left(&self) -> impl Iterator<Item = Objection> {
        let names = self.names();
        self.signals.iter().map(move |of @ SignalFindings { unbent, after, .. }| Objection {
            times: excess(&names, [unbent, after], of.explained_square()),
            why: how_much([unbent, after]),
            at: Some((after.generator, after.signal)),
            is_held_out: false,
        })
    }

    /// Bumps that are no accident: they are hidden in no mean.
    fn recurring(&self) -> impl Iterator<Item = Objection> {
        let names = self.names();
        self.signals.iter().map(move |of @ SignalFindings { unbent, after, .. }| Objection {
            times: recurring(&names, [unbent, after], of.explained_square()),
            why: format!(
                "{:.0} floors are left of the {} of {} again and again",
                after.recurring,
                after.signal.with_wheel(),
                after.generator
            ),
            at: Some((after.generator, after.signal)),
            is_held_out: false,
        })
    }

    /// What is left of the runs held out, of gaps that only they show: how well a cause foretells what it
    /// explains is in its evidence already.
    pub(super) fn held_left(&self) -> impl Iterator<Item = Objection> {
        let names = self.names();
        let HeldOut { signals, shifts } = &self.held_out;
        let strange = signals.iter().filter(|of| of.after.square > STRANGE * of.unbent.square);
        let left = strange.map(move |HeldOutSignal { unbent, after }| Objection {
            times: excess(&names, [unbent, after], unbent.square) / HELD,
            why: format!("{} in the runs held out", how_much([unbent, after])),
            at: Some((after.generator, after.signal)),
            is_held_out: true,
        });
        let bent = self.furthest(shifts).map(|bent| Objection {
            times: bent.times / HELD,
            why: format!("{} in the runs held out", bent.why),
            is_held_out: true,
            ..bent
        });
        left.chain(bent)
    }

    fn echoing(&self) -> impl Iterator<Item = Objection> {
        let names = self.names();
        self.signals.iter().filter_map(|of| of.echo.as_ref()).map(move |echo| Objection {
            times: echoing(&names, echo),
            why: format!(
                "what is left of the {} of {} is what is explained of it, moved in time ({:.0} nats)",
                echo.signal.with_wheel(),
                echo.generator,
                echo.nats
            ),
            at: Some((echo.generator, echo.signal)),
            is_held_out: false,
        })
    }

    /// Sizes that are another in one half of what the machine did.
    fn parting(&self) -> impl Iterator<Item = Objection> {
        let names = self.names();
        self.unevens.iter().map(move |uneven| {
            let [out, within] = uneven.sizes();
            Objection {
                times: parting(&names, uneven, self.evidence()),
                why: format!(
                    "to explain the {} of {} it would have to be {within:.2} times as strong {} and {out:.2} \
                     times elsewhere",
                    uneven.signal.with_wheel(),
                    uneven.generator,
                    uneven.place()
                ),
                at: Some((uneven.generator, uneven.signal)),
                is_held_out: false,
            }
        })
    }

    /// A cause whose one number is at the end of what its law is made for, as an oil that heats up is to one of locks
    /// that hardly damp. Numbers beside others, and shares, may be anything.
    fn at_its_end(&self) -> impl Iterator<Item = Objection> {
        let shown = self.believed().filter(|cause| cause.score() > ENDED_MIN);
        shown.filter_map(|cause| {
            let Fit { hypothesis, values, sigma, .. } = &cause.fit;
            let ([p], [value]) = (hypothesis.effect.parameters, &values[..]) else { return None };
            if sigma[0] > WIDE * p.tolerance {
                return None;
            }
            let is_at = |end: &f64| (value - end).abs() <= END * (p.range[1] - p.range[0]);
            let end = p.range.into_iter().find(|end| is_at(end) && !is_at(&p.neutral))?;
            Some(Objection {
                times: AT_ITS_END,
                why: format!("its {} would have to be beyond {end}, where its law ends", p.name),
                at: None,
                is_held_out: false,
            })
        })
    }

    /// All tolerances together.
    fn bending(&self) -> Objection {
        let taken = SHIFTS + SHIFTS_SHARE * self.evidence();
        let own = self.shifts.iter().filter(|(knob, _)| !self.is_its_form(knob));
        let squares: f64 = own.map(|(_, by)| by * by).sum();
        Objection {
            times: squares / taken,
            why: format!(
                "all tolerances together would have to move by {squares:.0} squares of their own"
            ),
            at: None,
            is_held_out: false,
        }
    }

    /// The tolerance that goes furthest.
    fn furthest(&self, shifts: &[(Knob, f64)]) -> Option<Objection> {
        let own = shifts.iter().filter(|(knob, _)| !self.is_its_form(knob));
        let furthest = own.max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs()));
        furthest.map(|(knob, by)| Objection {
            times: (by / SHIFT).powi(2),
            why: format!("a tolerance, {knob}, would have to move by {:.1} of its own", by.abs()),
            at: None,
            is_held_out: false,
        })
    }

    /// Whether a tolerance says only in which form, or how much on which of its wheels, an effect is there
    /// that is believed: about a nominal machine tolerances are straight lines, and a law that is
    /// straighter than ours goes half along ours and half along them.
    fn is_its_form(&self, knob: &Knob) -> bool {
        let Knob::Effect(effect, _, scope) = knob else { return false };
        let mut believed = self.believed().filter(|cause| is_vague(cause.name()));
        believed.any(|cause| {
            let of = &cause.fit.hypothesis;
            let mut wheels = scope.wheels();
            of.effect.name == effect.name && wheels.all(|wheel| of.scope.contains(wheel))
        })
    }
}

fn how_much([before, after]: [&Left; 2]) -> String {
    let floors = |left: &Left| left.square.sqrt();
    format!(
        "{:.1} floors of {:.1} are left of the {} of {}",
        floors(after),
        floors(before),
        after.signal.with_wheel(),
        after.generator
    )
}

#[cfg(test)]
mod tests {
    use xt28_machine::Wheel;
    use xt28_sim::effects::Scope;

    use super::super::super::evidence::{Echo, Half, Uneven};
    use super::*;

    /// A signal that is quiet but for an echo.
    fn echoing_alone(nats: f64) -> SignalFindings {
        let (generator, signal) = (Generator::ArmStroke(Wheel::Fr), Signal::Stroke);
        let quiet = Left::evenly(generator, signal, 0.0, 150.0);
        let echo = Echo { generator, signal, nats, explained: 900.0, samples: 150.0 };
        SignalFindings { echo: Some(echo), ..SignalFindings::of([quiet, quiet]) }
    }

    #[test]
    fn the_strongest_is_told() {
        let [knob, ..] = Knob::all()[..] else { panic!("there are knobs") };
        let of = |nats, by| {
            let (signals, shifts) = (vec![echoing_alone(nats)], vec![(knob, by)]);
            Findings { signals, shifts, ..Findings::default() }.objection()
        };
        let [echoing, bent] = [of(60.0, 2.0), of(2.0, -7.0)];
        assert!(echoing.times > 1.5 && echoing.why.contains("stroke of arm FR"), "{echoing:?}");
        assert!(echoing.why.contains("60 nats"), "{echoing:?}");
        assert!(bent.times > 1.5 && bent.why.contains(&knob.to_string()), "{bent:?}");
        assert!(of(1.0, 0.5).times < 0.5);
    }

    #[test]
    fn what_runs_held_out_leave_speaks_where_it_is_well_beyond_a_floor() {
        let of = |floors: f64| {
            let square = floors * floors;
            let left = Left::evenly(Generator::Joint(0), Signal::JointAngle, square, 100.0);
            let signals = vec![HeldOutSignal { unbent: left, after: left }];
            let held_out = HeldOut { signals, ..HeldOut::default() };
            Findings { held_out, ..Findings::default() }.objection()
        };
        assert!(of(1.4).times < 1.0);
        let loud = of(9.0);
        assert!(loud.is_held_out && loud.times > 3.0 && loud.why.contains("held out"), "{loud:?}");
    }

    #[test]
    fn what_comes_again_and_again_speaks_where_the_mean_is_silent() {
        let evenly = Left::evenly(Generator::ArmStroke(Wheel::Ml), Signal::Stroke, 0.2, 100.0);
        let left = Left { recurring: 28.0, ..evenly };
        let signals = vec![SignalFindings::of([left, left])];
        let objection = Findings { signals, ..Findings::default() }.objection();
        assert!(
            objection.times > 2.0 && objection.why.contains("again and again"),
            "{objection:?}"
        );
    }

    #[test]
    fn what_is_explained_of_runs_held_out_in_part_is_for_the_evidence_to_weigh() {
        let of = |after: f64| {
            let left = |floors: f64| {
                let square = floors * floors;
                Left::evenly(Generator::Drive, Signal::DrivePressure, square, 100.0)
            };
            let signals = vec![HeldOutSignal { unbent: left(20.0), after: left(after) }];
            let held_out = HeldOut { signals, ..HeldOut::default() };
            Findings { held_out, ..Findings::default() }.objection().times
        };
        assert!(of(12.0) < 1.0 && of(19.0) > 3.0);
    }

    #[test]
    fn a_cause_at_the_end_of_its_law_is_not_believed() {
        let known_to = |sigma: f64, name: &str, value: f64, nats: f64| {
            let mut cause = Candidate::made_up(name, Scope::All, nats);
            (cause.fit.values[0], cause.fit.sigma[0]) = (value, sigma);
            Findings { single: vec![cause], ..Findings::default() }.objection()
        };
        let of = |name: &str, value: f64, nats: f64| known_to(0.01, name, value, nats);
        let ended = of("lock-damping", 0.1, 90.0);
        assert!(ended.times > 1.5 && ended.why.contains("beyond 0.1"), "{ended:?}");
        assert!(known_to(0.1, "lock-damping", 0.1, 90.0).times < 1.0, "it may as well be 0.2");
        assert!(
            of("lock-damping", 0.1, 12.0).times < 1.0 && of("lock-damping", 0.17, 90.0).times < 1.0
        );
        assert!(
            of("arm-delay", 0.0, 90.0).times < 1.0 && of("accumulator-gas", 1.0, 90.0).times < 1.0
        );
    }

    #[test]
    fn a_cause_that_has_two_sizes_is_not_believed() {
        let of = |name: &str, large: f64, small: f64| {
            let mut uneven =
                Uneven::new(Generator::ArmStroke(Wheel::Ml), Signal::Stroke, Half::Large);
            for _ in 0..100 {
                uneven.add(true, 3.0, large * 3.0);
                uneven.add(false, 1.0, small);
            }
            let single = vec![Candidate::made_up(name, Scope::All, 90.0)];
            Findings { single, unevens: vec![uneven], ..Findings::default() }.objection()
        };
        let two = of("pressure-scale", 0.1, -0.5);
        assert!(
            two.times > 1.2 && two.why.contains("1.10 times as strong where it does much"),
            "{two:?}"
        );
        assert!(of("pressure-scale", 0.1, 0.1).times < 0.5);
        assert!(of("seal-stiction", 0.1, -0.5).times < 0.5);
    }

    #[test]
    fn a_vague_cause_that_is_no_longer_believed_excuses_nothing() {
        let of = |name: &str| Candidate::made_up(name, Scope::All, 90.0);
        let times = |pair| {
            let (single, signals) = (vec![of("seal-stiction")], vec![echoing_alone(60.0)]);
            Findings { single, pair, signals, ..Findings::default() }.objection().times
        };
        assert!(times(Vec::new()) < 1.0);
        assert!(times(vec![[of("arm-delay"), of("payload")]]) > 1.5);
    }

    #[test]
    fn tolerances_of_a_vague_law_on_its_own_wheels_say_only_its_form() {
        let bent = |cause: &str, scope: Scope| {
            let single = vec![Candidate::made_up(cause, scope, 900.0)];
            let is_one = |knob: &Knob| {
                matches!(knob, Knob::Effect(e, p, Scope::Wheel(Wheel::Ml))
                    if e.name == "load-dependent-speed" && p.name == "droop")
            };
            let knob = Knob::all().into_iter().find(is_one).unwrap();
            Findings { single, shifts: vec![(knob, 7.0)], ..Findings::default() }.objection().times
        };
        assert!(bent("load-dependent-speed", Scope::All) < 1.0);
        assert!(bent("load-dependent-speed", Scope::Wheel(Wheel::Fr)) > 2.0);
        assert!(bent("valve-gain", Scope::All) > 2.0);
    }

    #[test]
    fn all_tolerances_together_may_be_too_much_where_each_is_not() {
        let shifts: Vec<_> = Knob::all().into_iter().take(30).map(|knob| (knob, 2.0)).collect();
        let objection = Findings { shifts, ..Findings::default() }.objection();
        assert!(objection.times > 2.0 && objection.why.contains("120 squares"), "{objection:?}");
    }
}
