//! What runs lack, and whose wheels they are: on made-up signals, each with one thing the matter.

mod made_up;

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use made_up::{series, signals, standing, swinging};
use xt28_gap::diagnosis::{Signals, not_testable, swapped_wheels};
use xt28_gap::{Channel, Series, Terrain};
use xt28_machine::{Machine, Wheel};
use xt28_sim::Ramp;
use xt28_sim::effects::CATALOGUE;

fn lacks(all: &BTreeMap<Channel, Series>, effect: &str) -> Option<(String, String)> {
    let catalogue: Vec<_> = CATALOGUE.iter().collect();
    let found = not_testable(signals(all).iter(), &Machine::xt28(), &catalogue);
    let one = found.into_iter().find(|one| one.effect.name == effect)?;
    Some((one.lacks, one.manoeuvre))
}

/// A machine that stands and logs its arms' loads alone.
fn carrying() -> BTreeMap<Channel, Series> {
    without_pressures(standing())
}

fn without_pressures(mut all: BTreeMap<Channel, Series>) -> BTreeMap<Channel, Series> {
    all.retain(|channel, _| !matches!(channel, Channel::BorePressure(_) | Channel::RodPressure(_)));
    all
}

#[test]
fn arms_of_which_a_chamber_reads_empty_are_not_tested() {
    let (lacks, with) = lacks(&swinging(), "valve-lag").unwrap();
    assert_eq!(
        lacks,
        "the stroke of FR FL MR ML BR BL could be judged for less than 2 s, as a chamber reads empty"
    );
    assert_eq!(with, "arm-step");
}

#[test]
fn a_controller_is_tested_in_manual_position_alone() {
    let mut all = without_pressures(swinging());
    assert_eq!(lacks(&all, "arm-gain"), None);
    all.insert(Channel::ArmMode, series(|_| 0.0));
    let (lacks, _) = lacks(&all, "arm-gain").unwrap();
    assert!(lacks.contains("could be judged for less than 2 s in manual position"), "{lacks}");
}

#[test]
fn a_machine_that_only_stands_shows_neither_arms_nor_steering_nor_drive() {
    let all = carrying();
    for (effect, manoeuvre) in [
        ("arm-delay", "single-arm"),
        ("valve-hysteresis", "single-arm"),
        ("pump-flow-limit", "arm-step"),
        ("steer-lag", "s-turn"),
        ("throttle-delay", "straight"),
        ("slippery-ground", "straight"),
        ("command-jitter", "multisine"),
    ] {
        let (lacks, with) = lacks(&all, effect).unwrap_or_else(|| panic!("{effect}"));
        assert_eq!(with, manoeuvre, "{effect}: {lacks}");
    }
    for effect in ["leakage-drift", "stroke-bias", "payload", "imu-offset"] {
        assert_eq!(lacks(&all, effect), None, "{effect}");
    }
}

#[test]
fn ground_that_is_not_level_hides_what_a_machine_stands_and_travels_by() {
    let all = carrying();
    let ramp = Ramp { x_m: [3.0, 6.0, 8.0, 11.0], height_m: 0.3, y_min_m: -2.0, y_max_m: 2.0 };
    let catalogue: Vec<_> = CATALOGUE.iter().collect();
    let hidden = |terrain| {
        let runs = [Signals::of_series("made up", &all, 20.0, terrain).unwrap()];
        let all = not_testable(runs.iter(), &Machine::xt28(), &catalogue);
        all.into_iter().map(|one| (one.effect.name, one.lacks)).collect::<BTreeMap<_, _>>()
    };
    let (level, uneven) = (hidden(Terrain::Flat), hidden(Terrain::ramp(&ramp)));
    for effect in ["payload", "com-shift", "terrain-slope", "imu-offset", "soft-tyres"] {
        assert!(!level.contains_key(effect), "{effect}");
        assert!(uneven[effect].contains("level ground"), "{effect}: {}", uneven[effect]);
    }
    assert!(!uneven.contains_key("leakage-drift"), "arms hold a load on any ground");
}

#[test]
fn arms_that_stand_while_others_move_are_named() {
    let mut all = without_pressures(swinging());
    assert_eq!(lacks(&all, "arm-delay"), None);
    for w in [Wheel::Mr, Wheel::Ml] {
        all.insert(Channel::Stroke(w), series(|_| 0.17));
    }
    let (lacks, _) = lacks(&all, "arm-delay").unwrap();
    assert_eq!(lacks, "arms MR ML go through less than 20 mm");
}

#[test]
fn a_throttle_that_creeps_up_has_no_step() {
    let mut all = standing();
    all.insert(Channel::Throttle, series(|t| 0.04 * t));
    assert!(lacks(&all, "throttle-delay").is_some());
    assert_eq!(lacks(&all, "engine-droop"), None);
    all.insert(Channel::Throttle, series(|t| if t > 5.0 { 0.5 } else { 0.0 }));
    assert_eq!(lacks(&all, "throttle-delay"), None);
    let (lacks, _) = lacks(&all, "engine-droop").unwrap();
    assert_eq!(lacks, "the throttle goes up to 50 % of 60 % needed");
}

#[test]
fn joints_count_only_while_the_wheels_turn() {
    let mut all = standing();
    all.insert(Channel::FrontJoint, series(|t| 0.2 * (0.5 * t).sin()));
    assert!(lacks(&all, "steer-lag").is_some());
    for w in Wheel::ALL {
        all.insert(Channel::WheelSpeed(w), series(|_| 1.0));
    }
    assert_eq!(lacks(&all, "steer-lag"), None);
}

#[test]
fn wheels_in_their_order_are_not_complained_of() {
    assert_eq!(swapped_wheels(&signals(&swinging()), &Machine::xt28()), None);
    assert_eq!(swapped_wheels(&signals(&standing()), &Machine::xt28()), None);
}

#[test]
fn every_two_wheels_swapped_are_found() {
    for a in Wheel::ALL {
        for b in Wheel::ALL.into_iter().filter(|b| a != *b) {
            let mut all = swinging();
            let (of_a, of_b) = (all[&Channel::Stroke(a)].clone(), all[&Channel::Stroke(b)].clone());
            all.insert(Channel::Stroke(a), of_b);
            all.insert(Channel::Stroke(b), of_a);
            let swap = swapped_wheels(&signals(&all), &Machine::xt28())
                .unwrap_or_else(|| panic!("{a} {b}"));
            assert_eq!(swap.between, ["target", "stroke"]);
            let mut pairs = swap.pairs;
            pairs.sort();
            let mut wanted = vec![(a, b), (b, a)];
            wanted.sort();
            assert_eq!(pairs, wanted);
        }
    }
}

/// A run in which the arms of an axle go together hides no other in which they do not.
#[test]
fn wheels_swapped_are_found_in_the_one_run_that_tells_them_apart() {
    let large = |t: f64| 0.17 + 0.1 * (TAU * 0.05 * t).sin();
    let mut alike = swinging();
    for w in [Wheel::Fr, Wheel::Fl] {
        alike.insert(Channel::TargetStroke(w), series(large));
        alike.insert(Channel::Stroke(w), series(|t| large(t - 1.18)));
    }
    let mut apart = swinging();
    swap(&mut apart, [Wheel::Fr, Wheel::Fl].map(Channel::Stroke));
    let ([alike], [apart]) = (signals(&alike), signals(&apart));
    assert_eq!(swapped_wheels(std::slice::from_ref(&alike), &Machine::xt28()), None);
    let found = swapped_wheels(&[alike, apart], &Machine::xt28()).expect("they are swapped");
    assert_eq!(found.pairs, [(Wheel::Fr, Wheel::Fl), (Wheel::Fl, Wheel::Fr)]);
}

/// A stuck arm, a slow one and one that goes the wrong way are faults, not an order of wheels.
#[test]
fn a_fault_of_an_arm_is_no_swap() {
    for fault in [|_: f64| 0.0, |t: f64| 0.002 * t, |t: f64| -0.03 * (TAU * 0.05 * t).sin()] {
        let mut all = swinging();
        all.insert(Channel::Stroke(Wheel::Fr), series(|t| 0.17 + fault(t)));
        assert_eq!(swapped_wheels(&signals(&all), &Machine::xt28()), None);
    }
}

/// Loads that come as `load_n` says of each wheel, with the pressures that make them.
fn pressed(load_n: impl Fn(Wheel, f64) -> f64) -> BTreeMap<Channel, Series> {
    let arms = Machine::xt28().arms;
    let mut all = swinging();
    for w in Wheel::ALL {
        all.insert(Channel::CylinderLoad(w), series(|t| load_n(w, t)));
        all.insert(Channel::RodPressure(w), series(|_| 1.0e6));
        let bore = |t| (load_n(w, t) + 1.0e6 * arms.area_rod_m2) / arms.area_bore_m2;
        all.insert(Channel::BorePressure(w), series(bore));
    }
    all
}

fn swap(all: &mut BTreeMap<Channel, Series>, [a, b]: [Channel; 2]) {
    let (of_a, of_b) = (all[&a].clone(), all[&b].clone());
    all.insert(a, of_b);
    all.insert(b, of_a);
}

/// The ECU makes the load of the pressures, so that they agree whatever is wrong with the machine.
#[test]
fn pressures_of_another_wheel_are_found() {
    const PHASES: [f64; 6] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
    let mut all = pressed(|w, t| 3.0e4 + 8.0e3 * (0.3 * t + PHASES[w.index()]).sin());
    assert_eq!(swapped_wheels(&signals(&all), &Machine::xt28()), None);
    swap(&mut all, [Wheel::Fr, Wheel::Fl].map(Channel::BorePressure));
    let found = swapped_wheels(&signals(&all), &Machine::xt28()).expect("they are swapped");
    assert_eq!(found.between, ["pressures", "load"]);
    assert_eq!(found.pairs, [(Wheel::Fr, Wheel::Fl), (Wheel::Fl, Wheel::Fr)]);
}

/// Two arms that carry the same say nothing of their order.
#[test]
fn pressures_of_arms_that_carry_alike_are_in_order() {
    let all = pressed(|w, t| {
        3.0e4 + 8.0e3 * (0.3 * t + f64::from(u8::from(w.name().starts_with('F')))).sin()
    });
    assert_eq!(swapped_wheels(&signals(&all), &Machine::xt28()), None);
}
