//! What a block of a foreign machine says of its own fault, without the rest of the machine.

use xt28_gap::diagnosis::{
    Base, Belief, Evidence, Fit, Generator, Hypothesis, Knob, Onset, Residual, Signal, Signals,
    Uneven,
};
use xt28_gap_check::Source;
use xt28_gap_plants::{Case, Cause, Kind, Manoeuvre, Scope};
use xt28_machine::{Axle, Machine, Side, Wheel};
use xt28_sim::Effects;
use xt28_sim::effects::{self, find};

fn signals(case: Case) -> Vec<Signals> {
    let runs = Source::Drawn(Box::new(case)).inquiry().expect("a case that is drawn has runs").runs;
    runs.into_iter().map(|run| run.signals).collect()
}

fn hypothesis(effect: &str, scope: effects::Scope) -> Hypothesis {
    Hypothesis { effect: find(effect).unwrap(), scope }
}

/// `effect` at `scope` on those wheels' arms, sought from `start` for each instant at which it may set in.
fn fits(
    runs: &[Signals],
    (effect, scope): (&str, effects::Scope),
    start: f64,
    from_s: &[f64],
) -> Vec<Fit> {
    let hypothesis = hypothesis(effect, scope);
    let arms = Wheel::ALL.into_iter().filter(|wheel| scope.contains(*wheel));
    let watched = arms.map(Generator::ArmStroke).collect();
    let machine = Machine::xt28();
    let evidence = Evidence::watching(watched, runs, &machine, Effects::default(), &Knob::all());
    from_s
        .iter()
        .map(|at_s| hypothesis.refit(&evidence, Onset::in_every_run(*at_s), &[start]))
        .collect()
}

#[test]
fn a_leak_that_sets_in_late_is_as_large_as_it_is_and_begins_when_it_does() {
    let (began_s, size_m_s) = (9.7, 0.006_243_5);
    let leak = Cause::find("leakage-drift").unwrap();
    let case = Case::of(901, leak, Scope::Side(Side::Left)).beginning_at(began_s);
    let runs = signals(case.only(Manoeuvre::ArmStep, 24.0));
    let left = effects::Scope::Side(Side::Left);
    let around = [began_s - 0.5, began_s, began_s + 0.5];
    let fits = fits(&runs, ("leakage-drift", left), 0.004, &around);
    let [early, right, late] = &fits[..] else { panic!("three instants") };
    assert!((right.values[0] / size_m_s - 1.0).abs() < 0.05, "{right:?}");
    assert!(right.log_evidence > early.log_evidence + 5.0, "{early:?}");
    assert!(right.log_evidence > late.log_evidence + 5.0, "{late:?}");
}

#[test]
fn a_damper_shows_on_a_light_arm_that_lifts_its_wheel() {
    let runs = signals(Case::draw(50_981_774, Kind::Single).only(Manoeuvre::ArmStep, 32.0));
    let fits = fits(&runs, ("lock-damping", effects::Scope::Wheel(Wheel::Mr)), 2.0, &[0.0]);
    assert!(fits[0].log_evidence > 10.0, "{fits:?}");
    assert!((2.5..5.5).contains(&fits[0].values[0]), "{fits:?}");
}

#[test]
fn what_an_arm_leaves_open_another_run_may_tell() {
    let gas = |manoeuvre, seconds| {
        let fault = Cause::find("accumulator-gas").unwrap();
        let case = Case::of(908, fault, Scope::One(Wheel::Fr));
        signals(case.only(manoeuvre, seconds))
    };
    let [fitted, other] = [gas(Manoeuvre::SingleArm, 36.0), gas(Manoeuvre::Mixed, 32.0)];
    let machine = Machine::xt28();
    let evidence = |runs| {
        let watched = vec![Generator::ArmStroke(Wheel::Fr)];
        Evidence::watching(watched, runs, &machine, Effects::default(), &Knob::all())
    };
    let [fitted, other] = [&fitted, &other].map(|runs| evidence(runs));
    let scope = effects::Scope::Wheel(Wheel::Fr);
    let hypothesis = hypothesis("accumulator-gas", scope);
    let alone = hypothesis.refit(&fitted, Onset::ALWAYS, &[1.0, 1.9e6, 1.0e-3, 1.4]);
    let suiting = hypothesis.suiting(&fitted, &other, &alone);
    let foretold =
        [&alone, &suiting].map(|fit| hypothesis.gain(&other, Onset::ALWAYS, &fit.values));
    assert!(suiting.log_evidence > 0.9 * alone.log_evidence, "{alone:?} {suiting:?}");
    assert!(foretold[1] > foretold[0] + 20.0, "{foretold:?}");
    assert!((suiting.values[1] / 2.889e6 - 1.0).abs() < 0.1, "{suiting:?}");
}

#[test]
fn idle_motors_on_a_slope_hold_what_it_pulls() {
    let case = Case::draw(3_768_813_181, Kind::Pair);
    let run = |manoeuvre| signals(case.only(manoeuvre, 32.0));
    let runs = [run(Manoeuvre::ArmStep), run(Manoeuvre::Multisine)].concat();
    let watched = vec![Generator::Stance];
    let slope = hypothesis("terrain-slope", effects::Scope::All);
    let sloping = slope.applied(&Effects::default(), &[-0.0274, -0.0113]);
    let evidence = Evidence::watching(watched, &runs, &Machine::xt28(), sloping, &Knob::all());
    let drag = hypothesis("standstill-drag", effects::Scope::Axle(Axle::Rear));
    let fit = drag.refit(&evidence, Onset::ALWAYS, &[3.0e3]);
    assert!(fit.log_evidence > 10.0, "{fit:?}");
    // They hold by 3.9 kNm. Its tyres creep: arms that move slowly never ask for all of it.
    assert!((1.3e3..4.9e3).contains(&fit.values[0]), "{fit:?}");
}

#[test]
fn a_slow_valve_in_the_place_of_a_late_command_leaves_its_echo() {
    let late = Case::of(3001, Cause::find("arm-delay").unwrap(), Scope::All);
    let runs = signals(late.only(Manoeuvre::ArmStep, 32.0));
    let machine = Machine::xt28();
    let watched = vec![Generator::ArmStroke(Wheel::Fr)];
    let evidence = Evidence::watching(watched, &runs, &machine, Effects::default(), &Knob::all());
    let scope = effects::Scope::Wheel(Wheel::Fr);
    let echo = |effect| {
        let hypothesis = hypothesis(effect, scope);
        let fit = hypothesis.refit(&evidence, Onset::ALWAYS, &[0.18]);
        let effects = hypothesis.applied(&Effects::default(), &fit.values);
        evidence.again(&effects, &Effects::default()).0[0]
    };
    let [late, slow] = ["arm-delay", "valve-lag"].map(echo);
    assert!(slow.explained > 0.7 * late.explained, "{late:?} {slow:?}");
    assert!(late.nats < 3.0 && slow.nats > 12.0, "{late:?} {slow:?}");
}

#[test]
fn a_scale_that_stands_for_a_bias_is_of_two_sizes() {
    let off = Case::of(4_240_833_300, Cause::find("pressure-bias").unwrap(), Scope::One(Wheel::Ml));
    let runs =
        [Manoeuvre::SingleArm, Manoeuvre::Multisine].map(|drive| signals(off.only(drive, 36.0)));
    let (runs, machine) = (runs.concat(), Machine::xt28());
    let watched = vec![Generator::ArmStroke(Wheel::Ml)];
    let evidence = Evidence::watching(watched, &runs, &machine, Effects::default(), &Knob::all());
    let onset = Onset::in_every_run(10.8);
    let parting = |effect, from: &[f64]| {
        let hypothesis = hypothesis(effect, effects::Scope::Wheel(Wheel::Ml));
        let fit = hypothesis.refit(&evidence, onset, from);
        let effects = hypothesis.applied(&Effects::default(), &fit.values);
        let belief = Belief { onset, ..(&effects).into() };
        let unevens = evidence.again(belief, &Effects::default()).1;
        unevens.iter().map(Uneven::nats).fold(0.0, f64::max)
    };
    let (bias, scale) =
        (parting("pressure-bias", &[-4.0e5]), parting("pressure-scale", &[0.9, 0.0]));
    assert!(bias < 3.0 && scale > 8.0, "{bias} {scale}");
}

#[test]
fn an_arm_that_is_almost_solid_is_not_off_by_less() {
    let leak = Case::of(903, Cause::find("leakage-drift").unwrap(), Scope::One(Wheel::Fl));
    let runs = signals(leak.only(Manoeuvre::ArmStep, 24.0));
    let gas = hypothesis("accumulator-gas", effects::Scope::Wheel(Wheel::Fl));
    let solid = gas.applied(&Effects::default(), &[1.0, 0.5e6, 0.1e-3, 1.0]);
    let [lock_m, solid_m] = [Effects::default(), solid].map(|effects| {
        let generator = Generator::ArmStroke(Wheel::Fl);
        let residuals = generator.residuals(&runs[0], &Machine::xt28(), &effects);
        let told: Vec<f64> =
            residuals[0].values.iter().copied().filter(|m| m.is_finite()).collect();
        (told.iter().map(|m| m * m).sum::<f64>() / told.len() as f64).sqrt()
    });
    assert!(lock_m > 4e-3 && solid_m > 0.8 * lock_m, "{lock_m} {solid_m}");
}

#[test]
fn of_two_faults_one_that_sets_in_late_leaves_no_echo() {
    let case = Case::draw(3_331_623_976, Kind::Pair);
    let runs = signals(case.only(Manoeuvre::ArmStep, 32.0));
    let deadband = hypothesis("valve-deadband", effects::Scope::All);
    let nothing = Effects::default();
    let base = Base {
        effects: deadband.applied(&nothing, &[0.0345]),
        since: Onset::in_every_run(10.3),
        before: nothing.clone(),
    };
    let scale = hypothesis("stroke-scale", effects::Scope::Wheel(Wheel::Fr));
    let [both, alone] = [&base.effects, &nothing].map(|base| scale.applied(base, &[1.0431]));
    let belief = Belief { effects: &both, before_base: &alone, onset: Onset::ALWAYS };
    let watched = vec![Generator::ArmStroke(Wheel::Fr)];
    let evidence = Evidence::watching(watched, &runs, &Machine::xt28(), base, &Knob::all());
    let echo = evidence.again(belief, &nothing).0[0];
    assert!(echo.explained > 1.0e4 && echo.nats < 10.0, "{echo:?}");
}

#[test]
fn gyroscopes_of_another_scale_sway() {
    let floors = |case: Case| {
        let runs = signals(case.only(Manoeuvre::Multisine, 32.0));
        let machine = Machine::xt28();
        rms(&Generator::Stance.residuals(&runs[0], &machine, &Effects::default()), Signal::RollSway)
    };
    let faulty = Case::of(1_147_746_101, Cause::find("gyro-scale").unwrap(), Scope::All);
    let (sound, other) = (floors(faulty.without_faults()), floors(faulty));
    assert!(sound < 1.0 && other > 2.0, "{sound} floors, with the fault {other}");
}

/// Root mean square of what a residual says, floors.
fn rms(residuals: &[Residual], signal: Signal) -> f64 {
    let of = residuals.iter().find(|residual| residual.signal == signal).unwrap();
    let told: Vec<f64> = of.values.iter().copied().filter(|value| value.is_finite()).collect();
    assert!(told.len() > 100, "{signal}: {}", told.len());
    (told.iter().map(|value| value * value).sum::<f64>() / told.len() as f64).sqrt()
}

#[test]
fn an_antenna_that_leans_while_arms_lift_is_no_slip() {
    let runs = signals(Case::draw(42, Kind::Null).only(Manoeuvre::Mixed, 32.0));
    let residuals = Generator::Travel.residuals(&runs[0], &Machine::xt28(), &Effects::default());
    for (signal, floors) in [(Signal::TravelSpeed, 1.1), (Signal::TravelCourse, 0.6)] {
        let left = rms(&residuals, signal);
        assert!(left < floors, "{signal}: {left}");
    }
}

#[test]
fn a_machine_turns_as_its_joints_read_and_not_as_they_will_read() {
    let mut runs = signals(Case::draw(9005, Kind::Null).only(Manoeuvre::STurn, 36.0));
    let machine = Machine::xt28();
    let floors = |runs: &[Signals]| {
        rms(&Generator::Turning.residuals(&runs[0], &machine, &Effects::default()), Signal::YawRate)
    };
    let sound = floors(&runs);
    for joint in [0, 1] {
        let run = &mut runs[0];
        for reading in [&mut run.joint_rad[joint], &mut run.joint_rate_rad_s[joint]] {
            reading.rotate_right(40); // 0.4 s
        }
    }
    let late = floors(&runs);
    assert!(sound < 1.2 && late > 2.0, "{sound} floors, with joints that read late {late}");
}
