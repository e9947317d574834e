//! What runs lack, and whose wheels they are: on made-up signals, each with one thing the matter.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use xt28_gap::diagnosis::{Signals, not_testable, swapped_wheels};
use xt28_gap::{Channel, Series, Terrain};
use xt28_machine::Wheel;
use xt28_sim::effects::CATALOGUE;

const SECONDS: f64 = 20.0;

/// A channel over the run.
fn series(value: impl Fn(f64) -> f64) -> Series {
    (0..2000).map(|i| f64::from(i) * 0.01).map(|at_s| (at_s, value(at_s))).collect()
}

/// A machine that stands with all arms held.
fn standing() -> BTreeMap<Channel, Series> {
    let zero = Channel::all().into_iter().map(|channel| (channel, series(|_| 0.0)));
    let mut all: BTreeMap<Channel, Series> = zero.collect();
    for w in Wheel::ALL {
        all.insert(Channel::CylinderLoad(w), series(|_| 60e3));
        all.insert(Channel::Stroke(w), series(|_| 0.17));
        all.insert(Channel::TargetStroke(w), series(|_| 0.17));
    }
    all.insert(Channel::ArmMode, series(|_| 2.0));
    for receiver in [Channel::East, Channel::North, Channel::Heading] {
        all.remove(&receiver);
    }
    all
}

fn signals(all: &BTreeMap<Channel, Series>) -> [Signals; 1] {
    [Signals::of_series("made up", all, SECONDS, Terrain::Flat).unwrap()]
}

/// The same with every arm swinging at a frequency of its own, 30 mm each way.
fn swinging() -> BTreeMap<Channel, Series> {
    let mut all = standing();
    for (k, w) in (0_u8..).zip(Wheel::ALL) {
        let phase = move |at_s: f64| TAU * (0.05 + 0.02 * f64::from(k)) * at_s;
        let late = 1.18 * TAU * (0.05 + 0.02 * f64::from(k));
        all.insert(Channel::TargetStroke(w), series(|t| 0.17 + 0.03 * phase(t).sin()));
        let swing =
            move |t: f64| 0.03 / (1.0 + late * late).sqrt() * (phase(t) - late.atan()).sin();
        all.insert(Channel::Stroke(w), series(|t| ((0.17 + swing(t)) * 1e3).floor() * 1e-3));
        let speed = move |t: f64| swing(t + 0.01) - swing(t);
        let current = |on: bool| if on { 0.44 } else { 0.0 };
        all.insert(Channel::ExtendCurrent(w), series(|t| current(speed(t) > 0.0)));
        all.insert(Channel::RetractCurrent(w), series(|t| current(speed(t) < 0.0)));
    }
    all
}

fn lacks(all: &BTreeMap<Channel, Series>, effect: &str) -> Option<(String, String)> {
    let catalogue: Vec<_> = CATALOGUE.iter().collect();
    let found = not_testable(&signals(all), &catalogue);
    let one = found.into_iter().find(|one| one.effect.name == effect)?;
    Some((one.lacks, one.manoeuvre))
}

#[test]
fn a_machine_that_only_stands_shows_neither_arms_nor_steering_nor_drive() {
    let all = standing();
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
fn arms_that_stand_while_others_move_are_named() {
    let mut all = swinging();
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
    assert_eq!(swapped_wheels(&signals(&swinging())), None);
    assert_eq!(swapped_wheels(&signals(&standing())), None);
}

#[test]
fn every_two_wheels_swapped_are_found() {
    for a in Wheel::ALL {
        for b in Wheel::ALL.into_iter().filter(|b| a != *b) {
            let mut all = swinging();
            let (of_a, of_b) = (all[&Channel::Stroke(a)].clone(), all[&Channel::Stroke(b)].clone());
            all.insert(Channel::Stroke(a), of_b);
            all.insert(Channel::Stroke(b), of_a);
            let swap = swapped_wheels(&signals(&all)).unwrap_or_else(|| panic!("{a} {b}"));
            assert_eq!(swap.between, ["target", "stroke"]);
            let mut pairs = swap.pairs;
            pairs.sort();
            let mut wanted = vec![(a, b), (b, a)];
            wanted.sort();
            assert_eq!(pairs, wanted);
        }
    }
}

/// A stuck arm, a slow one and one that goes the wrong way are faults, not an order of wheels.
#[test]
fn a_fault_of_an_arm_is_no_swap() {
    for fault in [|_: f64| 0.0, |t: f64| 0.002 * t, |t: f64| -0.03 * (TAU * 0.05 * t).sin()] {
        let mut all = swinging();
        all.insert(Channel::Stroke(Wheel::Fr), series(|t| 0.17 + fault(t)));
        assert_eq!(swapped_wheels(&signals(&all)), None);
    }
}
