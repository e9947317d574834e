//! `cargo xtask`: the project's own chores. One file a chore.
#![forbid(unsafe_code)]
// A binary is the edge of the house: it prints, reads clocks and arguments, and exits.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)]

mod bench;
mod guest;
mod harness;
mod own_bench;
mod second_engine;
mod side_by_side;
mod tally;
mod test;
mod third_make;
mod tidy;
mod vcan;
mod vcan_scenarios;
mod workspace;
mod yardstick;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use workspace::{Outcome, Workspace};

/// The project's own chores.
#[derive(Parser)]
#[command(bin_name = "cargo xtask", max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Subcommand)]
enum Chore {
    Test(test::Test),
    /// Check the house rules that compiler and clippy cannot
    Tidy,
    Vcan(vcan::Vcan),
    VcanScenarios(vcan_scenarios::VcanScenarios),
    /// Build the guest's kernel, unless it is kept already, and print its path
    GuestKernel(vcan::Cache),
    Bench(bench::Bench),
    OwnBench(own_bench::OwnBench),
    SecondEngine(second_engine::SecondEngine),
    ThirdMake(third_make::ThirdMake),
}

fn main() -> ExitCode {
    match perform(Cli::parse().chore) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            eprintln!("xtask: {error}");
            // 125 is what `env` and `timeout` say when they, not the command, failed.
            ExitCode::from(125)
        }
    }
}

fn perform(chore: Chore) -> Outcome<u8> {
    let workspace = Workspace::load()?;
    match chore {
        Chore::Test(test) => test.execute(&workspace),
        Chore::Tidy => {
            let found = tidy::check(&workspace)?;
            for finding in &found {
                println!("{finding}");
            }
            eprintln!("tidy: {} findings", found.len());
            Ok(u8::from(!found.is_empty()))
        }
        Chore::Vcan(vcan) => vcan.execute(&workspace.target),
        Chore::VcanScenarios(scenarios) => scenarios.execute(&workspace),
        Chore::GuestKernel(cache) => {
            let guest = guest::Guest::prepare(&cache.folder(&workspace.target)?)?;
            println!("{}", guest.kernel().display());
            Ok(0)
        }
        Chore::Bench(bench) => bench.execute(&workspace),
        Chore::OwnBench(own) => own.execute(&workspace),
        Chore::SecondEngine(second) => second.execute(&workspace),
        Chore::ThirdMake(third) => third.execute(&workspace),
    }
}
