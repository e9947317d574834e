//! `cargo xtask vcan-scenarios`: emulator, gateway and candump as programs on a real vcan0.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use cargo_metadata::{Artifact, Message};
use clap::Args;

use crate::guest::Guest;
use crate::harness::{Report, harness, on_ci};
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
    package: &'static str,
    test: &'static str,
    virtual_time: bool,
}

const TESTS: &[Test] = &[
    Test { package: "xt28-bus", test: "socket_can", virtual_time: false },
    // A service tool gives up on an ECU that a loaded machine makes late.
    Test { package: "ecu-emu", test: "service_tool", virtual_time: true },
    Test { package: "ecu-emu", test: "wires", virtual_time: true },
];

/// How many checks [`run_all`] has, each test program counted as one.
#[allow(clippy::cast_possible_truncation)] // a handful
const COUNT: u32 = (CHECKS.len() + TESTS.len()) as u32;

/// Longest wall time of one check, s. In virtual time nothing else would end a run that hangs.
const TIMEOUT_S: &str = "600";

/// Says loudly that none of this was run, and counts it as skipped.
pub(crate) fn left_out(why: &str) -> Report {
    println!("LEFT OUT, nothing was tried on a real vcan0: {why}");
    Tally { skipped: COUNT, ..Tally::default() }.into()
}

/// Builds what is needed and runs every check.
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
    for check in CHECKS {
        let name = format!("vcan {}", check.log);
        let outcome = bench.check(check);
        report.tally += Tally::one(outcome.is_ok());
        match outcome {
            Ok(()) => println!("{name} ... ok"),
            Err(why) => {
                println!("{name} ... FAILED: {why}");
                report.failures.push(name);
            }
        }
    }
    for (test, program) in TESTS.iter().zip(&bench.tests) {
        let mut tests = bench.vcan(options(test.virtual_time));
        tests.arg(program).arg("--nocapture").env("XT28_VCAN", "vcan0");
        let tests = harness(&mut tests);
        report.tally += tests.tally;
        report.failures.extend(tests.failures);
    }
    report
}

/// What the checks run with: programs built outside, since a guest is slow at compiling.
struct Bench {
    xt28: PathBuf,
    tests: Vec<PathBuf>,
    cache: PathBuf,
    logs: PathBuf,
}

impl Bench {
    fn prepare(workspace: &Workspace, cache: &Cache) -> Outcome<Self> {
        let cache = cache.folder(&workspace.target)?;
        // First, for it may ask for packages: better at once than after the builds.
        Guest::prepare(&cache)?;
        let programs = ["--package=xt28", "--package=ecu-emu", "--package=gateway", "--bins"];
        let built = build(&workspace.root, &[&["build"][..], &programs].concat())?;
        let tests = TESTS.iter().map(|Test { package, test, .. }| {
            let (package, of) = (format!("--package={package}"), format!("--test={test}"));
            let built = build(&workspace.root, &["test", "--no-run", &package, &of])?;
            executable(&built, test)
        });
        let tests = tests.collect::<Outcome<Vec<_>>>()?;
        let logs = workspace.target.join("vcan-scenarios");
        fs::create_dir_all(&logs)?;
        Ok(Self { xt28: executable(&built, "xt28")?, tests, cache, logs })
    }

    /// This very program as `vcan`, with further arguments.
    fn vcan(&self, arguments: &[&str]) -> Command {
        let own = std::env::current_exe().unwrap_or_else(|_| PathBuf::from("xtask"));
        let mut command = Command::new(own);
        command.args(["vcan", "--timeout", TIMEOUT_S, "--cache"]).arg(&self.cache).args(arguments);
        command
    }

    fn check(&self, check: &Check) -> Outcome<()> {
        let time = if check.virtual_time { "in virtual time" } else { "in real time" };
        println!("--- {} on vcan0, {time}", check.scenario);
        let log = self.logs.join(format!("{}.log", check.log));
        let mut run = self.vcan(options(check.virtual_time));
        run.arg(&self.xt28).args(["run", check.scenario, "--bus", "vcan0", "--record"]).arg(&log);
        let status = run.status()?;
        // 1 is a verdict: asserted where it cannot depend on what else the machine does.
        if !status.success() && (check.virtual_time || status.code() != Some(1)) {
            return Err(format!("xt28 ended with {status}").into());
        }
        let logged = fs::read(&log).map_err(|error| format!("{}: {error}", log.display()))?;
        if logged.is_empty() {
            return Err("candump logged nothing".into());
        }
        let Some(earlier) = check.repeats else { return Ok(()) };
        same(&fs::read(self.logs.join(format!("{earlier}.log")))?, &logged)
    }
}

/// What goes before a command of the guest.
const fn options(virtual_time: bool) -> &'static [&'static str] {
    if virtual_time { &["--virtual-time", "--"] } else { &["--"] }
}

/// Whether two logs are the same, and the first line where they part.
fn same(first: &[u8], second: &[u8]) -> Outcome<()> {
    if first == second {
        return Ok(());
    }
    let mut lines = (1..).zip(first.split(|b| *b == b'\n').zip(second.split(|b| *b == b'\n')));
    let parted = lines.find(|(_, (a, b))| a != b).map_or_else(
        || "one is longer".to_owned(),
        |(line, (a, b))| {
            let [a, b] = [a, b].map(|text| String::from_utf8_lossy(text));
            format!("line {line} is `{a}` and `{b}`")
        },
    );
    Err(format!("a second run logged something else: {parted}").into())
}

/// Runs cargo and returns what it built.
fn build(root: &Path, arguments: &[&str]) -> Outcome<Vec<Artifact>> {
    let mut cargo = Command::new(env!("CARGO"))
        .current_dir(root)
        .args(arguments)
        .args(["--release", "--locked", "--message-format=json-render-diagnostics"])
        .stdout(Stdio::piped())
        .spawn()?;
    let output = cargo.stdout.take().ok_or("no output to read")?;
    let mut built = Vec::new();
    for message in Message::parse_stream(std::io::BufReader::new(output)) {
        if let Message::CompilerArtifact(artifact) = message? {
            built.push(artifact);
        }
    }
    let status = cargo.wait()?;
    if status.success() { Ok(built) } else { Err(format!("cargo {arguments:?}: {status}").into()) }
}

fn executable(built: &[Artifact], name: &str) -> Outcome<PathBuf> {
    let found = built.iter().filter(|artifact| artifact.target.name == name);
    let mut paths = found.filter_map(|artifact| artifact.executable.clone());
    Ok(paths.next().ok_or_else(|| format!("cargo built no {name}"))?.into_std_path_buf())
}

#[cfg(test)]
mod tests {
    use super::same;

    #[test]
    fn two_logs_part_at_a_line() {
        assert!(same(b"a\nb\n", b"a\nb\n").is_ok());
        let parted = same(b"a\nb\n", b"a\nc\n").unwrap_err().to_string();
        assert!(parted.ends_with("line 2 is `b` and `c`"), "{parted}");
        assert!(same(b"a\n", b"a\nb\n").is_err());
    }
}
