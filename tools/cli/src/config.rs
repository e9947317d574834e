//! `xt28 config show`: the machine's numbers in force.

use std::path::PathBuf;

use clap::{Args, Subcommand};
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
}

impl Config {
    pub(crate) fn execute(&self) -> Result<Verdict, Failure> {
        let Action::Show { machine } = &self.action;
        let Some(path) = machine else {
            say!("{}", Machine::builtin_text());
            return Ok(Verdict::Positive);
        };
        Machine::load(path)?;
        let text = std::fs::read_to_string(path)?;
        say!("{text}");
        // The one section a file may leave out; what then holds is part of what is in force.
        let optional = Machine::builtin_text().split_once("[vehicle]");
        if let Some((_, section)) = optional.filter(|_| !has_section(&text, "[vehicle]")) {
            say!("\n# Not in {}: the built-in values hold.\n[vehicle]{section}", path.display());
        }
        Ok(Verdict::Positive)
    }
}

fn has_section(text: &str, header: &str) -> bool {
    text.lines().any(|line| line.trim_start().starts_with(header))
}
