//! `cargo xtask vcan-scenarios`: emulator, gateway and candump as programs on a real vcan0.

mod bench;
mod build;

use std::path::Path;
use std::thread;

use clap::Args;

use self::bench::Bench;
use crate::guest::Guest;
use crate::harness::{Report, on_ci};
use crate::tally::Tally;
use crate::vcan::Cache;
use crate::workspace::{Outcome, Workspace};

/// Run the scenarios that use a real vcan0, as separate programs
///
/// In virtual time the physical expectations hold exactly as on the virtual bus, and two runs log
/// the same bytes. In real time a loaded machine may be late, so there the programs have to come
/// up, find each other and end as told; the expectations are printed, not asserted.
#[derive(Args)]
pub(crate) struct VcanScenarios {
    #[command(flatten)]
    cache: Cache,
}

impl VcanScenarios {
    /// Runs them all and prints the counts; 0 if none failed.
    ///
    /// # Errors
    /// None yet: what goes wrong is a failed check.
    pub(crate) fn execute(&self, workspace: &Workspace) -> Outcome<u8> {
        let tally = run_all(workspace, &self.cache).tally;
        println!("{tally}");
        Ok(u8::from(tally.failed > 0))
    }
}

/// One run of `xt28` on vcan0.
struct Check {
    scenario: &'static str,
    /// Name of its log, without `.log`, below `target/vcan-scenarios`.
    log: &'static str,
    virtual_time: bool,
    /// The log of an earlier check that this one has to repeat byte for byte.
    repeats: Option<&'static str>,
}

const CHECKS: &[Check] = &[
    exact("straight-25m"),
    exact("command-loss"),
    exact("emergency-stop"),
    exact("brown-out"),
    exact("arm-step-response"),
    exact("cross-slope"),
    exact("kerb"),
    exact("2016-cross-slope"),
    Check { log: "command-loss-again", repeats: Some("command-loss"), ..exact("command-loss") },
    Check { log: "command-loss-real-time", virtual_time: false, ..exact("command-loss") },
];

/// In virtual time, where nothing is late and every figure is exact.
const fn exact(scenario: &'static str) -> Check {
    Check { scenario, log: scenario, virtual_time: true, repeats: None }
}

/// A test program that uses a real bus where `XT28_VCAN` names one.
struct Test {
    /// Its package's folder.
    folder: &'static str,
    test: &'static str,
    virtual_time: bool,
}

const TESTS: &[Test] = &[
    Test { folder: "dbc/bus", test: "socket_can", virtual_time: false },
    // A service tool gives up on an ECU that a loaded machine makes late.
    Test { folder: "ecu-emu", test: "service_tool", virtual_time: true },
    Test { folder: "ecu-emu", test: "wires", virtual_time: true },
    Test { folder: "ecu-emu", test: "halt", virtual_time: true },
    Test { folder: "ecu-emu", test: "start", virtual_time: true },
    Test { folder: "gateway", test: "full_interface", virtual_time: true },
    Test { folder: "gateway", test: "full_disk", virtual_time: true },
    Test { folder: "tools/cli", test: "controller", virtual_time: true },
    Test { folder: "tools/cli", test: "network", virtual_time: true },
];

/// How many checks [`run_all`] has, each test program counted as one.
#[allow(clippy::cast_possible_truncation)] // a handful
const COUNT: u32 = (CHECKS.len() + TESTS.len()) as u32;

/// Says loudly that none of this was run, and counts it as skipped.
pub(crate) fn left_out(why: &str) -> Report {
    println!("LEFT OUT, nothing was tried on a real vcan0: {why}");
    Tally { skipped: COUNT, ..Tally::default() }.into()
}

/// Builds what is needed and runs every check.
///
/// Guests with clocks of their own run side by side, as nothing else that the machine does is felt
/// in them. What runs on its clock has it to itself, after them, and so has what repeats one of them.
pub(crate) fn run_all(workspace: &Workspace, cache: &Cache) -> Report {
    let out_of_reach = cache.folder(&workspace.target).ok().and_then(|c| Guest::out_of_reach(&c));
    if let Some(why) = out_of_reach.filter(|_| !on_ci()) {
        return left_out(&why);
    }
    let bench = match Bench::prepare(workspace, cache) {
        Ok(bench) => bench,
        Err(error) => {
            println!("{error}");
            return Tally { failed: COUNT, ..Tally::default() }.into();
        }
    };
    let mut report = Report::default();
    let checks = CHECKS.iter().map(Work::Check);
    let tests = TESTS.iter().zip(&bench.tests).map(|(test, program)| Work::Test(test, program));
    let (beside, alone): (Vec<_>, Vec<_>) = checks.chain(tests).partition(Work::bears_company);
    bench.run(&beside, thread::available_parallelism().map_or(1, usize::from), &mut report);
    bench.run(&alone, 1, &mut report);
    report
}

/// What runs in a guest.
enum Work<'a> {
    Check(&'static Check),
    /// And its program.
    Test(&'static Test, &'a Path),
}

impl Work<'_> {
    /// Whether it may run while others do.
    fn bears_company(&self) -> bool {
        let repeats = matches!(self, Self::Check(check) if check.repeats.is_some());
        self.virtual_time() && !repeats
    }

    /// What its output is headed by.
    fn name(&self) -> String {
        let time = if self.virtual_time() { "in virtual time" } else { "in real time" };
        match self {
            Self::Check(check) => format!("{} on vcan0, {time}", check.scenario),
            Self::Test(test, _) => format!("tests of {} on vcan0, {time}", test.test),
        }
    }

    fn virtual_time(&self) -> bool {
        match self {
            Self::Check(check) => check.virtual_time,
            Self::Test(test, _) => test.virtual_time,
        }
    }
}
