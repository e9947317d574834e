//! `cargo xtask bench`: what a run costs, and that it repeats.

use std::fs;
use std::process::Command;

use clap::Args;
use serde_json::Value;

use crate::workspace::{Outcome, Workspace};

/// Print the real-time factor on one core, the cost of a physics step, and whether a run repeats
#[derive(Args)]
pub(crate) struct Bench {
    /// The scenario to measure
    #[arg(long, default_value = "straight-25m", value_name = "NAME")]
    scenario: String,
    /// How often to run it; the figures are of the quickest run
    #[arg(long, default_value_t = 3, value_name = "N", value_parser = clap::value_parser!(u32).range(2..))]
    runs: u32,
}

/// What is read from a run's report.
struct Figures {
    simulated_s: f64,
    wall_s: f64,
    physics_step_us: f64,
}

impl Bench {
    /// Measures and prints; 1 if two runs logged different bytes.
    ///
    /// # Errors
    /// When the command cannot be built or run, or its report has other fields.
    pub(crate) fn execute(&self, workspace: &Workspace) -> Outcome<u8> {
        workspace.build_release(&["--package=xt28"])?;
        println!("scenario            {}, quickest of {} runs", self.scenario, self.runs);
        let mut repeats = true;
        for solver in ["rapier", "reduced"] {
            repeats &= self.measure(workspace, solver)?;
        }
        Ok(u8::from(!repeats))
    }

    /// Measures and prints one solver's figures; whether all its runs logged the same bytes.
    fn measure(&self, workspace: &Workspace, solver: &str) -> Outcome<bool> {
        let folder = tempfile::tempdir()?;
        let mut best: Option<Figures> = None;
        let mut logs = Vec::new();
        for run in 0..self.runs {
            let log = folder.path().join(format!("{run}.log"));
            let figures = self.run(workspace, solver, &log)?;
            if best.as_ref().is_none_or(|best| figures.wall_s < best.wall_s) {
                best = Some(figures);
            }
            logs.push(fs::read(&log)?);
        }
        let best = best.ok_or("no run")?;
        let repeats = logs.windows(2).all(|pair| pair[0] == pair[1]);
        let factor = best.simulated_s / best.wall_s;
        println!("solver              {solver}");
        println!("simulated           {:.2} s", best.simulated_s);
        println!("wall, one core      {:.3} s", best.wall_s);
        println!("real-time factor    {factor:.1}");
        println!("physics step        {:.1} us", best.physics_step_us);
        println!("same log every run  {}", if repeats { "yes" } else { "NO" });
        Ok(repeats)
    }

    fn run(&self, workspace: &Workspace, solver: &str, log: &std::path::Path) -> Outcome<Figures> {
        let program = workspace.release().join("xt28");
        // Pinned where the system can: the figure is for one core.
        let pinned = Command::new("taskset").arg("--version").output().is_ok();
        let mut command = if pinned { Command::new("taskset") } else { Command::new(&program) };
        if pinned {
            command.args(["--cpu-list", "0"]).arg(&program);
        }
        let run = command
            .args(["run", &self.scenario, "--solver", solver, "--json", "--record"])
            .arg(log)
            .output()
            .map_err(|error| format!("{}: {error}", program.display()))?;
        // 1 is a verdict on the machine, which does not change what the run cost.
        if !matches!(run.status.code(), Some(0 | 1)) {
            return Err(String::from_utf8_lossy(&run.stderr).trim().to_owned().into());
        }
        let report: Value = serde_json::from_slice(&run.stdout)?;
        let figure = |name: &str| {
            report[name].as_f64().ok_or_else(|| format!("the report has no number `{name}`"))
        };
        Ok(Figures {
            simulated_s: figure("simulated_s")?,
            wall_s: figure("wall_s")?,
            physics_step_us: figure("physics_step_us")?,
        })
    }
}
