//! `cargo xtask second-engine`: our engines held against MuJoCo, in what they say and what they cost.

mod benchmark;
mod comparison;
mod engine;
mod programs;
mod trajectory;

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::workspace::{Outcome, Workspace};
use engine::Engine;
use programs::Programs;

/// Compare our engines with MuJoCo and measure all of them; nothing here passes or fails
///
/// Needs python3 (3.11 or later) with venv; MuJoCo itself comes from PyPI into the build folder
/// unless python3 has it. The tables of docs/second-engine.md and docs/speed.md are this command's output.
#[derive(Args)]
pub(crate) struct SecondEngine {
    /// Do this part alone
    #[arg(long, value_enum, value_name = "PART")]
    only: Option<Part>,
    /// Steps per second of both engines in the comparison
    #[arg(long, default_value_t = 200, value_name = "HZ")]
    rate: u32,
    /// How often each run of the benchmark is timed; the figure is the median
    #[arg(long, default_value_t = 5, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    repeats: u32,
    /// Compare in this manoeuvre alone
    #[arg(long, value_name = "NAME")]
    manoeuvre: Option<String>,
    /// The machine that both sides build
    #[arg(long, default_value = "machine/xt28.toml", value_name = "FILE")]
    machine: PathBuf,
    /// An argument passed on to MuJoCo's side in the comparison, such as --mujoco=--impratio=10
    #[arg(long, value_name = "ARG", allow_hyphen_values = true)]
    mujoco: Vec<String>,
}

/// The parts of the chore.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Part {
    /// Distances between trajectories, a table for each of our engines
    Compare,
    /// Steps per second, and each engine's distance from its own finest run
    Bench,
    /// Many environments on two cores, and the memory of one
    Scale,
    /// How MuJoCo's wheels stand on a plane and on triangles
    Contacts,
    /// Write MuJoCo's trajectories that the plant's tests are held to
    Record,
}

impl SecondEngine {
    /// Prints what was asked for.
    ///
    /// # Errors
    /// When a side cannot be built or run.
    pub(crate) fn execute(&self, workspace: &Workspace) -> Outcome<u8> {
        let programs = Programs::prepare(workspace, &self.machine)?;
        if self.only == Some(Part::Record) {
            comparison::record(&programs)?;
            return Ok(0);
        }
        let wanted = |part| self.only.is_none_or(|only| only == part);
        if wanted(Part::Compare) {
            for ours in programs.ours()? {
                comparison::print(&programs, ours, self)?;
            }
        }
        if wanted(Part::Bench) {
            let mut engines = programs.ours()?;
            engines.extend([Engine::MujocoElliptic, Engine::MujocoPyramidal]);
            benchmark::print(&programs, &engines, self.repeats)?;
        }
        if wanted(Part::Scale) {
            programs.pass_on("scaling")?;
            programs.pass_on("memory")?;
        }
        if wanted(Part::Contacts) {
            for terrain in ["flat", "flat-grid"] {
                println!("\nMuJoCo at rest, {terrain}\n");
                programs.contacts(terrain)?;
            }
        }
        Ok(0)
    }
}
