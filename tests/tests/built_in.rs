//! What the built-in scenarios must see: a machine that does not move, ground that is not there, and a stop that
//! comes late.

use std::io;
use std::path::Path;
use std::time::Duration;

use xt28_machine::{Machine, PerWheel};
use xt28_scenarios::{
    BUILTIN, Evidence, Expectation, Finding, Ground, Lockstep, Report, Scenario, Setup, Trace,
};
use xt28_sim::Solver;

fn run(scenario: Scenario) -> Report {
    let setup = Setup { solver: Solver::Reduced, ..Setup::new(scenario, None).unwrap() };
    let mut run = Lockstep::new(&setup, io::sink()).unwrap();
    while run.tick(&mut || Duration::ZERO).unwrap().is_some() {}
    run.finish().unwrap().report(&setup, "virtual")
}

/// All built-in scenarios are of a machine that moves, by itself or by its operator's hand.
#[test]
fn no_scenario_holds_of_a_machine_that_nobody_moves() {
    for (name, _) in BUILTIN {
        let mut scenario = Scenario::find(name).unwrap();
        scenario.drive_by("hold").unwrap();
        (scenario.operator, scenario.cab) = (None, None);
        let report = run(scenario);
        assert!(!report.passed(), "\n{}", report.table());
    }
}

#[test]
fn no_scenario_with_a_terrain_holds_on_level_ground() {
    let level = Ground::default();
    for (name, _) in BUILTIN {
        let mut scenario = Scenario::find(name).unwrap();
        if scenario.terrain != level {
            scenario.terrain = level.clone();
            let report = run(scenario);
            assert!(!report.passed(), "\n{}", report.table());
        }
    }
}

/// Wheels that turn until `until_s`, in a run of `duration_s`.
fn rolling(until_s: f64, duration_s: f64) -> Trace {
    let mut trace = Trace::default();
    let mut at_s = 0.0;
    while at_s < duration_s {
        let speed_rad_s = if at_s < until_s { 1.0 } else { 0.0 };
        trace.wheel_speed_rad_s.push(at_s, PerWheel::splat(speed_rad_s));
        trace.antenna_m.push(at_s, [0.0, 0.0]);
        trace.end_s = at_s;
        at_s += 0.01;
    }
    trace
}

#[test]
fn a_stop_that_takes_five_seconds_is_seen() {
    for name in ["command-loss", "emergency-stop", "reboot"] {
        let scenario = Scenario::find(name).unwrap();
        let stop_s = scenario.events[0].at_s;
        let stands = |after_s: f64| {
            let trace = rolling(stop_s + after_s, scenario.duration_s);
            let machine = Machine::xt28();
            let evidence = Evidence {
                scenario: &scenario,
                machine: &machine,
                payload_kg: 0.0,
                trace: &trace,
                truth: None,
            };
            let standing = |e: &&Expectation| matches!(e, Expectation::StandsStill(_));
            let expectation = scenario.expectations.iter().find(standing).unwrap();
            expectation.judge(&evidence).iter().all(Finding::passed)
        };
        assert!(stands(0.9), "{name}");
        assert!(!stands(2.1) && !stands(5.0), "{name}");
    }
}

/// On a slope beyond the safety kernel's the gateway never arms, and nothing that is then asked was driven.
#[test]
fn a_run_whose_gateway_never_arms_has_failed() {
    let report = |grade: f64| {
        let text = format!(
            "title = \"t\"\npolicy = \"hold\"\nduration_s = 2\n[terrain.slope]\ngrade = {grade}\n\
             [[expect]]\nstands-still = {{ below_m_s = 100 }}\n"
        );
        let nothing = |_: &Path| Err(io::ErrorKind::NotFound.into());
        run(Scenario::parse(&text, Path::new("t.toml"), nothing).unwrap())
    };
    assert!(report(0.1).passed(), "\n{}", report(0.1).table());
    let steep = report(0.7);
    let [unarmed] = steep.findings.iter().filter(|f| !f.passed()).collect::<Vec<_>>()[..] else {
        panic!("\n{}", steep.table())
    };
    assert!(unarmed.what == "gateway armed" && unarmed.note.contains("pitch"), "{unarmed:?}");
}
