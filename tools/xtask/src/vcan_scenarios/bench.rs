//! What runs in guests: its programs, the commands that start it, and how its end is judged.

use std::fs;
use std::io;
use std::path::PathBuf;
use std::process::{Command, ExitStatus};

use super::build::{build, executable};
use super::{CHECKS, Check, TESTS, Test, Work};
use crate::guest::Guest;
use crate::harness::{Reader, Report};
use crate::side_by_side;
use crate::tally::Tally;
use crate::vcan::Cache;
use crate::workspace::{Outcome, Workspace};

/// Longest wall time of one check, s. In virtual time nothing else would end a run that hangs.
const TIMEOUT_S: &str = "600";

/// What the checks run with: programs built outside, since a guest is slow at compiling.
pub(super) struct Bench {
    xt28: PathBuf,
    /// One for each of [`TESTS`].
    pub(super) tests: Vec<PathBuf>,
    cache: PathBuf,
    logs: PathBuf,
}

impl Bench {
    /// Builds the programs, and the guest if there is none yet.
    ///
    /// # Errors
    /// When something is missing that only the administrator can install, or a build fails.
    pub(super) fn prepare(workspace: &Workspace, cache: &Cache) -> Outcome<Self> {
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
        // No log with the time of day is written over, and the last run's would stand in this one's way.
        for log in CHECKS.iter().map(|check| logs.join(format!("{}.log", check.log))) {
            if log.exists() {
                fs::remove_file(log)?;
            }
        }
        Ok(Self { xt28: executable(built.iter(), "xt28")?, tests, cache, logs })
    }

    /// Runs all of it in guests, as many at a time as there are lanes.
    pub(super) fn run(&self, work: &[Work], lanes: usize, report: &mut Report) {
        let commands = work.iter().map(|work| self.command(work)).collect();
        println!("{} to run, {lanes} at a time; each is told of when it is done", work.len());
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
                Work::Test(test, _) => {
                    let mut reader = Reader::default();
                    done.said.lines().for_each(|line| reader.line(line));
                    let name = format!("vcan tests of {}", test.test);
                    match &done.status {
                        Ok(status) if status.success() => (),
                        Ok(status) => println!("{name} ended with {status}"),
                        Err(error) => println!("{name} could not be run: {error}"),
                    }
                    let tests = reader.end(done.status.is_ok_and(|status| status.success()));
                    report.tally += tests.tally;
                    // Where what a test said came between its name and its end, the line names none.
                    let nameless = tests.tally.failed > 0 && tests.failures.is_empty();
                    report.failures.extend(nameless.then_some(name));
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
        let earlier = self.log(earlier);
        let first =
            fs::read(&earlier).map_err(|error| format!("{}: {error}", earlier.display()))?;
        same(&first, &logged)
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
