//! The nominal foreign machine against the bench's own: how far two models of it lie apart.
//!
//! The bounds are those that every replay of a nominal machine's log is held to.
#![allow(clippy::disallowed_macros)] // the table is what the test is for

use std::path::Path;

use xt28_gap::{About, Decoder, FieldLog, Mapping, Replay, Report};
use xt28_gap_plants::{Case, Manoeuvre};
use xt28_machine::Machine;
use xt28_sim::{Effects, Solver};

fn replay(manoeuvre: Manoeuvre) -> Report {
    let case = Case::nominal(3).only(manoeuvre, 30.0);
    let about = About::parse(&case.about(), Path::new("about.toml")).unwrap();
    let terrain = about.run[0].terrain().unwrap();
    let (name, bytes) = case.logs().unwrap().remove(0);
    let decoder =
        Decoder::parse(&Case::dbc(), Path::new("xt28-field.dbc"), &Mapping::default()).unwrap();
    let input = std::io::BufReader::new(flate2::read::GzDecoder::new(bytes.as_slice()));
    let log = FieldLog::read(input, &name, &decoder, false).unwrap();
    let replay =
        Replay::run(&log, &Machine::xt28(), &Effects::default(), Solver::Rapier, &terrain).unwrap();
    let report = replay.report(&log, Path::new("xt28-field.dbc"));
    eprintln!("{}", report.table());
    report
}

/// Signals out of bounds.
fn out(report: &Report) -> Vec<&str> {
    let rows = report.rows.iter().filter(|row| row.passed == Some(false));
    rows.map(|row| row.signal.as_str()).collect()
}

#[test]
fn standing_manoeuvres_are_in_bounds() {
    for manoeuvre in [Manoeuvre::ArmStep, Manoeuvre::SingleArm, Manoeuvre::Multisine] {
        assert_eq!(out(&replay(manoeuvre)), [""; 0], "{manoeuvre:?}");
    }
}

#[test]
fn driving_is_in_bounds() {
    for manoeuvre in [Manoeuvre::Straight, Manoeuvre::STurn] {
        assert_eq!(out(&replay(manoeuvre)), [""; 0], "{manoeuvre:?}");
    }
}

/// Six wheels on three stiff frames stand on whichever the strokes leave down. Wheels that hang run
/// off at other moments in two models, and the mean of their circuit, which is held, takes the
/// others along. Everything but wheel speeds is in bounds.
#[test]
fn over_a_ramp_and_with_arms_moving_only_wheel_speeds_part() {
    for manoeuvre in [Manoeuvre::Ramp, Manoeuvre::Mixed] {
        let report = replay(manoeuvre);
        for row in report.rows.iter().filter(|row| row.passed == Some(false)) {
            assert!(row.signal.starts_with("wheel_speed"), "{manoeuvre:?}: {}", row.signal);
            assert!(row.errors.rmse < 0.08, "{manoeuvre:?}: {} {}", row.signal, row.errors.rmse);
        }
    }
}
