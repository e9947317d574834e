//! `xt28`: the one command people type. One file a subcommand.
#![forbid(unsafe_code)]
// A binary is the edge of the house: it reads clocks and arguments, and exits. It prints by `say` and `tell` alone.
#![allow(clippy::disallowed_methods)]

mod artefacts;
mod config;
mod effects;
mod files;
mod gap;
mod ground;
mod pace;
#[cfg(target_os = "linux")]
mod processes;
#[cfg(not(target_os = "linux"))]
#[path = "no_processes.rs"]
mod processes;
mod replay;
mod run;
mod say;
mod scenarios;
mod slips;

use std::error::Error;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

use crate::say::tell;

/// A bench for the Xt28: its two ECUs and a physics vehicle on a CAN bus, and what must hold.
///
/// Without a command: runs `straight-25m` and leaves a candump log and a picture in out/.
#[derive(Parser)]
#[command(version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    Run(run::Run),
    Replay(replay::Replay),
    Gap(gap::Gap),
    Scenarios(scenarios::Scenarios),
    Effects(effects::Effects),
    Config(config::Config),
}

/// What a command ends with, when nothing went wrong on the way.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Verdict {
    /// All is as wanted: exit status 0.
    Positive,
    /// Something measured is not as wanted: exit status 1.
    Negative,
}

/// What went wrong on the way, in one line: exit status 2.
type Failure = Box<dyn Error>;

fn main() -> ExitCode {
    let cli = Cli::try_parse();
    let cli = cli.unwrap_or_else(|error| slips::with_meant(error, &Cli::command()).exit());
    let outcome = match cli.command {
        None => run::Run::demo().execute(),
        Some(Command::Run(run)) => run.execute(),
        Some(Command::Replay(replay)) => replay.execute(),
        Some(Command::Gap(gap)) => gap.execute(),
        Some(Command::Scenarios(scenarios)) => scenarios.execute(),
        Some(Command::Effects(effects)) => effects.execute(),
        Some(Command::Config(config)) => config.execute(),
    };
    match outcome {
        Ok(Verdict::Positive) => ExitCode::SUCCESS,
        Ok(Verdict::Negative) => ExitCode::from(1),
        Err(failure) => {
            tell!("xt28: {failure}");
            ExitCode::from(2)
        }
    }
}
