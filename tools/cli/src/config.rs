//! `xt28 config`: the machine's numbers in force, and where a log's channels are found.

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use xt28_gap::Mapping;
use xt28_machine::Machine;

use crate::say::say;
use crate::{Failure, Verdict};

/// Show what is in force
#[derive(Args)]
pub(crate) struct Config {
    #[command(subcommand)]
    action: Action,
}

#[derive(Subcommand)]
enum Action {
    /// Print the machine file in force: every number with its unit in the key
    Show {
        /// Machine file (TOML); the built-in machine when left out
        #[arg(long, value_name = "FILE")]
        machine: Option<PathBuf>,
    },
    /// Print the built-in mapping of a log's signals to channels, as a start for a `--mapping` of your own
    Mapping,
}

impl Config {
    pub(crate) fn execute(&self) -> Result<Verdict, Failure> {
        match &self.action {
            Action::Show { machine: Some(path) } => show(path)?,
            Action::Show { machine: None } => say!("{}", Machine::builtin_text()),
            Action::Mapping => say!("{}", Mapping::builtin_text()),
        }
        Ok(Verdict::Positive)
    }
}

/// Prints the machine file at `path`, once it has been accepted.
fn show(path: &Path) -> Result<(), Failure> {
    Machine::load(path)?;
    let text = std::fs::read_to_string(path)?;
    say!("{text}");
    for header in OPTIONAL.into_iter().filter(|header| !has_section(&text, header)) {
        if let Some(section) = builtin_section(header) {
            say!("\n# Not in {}: the built-in values hold.\n{section}", path.display());
        }
    }
    Ok(())
}

/// The sections that a file may leave out; what then holds is part of what is in force.
const OPTIONAL: [&str; 2] = ["[vehicle]", "[levelling]"];

fn has_section(text: &str, header: &str) -> bool {
    text.lines().any(|line| line.replace(' ', "").starts_with(header))
}

/// A section of the built-in machine file, its header included.
fn builtin_section(header: &str) -> Option<&'static str> {
    let text = Machine::builtin_text();
    let section = &text[text.find(&format!("\n{header}"))? + 1..];
    Some(section.find("\n[").map_or(section, |end| &section[..end]))
}
