//! `cargo xtask third-make`: field logs of machines whose bodies are MuJoCo's, for `xt28 gap check --set`.

use std::path::PathBuf;

use clap::Args;

use crate::workspace::{Outcome, Workspace};
use crate::yardstick;

/// Write cases of a third make: MuJoCo's bodies, hydraulics, ECUs and sensors in Python, with answers
///
/// `xt28 gap check --set OUT` then examines the diagnosis on them. Needs python3 (3.11 or later) with venv;
/// packages come from PyPI into the build folder unless python3 has them. A case takes about a minute.
#[derive(Args)]
pub(crate) struct ThirdMake {
    /// Folder for cases and their answers
    out: PathBuf,
    /// What is wrong, a case each: `NAME` or `NAME:SCOPE`, two joined by +, or `sound`; one of each fault if none
    /// and no pairs
    causes: Vec<String>,
    /// Seed of the first case; the next has one more
    #[arg(long, default_value_t = 1, value_name = "SEED")]
    seed: u32,
    /// What resists rolling acts between wheel and arm, as bearings do, not between wheel and ground
    #[arg(long)]
    bearings: bool,
    /// Faults set in 8 to 14 s into every run, where they are not built in
    #[arg(long)]
    late: bool,
    /// Faults set in once, with the second, third or fourth run or 8 to 14 s into it, and stay
    #[arg(long, conflicts_with = "late")]
    once: bool,
    /// The machine drives to goals as a learnt controller does, instead of test drives
    #[arg(long)]
    policy: bool,
    /// Also so many pairs of known faults, drawn by lot
    #[arg(long, default_value_t = 0, value_name = "N")]
    pairs: u32,
}

impl ThirdMake {
    /// Writes them.
    ///
    /// # Errors
    /// When Python cannot be run.
    pub(crate) fn execute(&self, workspace: &Workspace) -> Outcome<u8> {
        let mut command = yardstick::module(workspace, "third_make")?;
        command.arg(std::path::absolute(&self.out)?).args(&self.causes);
        let switches = [
            (self.bearings, "--bearings"),
            (self.late, "--late"),
            (self.once, "--once"),
            (self.policy, "--policy"),
        ];
        command.args(switches.iter().filter(|(on, _)| *on).map(|(_, switch)| switch));
        let status = command
            .args([format!("--seed={}", self.seed), format!("--pairs={}", self.pairs)])
            .status()?;
        Ok(u8::from(!status.success()))
    }
}
