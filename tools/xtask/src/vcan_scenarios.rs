//! `cargo xtask vcan-scenarios`: emulator, gateway and candump as programs on a real vcan0.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::thread;

use cargo_metadata::{Artifact, Message};
use clap::Args;

use crate::guest::Guest;
use crate::harness::{Reader, Report, on_ci};
use crate::side_by_side;
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
        // Of the whole workspace, so that features are those of the other stages, and what these
        // have built is not built again with fewer.
        let built = build(&workspace.root, &["build", "--workspace", "--bins"])?;
        let named: Vec<_> = TESTS.iter().map(|of| format!("--test={}", of.test)).collect();
        let mut arguments = vec!["test", "--no-run", "--workspace"];
        arguments.extend(named.iter().map(String::as_str));
        let with_tests = build(&workspace.root, &arguments)?;
        let tests = TESTS.iter().map(|Test { folder, test, .. }| {
            let manifest = workspace.root.join(folder).join("Cargo.toml");
            let own = with_tests.iter().filter(|artifact| artifact.manifest_path == manifest);
            executable(own, test)
        });
        let tests = tests.collect::<Outcome<Vec<_>>>()?;
        let logs = workspace.target.join("vcan-scenarios");
        fs::create_dir_all(&logs)?;
        Ok(Self { xt28: executable(built.iter(), "xt28")?, tests, cache, logs })
    }

    /// Runs all of it in guests, as many at a time as there are lanes.
    fn run(&self, work: &[Work], lanes: usize, report: &mut Report) {
        let commands = work.iter().map(|work| self.command(work)).collect();
        side_by_side::run(commands, lanes, |index, done| {
            println!("--- {}\n{}", work[index].name(), done.said.trim_end());
            match &work[index] {
                Work::Check(check) => {
                    let name = format!("vcan {}", check.log);
                    let outcome = self.judge(check, done.status);
                    report.tally += Tally::one(outcome.is_ok());
                    match outcome {
                        Ok(()) => println!("{name} ... ok"),
                        Err(why) => {
                            println!("{name} ... FAILED: {why}");
                            report.failures.push(name);
                        }
                    }
                }
                Work::Test(..) => {
                    let mut reader = Reader::default();
                    done.said.lines().for_each(|line| reader.line(line));
                    let tests = reader.end(done.status.is_ok_and(|status| status.success()));
                    report.tally += tests.tally;
                    report.failures.extend(tests.failures);
                }
            }
        });
    }

    /// This very program as `vcan`, and what is to run in the guest.
    fn command(&self, work: &Work) -> Command {
        let own = std::env::current_exe().unwrap_or_else(|_| PathBuf::from("xtask"));
        let mut command = Command::new(own);
        command.args(["vcan", "--timeout", TIMEOUT_S, "--cache"]).arg(&self.cache);
        if work.virtual_time() {
            command.arg("--virtual-time");
        }
        command.arg("--");
        match work {
            Work::Check(check) => command
                .arg(&self.xt28)
                .args(["run", check.scenario, "--bus", "vcan0", "--record"])
                .arg(self.log(check.log)),
            Work::Test(_, program) => {
                command.arg(program).arg("--nocapture").env("XT28_VCAN", "vcan0")
            }
        };
        command
    }

    fn log(&self, name: &str) -> PathBuf {
        self.logs.join(format!("{name}.log"))
    }

    /// Whether a scenario that has ended came to what it must.
    fn judge(&self, check: &Check, status: io::Result<ExitStatus>) -> Outcome<()> {
        let status = status?;
        // 1 is a verdict: asserted where it cannot depend on what else the machine does.
        if !status.success() && (check.virtual_time || status.code() != Some(1)) {
            return Err(format!("xt28 ended with {status}").into());
        }
        let log = self.log(check.log);
        let logged = fs::read(&log).map_err(|error| format!("{}: {error}", log.display()))?;
        if logged.is_empty() {
            return Err("candump logged nothing".into());
        }
        let Some(earlier) = check.repeats else { return Ok(()) };
        same(&fs::read(self.log(earlier))?, &logged)
    }
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

fn executable<'a>(built: impl Iterator<Item = &'a Artifact>, name: &str) -> Outcome<PathBuf> {
    let found = built.filter(|artifact| artifact.target.name == name);
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
