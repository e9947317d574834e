//! Every built-in scenario runs on the virtual bus, closed loop, and all it expects holds.

use std::io;
use std::time::Duration;

use xt28_machine::SimTime;
use xt28_scenarios::{Finding, Lockstep, Recording, Report, Scenario, Setup};
use xt28_sim::Solver;

fn setup(name: &str) -> Setup {
    Setup::new(Scenario::find(name).unwrap(), None).unwrap()
}

fn run(setup: &Setup, log: impl io::Write) -> Recording {
    let mut run = Lockstep::new(setup, log).unwrap();
    while run.tick(&mut || Duration::ZERO).unwrap().is_some() {}
    run.finish().unwrap()
}

fn holds(name: &str, solver: Solver) -> Report {
    let setup = Setup { solver, ..setup(name) };
    let report = run(&setup, io::sink()).report(&setup, "virtual");
    assert!(report.passed(), "\n{}", report.table());
    report
}

macro_rules! scenarios {
    ($($test:ident: $name:literal),* $(,)?) => {
        $(#[test] fn $test() { holds($name, Solver::Rapier); })*

        mod on_the_fast_core {
            use super::*;

            $(#[test] fn $test() { holds($name, Solver::Reduced); })*
        }

        #[test]
        fn no_scenario_is_left_out() {
            let tested = [$($name),*];
            for (name, _) in xt28_scenarios::BUILTIN {
                assert!(tested.contains(name), "{name} has no test here");
            }
        }
    };
}

scenarios! {
    straight_25m: "straight-25m",
    turn_left: "turn-left",
    turn_right: "turn-right",
    s_turn: "s-turn",
    arm_steps: "arm-steps",
    arm_step_response: "arm-step-response",
    ramp: "ramp",
    ramp_locked: "ramp-locked",
    ramp_automatic: "ramp-automatic",
    ramp_automatic_late: "ramp-automatic-late",
    cross_slope: "cross-slope",
    bumpy_field: "bumpy-field",
    bumpy_field_locked: "bumpy-field-locked",
    kerb: "kerb",
    command_loss: "command-loss",
    emergency_stop: "emergency-stop",
    brown_out: "brown-out",
    reboot: "reboot",
    broken_wire: "broken-wire",
    false_stroke: "false-stroke",
    cross_slope_2016: "2016-cross-slope",
    pedal_2016: "2016-pedal",
    bend_2016: "2016-bend",
}

#[test]
fn twice_the_same_seed_is_twice_the_same_log_and_another_seed_another() {
    let setup = setup("command-loss");
    let (mut first, mut second) = (Vec::new(), Vec::new());
    let hash = run(&setup, &mut first).log_sha256;
    assert_eq!(hash, run(&setup, &mut second).log_sha256);
    assert_eq!(first, second);
    let other = Setup { seed: setup.seed + 1, ..setup };
    assert_ne!(hash, run(&other, io::sink()).log_sha256);
}

#[test]
fn a_run_is_judged_by_what_its_log_holds() {
    let setup = setup("command-loss");
    let mut log = Vec::new();
    let recording = run(&setup, &mut log);
    let read = Recording::read(log.as_slice(), "run.log", SimTime::ZERO).unwrap();
    assert_eq!(read, recording.trace);
    let judged: Vec<Finding> = setup.judge(&read, None);
    assert!(judged.iter().all(Finding::passed), "{judged:?}");
}
