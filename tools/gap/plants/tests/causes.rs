//! Every cause shows in the signal that it is said to show in, against its own machine without it.
#![allow(clippy::disallowed_macros)] // the table is what one wants to see when a cause fades

use std::io::BufReader;
use std::path::Path;

use flate2::read::GzDecoder;
use xt28_gap::{Channel, Decoder, Errors, FieldLog, Mapping, PumpSide, SteerSide};
use xt28_gap_plants::{CAUSES, Case, Cause, Kind, Manoeuvre, Scope, Scopes};
use xt28_machine::{Axle, Wheel};

/// Part of the run that is enough to see a cause in, s.
const SECONDS: f64 = 14.0;
/// A cause is seen when the signal moves this often by its floor.
const SEEN: f64 = 2.0;
const SEED: u64 = 21;

fn log(case: &Case) -> FieldLog {
    let (name, bytes) = case.logs().unwrap().remove(0);
    let decoder =
        Decoder::parse(&Case::dbc(), Path::new("xt28-field.dbc"), &Mapping::default()).unwrap();
    let input = BufReader::new(GzDecoder::new(bytes.as_slice()));
    FieldLog::read(input, &name, &decoder, false).unwrap()
}

/// Channels of a signal, and the change of them that nobody would notice, in SI.
fn signal(name: &str) -> (Vec<Channel>, f64) {
    let wheels = |make: fn(Wheel) -> Channel| Wheel::ALL.map(make).to_vec();
    match name {
        "stroke" => (wheels(Channel::Stroke), 5.0e-4),
        "load" => (wheels(Channel::CylinderLoad), 400.0),
        "opening" => (wheels(Channel::ExtendCurrent), 3.0e-3),
        "joint" => (vec![Channel::FrontJoint, Channel::RearJoint], 1.0e-3),
        "steer" => (SteerSide::ALL.map(Channel::SteerCurrent).to_vec(), 6.0e-3),
        "wheel" => (wheels(Channel::WheelSpeed), 0.01),
        "pump" => (PumpSide::ALL.map(Channel::PumpPressure).to_vec(), 5.0e4),
        "position" => (vec![Channel::East, Channel::North], 0.02),
        "att" => (vec![Channel::Roll, Channel::Pitch], 1.0e-3),
        other => panic!("no signal {other}"),
    }
}

/// Root mean square of how uneven commands come, s.
fn unevenness_s(log: &FieldLog) -> f64 {
    let times: Vec<f64> =
        log.series(Channel::Throttle).unwrap().iter().map(|(at_s, _)| at_s).collect();
    let off = |pair: &[f64]| (pair[1] - pair[0] - 0.01).powi(2);
    (times.windows(2).map(off).sum::<f64>() / times.len() as f64).sqrt()
}

/// By how many floors the worst channel of the cause's signal moves.
fn seen(cause: &Cause, with: &FieldLog, without: &FieldLog) -> f64 {
    if cause.signal == "bus" {
        return (unevenness_s(with) - unevenness_s(without)) / 5.0e-4;
    }
    let (channels, floor) = signal(cause.signal);
    let moved = |channel: Channel| {
        let errors = Errors::between(with.series(channel)?, without.series(channel)?)?;
        Some(errors.rmse / floor)
    };
    channels.into_iter().filter_map(moved).fold(0.0, f64::max)
}

fn every_cause_shows(manoeuvres: &[Manoeuvre]) {
    let mut unseen = Vec::new();
    for &manoeuvre in manoeuvres {
        let mine = CAUSES.iter().filter(|cause| cause.shown_by == manoeuvre);
        let sound = log(&Case::draw(SEED, Kind::Null).only(manoeuvre, SECONDS));
        assert_eq!(sound.faults(), [], "{manoeuvre:?}");
        for cause in mine {
            let alike = cause.scopes != Scopes::Part;
            let scope = if alike { Scope::All } else { Scope::Axle(Axle::Front) };
            let case = Case::of(SEED, cause, scope).beginning_at(0.0);
            let floors = seen(cause, &log(&case.only(manoeuvre, SECONDS)), &sound);
            eprintln!("{:22} {:9} {:9} {floors:7.1}", cause.name, manoeuvre.name(), cause.signal);
            if floors < SEEN {
                unseen.push(cause.name);
            }
        }
    }
    assert_eq!(unseen, [""; 0]);
}

#[test]
fn causes_show_while_arms_move_in_steps() {
    every_cause_shows(&[Manoeuvre::ArmStep, Manoeuvre::SingleArm]);
}

#[test]
fn causes_show_while_arms_swing_and_in_bends() {
    every_cause_shows(&[Manoeuvre::Multisine, Manoeuvre::STurn]);
}

#[test]
fn causes_show_on_the_straight_and_on_the_ramp() {
    every_cause_shows(&[Manoeuvre::Straight, Manoeuvre::Ramp]);
}

#[test]
fn a_cause_that_begins_late_shows_only_then() {
    let cause = Cause::find("valve-gain").unwrap();
    let case = Case::of(SEED, cause, Scope::All).beginning_at(9.5).only(Manoeuvre::ArmStep, 14.0);
    let sound = log(&case.without_faults());
    let late = log(&case);
    let channel = Channel::Stroke(Wheel::Fr);
    let (with, without) = (late.series(channel).unwrap(), sound.series(channel).unwrap());
    let apart = |from_s: f64, to_s: f64| {
        let inside = with.iter().filter(|(at_s, _)| (from_s..to_s).contains(at_s));
        inside.map(|(at_s, m)| (m - without.at(at_s).unwrap()).abs()).fold(0.0, f64::max)
    };
    assert_eq!(apart(0.0, 9.5), 0.0);
    assert!(apart(9.5, 14.0) > 0.005, "{}", apart(9.5, 14.0));
}
