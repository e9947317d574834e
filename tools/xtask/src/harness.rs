//! What test programs say of their tests, read as it comes.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use crate::tally::Tally;
use crate::workspace::Outcome;

/// Whether this is a CI machine, where nothing may be left out.
pub(crate) fn on_ci() -> bool {
    std::env::var_os("CI").is_some_and(|ci| ci != "false" && !ci.is_empty())
}

/// What came of a stage.
#[derive(Default, PartialEq, Debug)]
pub(crate) struct Report {
    pub(crate) tally: Tally,
    /// Names of what failed, where it has names.
    pub(crate) failures: Vec<String>,
}

impl Report {
    /// The counts, or nothing where nothing was counted.
    pub(crate) fn counts(&self) -> String {
        if self.tally == Tally::default() { String::new() } else { self.tally.to_string() }
    }

    /// A check or stage that names no tests: counted only if it failed.
    pub(crate) fn unnamed(passed: bool) -> Self {
        Tally { failed: u32::from(!passed), ..Tally::default() }.into()
    }
}

impl From<Tally> for Report {
    fn from(tally: Tally) -> Self {
        Self { tally, failures: Vec::new() }
    }
}

/// What a test says, past the harness that keeps the words of those that pass, when it cannot do its work here.
const SKIPPED: &str = "SKIPPED: ";

/// Reads a harness's output line by line.
#[derive(Default)]
pub(crate) struct Reader {
    report: Report,
    skipped: u32,
}

impl Reader {
    /// Takes one line of it.
    pub(crate) fn line(&mut self, line: &str) {
        self.report.tally += Tally::of_line(line).unwrap_or_default();
        self.skipped += u32::from(line.contains(SKIPPED));
        self.report.failures.extend(failed_test(line).map(str::to_owned));
    }

    /// What came of it all, its program having ended well or not.
    pub(crate) fn end(self, success: bool) -> Report {
        let Self { mut report, skipped } = self;
        // Such a test returns like one that has passed.
        report.tally.passed = report.tally.passed.saturating_sub(skipped);
        report.tally.skipped += skipped;
        // It did not compile, or a test brought its whole program down.
        if !success && report.tally.failed == 0 {
            report.tally.failed = 1;
        }
        report
    }
}

/// Runs a command whose tests tell their results, passing its output on as it comes.
pub(crate) fn harness(command: &mut Command) -> Report {
    let mut reader = Reader::default();
    let mut read_and_wait = || -> Outcome<bool> {
        let mut child = command.stdout(Stdio::piped()).spawn()?;
        let output = child.stdout.take().ok_or("no output to read")?;
        for line in BufReader::new(output).split(b'\n') {
            let line = line?;
            let line = String::from_utf8_lossy(&line);
            println!("{line}");
            reader.line(&line);
        }
        Ok(child.wait()?.success())
    };
    let success = read_and_wait().unwrap_or_else(|error| {
        println!("{command:?}: {error}");
        false
    });
    reader.end(success)
}

/// The name in a harness's line `test NAME ... FAILED`.
fn failed_test(line: &str) -> Option<&str> {
    line.strip_prefix("test ")?.strip_suffix(" ... FAILED")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str) -> Report {
        harness(Command::new("sh").args(["-c", script]))
    }

    #[test]
    fn result_lines_add_up() {
        let line = "echo 'test result: ok. 2 passed; 0 failed; 1 ignored; 0 measured'";
        let sum = Tally { passed: 4, failed: 0, skipped: 2 };
        assert_eq!(shell(&format!("{line}; {line}")), sum.into());
    }

    #[test]
    fn a_test_that_says_it_was_skipped_has_not_passed() {
        let lines =
            "echo 'SKIPPED: no candump'; echo 'test result: ok. 2 passed; 0 failed; 0 ignored'";
        assert_eq!(shell(lines), Tally { passed: 1, failed: 0, skipped: 1 }.into());
    }

    #[test]
    fn a_failure_without_a_result_line_counts() {
        assert_eq!(shell("exit 101"), Tally::one(false).into());
    }

    #[test]
    fn what_failed_is_counted_and_named() {
        let line = "echo 'test a::b ... FAILED'; echo 'test a::c ... ok'";
        let result = "echo 'test result: FAILED. 1 passed; 1 failed; 0 ignored'; exit 101";
        let report = shell(&format!("{line}; {result}"));
        assert_eq!(report.tally, Tally { passed: 1, failed: 1, skipped: 0 });
        assert_eq!(report.failures, ["a::b"]);
    }
}
