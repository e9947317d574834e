//! The nominal foreign machine against the bench's own: how far two models of it lie apart.
//!
//! The bounds are those that every replay of a nominal machine's log is held to.
#![allow(clippy::disallowed_macros)] // the table is what the test is for

use std::path::Path;

use xt28_gap::{About, Decoder, FieldLog, Mapping, Replay, Report};
use xt28_gap_plants::{Case, Manoeuvre};
use xt28_machine::Machine;
use xt28_sim::Effects;

fn replay(manoeuvre: Manoeuvre) -> Report {
    let case = Case::nominal(3).only(manoeuvre, 30.0);
    let about = About::parse(&case.about(), Path::new("about.toml")).unwrap();
    let terrain = about.run[0].terrain().unwrap();
    let (name, bytes) = case.logs().unwrap().remove(0);
    let decoder =
        Decoder::parse(xt28_dbc::XT28_DBC, Path::new("xt28.dbc"), &Mapping::default()).unwrap();
    let input = std::io::BufReader::new(flate2::read::GzDecoder::new(bytes.as_slice()));
    let log = FieldLog::read(input, &name, &decoder, false).unwrap();
    let replay = Replay::run(&log, &Machine::xt28(), &Effects::default(), &terrain).unwrap();
    let report = replay.report(&log, Path::new("xt28.dbc"));
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
fn driving_manoeuvres_are_in_bounds() {
    for manoeuvre in [Manoeuvre::Straight, Manoeuvre::STurn, Manoeuvre::Mixed] {
        assert_eq!(out(&replay(manoeuvre)), [""; 0], "{manoeuvre:?}");
    }
}

#[test]
fn the_ramp_is_in_bounds() {
    assert_eq!(out(&replay(Manoeuvre::Ramp)), [""; 0]);
}
