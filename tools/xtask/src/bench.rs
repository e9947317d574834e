//! `cargo xtask bench`: what a run costs, and that it repeats.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

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

    fn run(&self, workspace: &Workspace, solver: &str, log: &Path) -> Outcome<Figures> {
        let program = workspace.release().join("xt28");
        let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
        let run = on_one_cpu(first_allowed_cpu(&status), &program)
            .args(["run", &self.scenario, "--solver", solver, "--json", "--record"])
            .arg(log)
            .output()
            .map_err(|error| format!("{}: {error}", program.display()))?;
        // 1 is a verdict on the machine, which does not change what the run cost.
        if !matches!(run.status.code(), Some(0 | 1)) {
            return Err(said(&run).into());
        }
        let report: Value = serde_json::from_slice(&run.stdout)
            .map_err(|error| format!("{error}: {}", said(&run)))?;
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

/// The first processor that this process may run on, by what `/proc/self/status` says: in a container or under a job
/// scheduler it need not be the first of the machine.
fn first_allowed_cpu(status: &str) -> Option<u32> {
    let list = status.lines().find_map(|line| line.strip_prefix("Cpus_allowed_list:"))?;
    let digits = list.trim().split(|c: char| !c.is_ascii_digit()).next()?;
    digits.parse().ok()
}

/// A command of `program`, pinned where the system can and lets it: the figure is for one core.
fn on_one_cpu(cpu: Option<u32>, program: &Path) -> Command {
    let pinned = |cpu: u32| {
        let mut command = Command::new("taskset");
        command.args(["--cpu-list", &cpu.to_string()]);
        command
    };
    let works =
        |cpu: &u32| pinned(*cpu).arg("true").output().is_ok_and(|probe| probe.status.success());
    match cpu.filter(works) {
        Some(cpu) => {
            let mut command = pinned(cpu);
            command.arg(program);
            command
        }
        None => Command::new(program),
    }
}

/// What a run said that left no report: its talk, or that there was none.
fn said(run: &Output) -> String {
    let talk = String::from_utf8_lossy(&run.stderr);
    if talk.trim().is_empty() { format!("no word, {}", run.status) } else { talk.trim().to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_processor_that_is_allowed_is_taken() {
        let of = |list: &str| {
            first_allowed_cpu(&format!(
                "Name:\txtask\nCpus_allowed:\tf0\nCpus_allowed_list:\t{list}\nMems:\t0\n"
            ))
        };
        let lists = [("0-15", 0), ("4-7", 4), ("6,8-11", 6), ("13", 13)];
        assert!(lists.iter().all(|(list, cpu)| of(list) == Some(*cpu)), "{lists:?}");
        assert_eq!([of(""), first_allowed_cpu("")], [None; 2]);
    }

    #[test]
    fn a_processor_that_is_not_there_is_not_pinned_to() {
        let program = |cpu| on_one_cpu(cpu, Path::new("xt28")).get_program().to_owned();
        assert_eq!(program(None), "xt28");
        assert_eq!(program(Some(999_999)), "xt28");
    }

    #[test]
    fn a_run_without_a_report_says_why() {
        let of = |script: &str| said(&Command::new("sh").args(["-c", script]).output().unwrap());
        assert_eq!(of("echo no such scenario >&2; exit 2"), "no such scenario");
        assert!(of("exit 3").starts_with("no word, "));
    }
}
