//! `cargo xtask test`: everything that must hold, as one command with one last line.

use std::process::Command;
use std::time::Instant;

use clap::{Args, ValueEnum};

use crate::harness::{Report, harness, on_ci};
use crate::tally::Tally;
use crate::tidy;
use crate::vcan::Cache;
use crate::vcan_scenarios;
use crate::workspace::{Outcome, Workspace};

/// Run everything that must hold, and end with one line `N passed, N failed`
///
/// All stages run, whatever came of those before: one run shows all that is wrong. A stage that
/// fails without naming a test counts as one failed. Where no vcan0 can be had, what needs one is
/// skipped and said so; where CI is set, that is a failure. What failed is listed again at the end.
#[derive(Args)]
pub(crate) struct Test {
    /// Leave out what needs a real vcan0; refused where CI is set
    #[arg(long)]
    no_vcan: bool,
    /// Run this stage alone
    #[arg(long, value_enum, value_name = "STAGE")]
    only: Option<Stage>,
    #[command(flatten)]
    cache: Cache,
}

/// The parts of the test, in their order.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Stage {
    /// cargo fmt --check
    Fmt,
    /// The house rules
    Tidy,
    /// cargo clippy, warnings refused
    Clippy,
    /// cargo doc, warnings refused
    Doc,
    /// Unit, property and scenario tests, released code
    Tests,
    /// Scenarios as separate programs on a real vcan0
    Vcan,
}

impl Stage {
    fn name(self) -> &'static str {
        match self {
            Self::Fmt => "fmt",
            Self::Tidy => "tidy",
            Self::Clippy => "clippy",
            Self::Doc => "doc",
            Self::Tests => "tests",
            Self::Vcan => "vcan",
        }
    }
}

impl Test {
    /// Runs the stages; 0 if nothing failed.
    ///
    /// # Errors
    /// When a stage is left out that must not be.
    pub(crate) fn execute(&self, workspace: &Workspace) -> Outcome<u8> {
        if self.no_vcan && on_ci() {
            return Err("--no-vcan is not for CI: what is not run there is not known".into());
        }
        let mut sum = Tally::default();
        let mut lines = Vec::new();
        for stage in Stage::value_variants() {
            if self.only.is_some_and(|only| only != *stage) {
                continue;
            }
            let name = stage.name();
            println!("\n=== {name}");
            let begun = Instant::now();
            let report = self.stage(*stage, workspace);
            let took = begun.elapsed().as_secs_f64();
            let verdict = if report.tally.failed > 0 { "FAILED" } else { "ok" };
            let line = format!("{name:<8} {verdict:<6} {took:>7.1} s   {}", report.counts());
            lines.push(line.trim_end().to_owned());
            lines.extend(report.failures.iter().map(|test| format!("         {test}")));
            sum += report.tally;
        }
        println!("\n=== summary");
        for line in lines {
            println!("{line}");
        }
        println!("{sum}");
        Ok(u8::from(sum.failed > 0))
    }

    fn stage(&self, stage: Stage, workspace: &Workspace) -> Report {
        let cargo = |arguments: &[&str]| {
            let mut command = Command::new(env!("CARGO"));
            command.current_dir(&workspace.root).args(arguments);
            command
        };
        match stage {
            Stage::Fmt => plain(&mut cargo(&["fmt", "--all", "--check"])),
            Stage::Tidy => tidy_stage(workspace),
            Stage::Clippy => plain(&mut cargo(&[
                "clippy",
                "--workspace",
                "--all-targets",
                "--release",
                "--locked",
                "--",
                "--deny=warnings",
            ])),
            Stage::Doc => {
                let mut doc = cargo(&["doc", "--workspace", "--no-deps", "--release", "--locked"]);
                plain(doc.env("RUSTDOCFLAGS", "--deny=warnings"))
            }
            Stage::Tests => harness(&mut cargo(&[
                "test",
                "--workspace",
                "--release",
                "--locked",
                "--no-fail-fast",
            ])),
            Stage::Vcan if self.no_vcan => vcan_scenarios::left_out("--no-vcan was given"),
            Stage::Vcan => vcan_scenarios::run_all(workspace, &self.cache),
        }
    }
}

/// A stage that names no tests.
fn plain(command: &mut Command) -> Report {
    Report::unnamed(command.status().is_ok_and(|status| status.success()))
}

fn tidy_stage(workspace: &Workspace) -> Report {
    match tidy::check(workspace) {
        Ok(found) => {
            for finding in &found {
                println!("{finding}");
            }
            Report::unnamed(found.is_empty())
        }
        Err(error) => {
            println!("{error}");
            Report::unnamed(false)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stage_that_names_no_tests_counts_where_it_fails() {
        assert_eq!(plain(&mut Command::new("false")), Tally::one(false).into());
        assert_eq!(plain(&mut Command::new("true")), Report::default());
    }
}
