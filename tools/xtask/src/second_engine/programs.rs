//! The two sides as programs: our examples, built here, and MuJoCo's, run by a Python that has it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

use super::engine::Engine;
use super::trajectory::Trajectory;
use crate::workspace::{Outcome, Workspace};
use crate::yardstick::{YARDSTICK, python, with};

/// Both sides, ready to run.
pub(crate) struct Programs {
    root: PathBuf,
    examples: PathBuf,
    python: PathBuf,
    grids: PathBuf,
    machine: PathBuf,
}

/// What is run.
#[derive(Clone, Copy)]
pub(crate) struct Job<'a> {
    /// Name in the file of manoeuvres.
    pub(crate) manoeuvre: &'a str,
    /// Name of a terrain file of the yardstick, without its ending.
    pub(crate) terrain: &'a str,
    /// Steps per second.
    pub(crate) rate_hz: u32,
    /// More arguments for MuJoCo's side.
    pub(crate) mujoco: &'a [String],
}

/// What came of it.
pub(crate) struct Run {
    /// The CSV as it was written.
    pub(crate) text: String,
    /// The same as numbers.
    pub(crate) trajectory: Trajectory,
    /// Processor time of a step, ns.
    pub(crate) step_ns: f64,
}

impl Programs {
    /// Builds our side, finds or installs MuJoCo, and writes the grids that both stand on.
    ///
    /// # Errors
    /// When something cannot be built or installed; the message says the remedy.
    pub(crate) fn prepare(workspace: &Workspace, machine: &Path) -> Outcome<Self> {
        workspace.build_release(&["--package=xt28-sim", "--examples"])?;
        let grids = workspace.target.join("second-engine");
        // Grids of another day may be of other terrain files.
        if grids.exists() {
            fs::remove_dir_all(&grids)?;
        }
        fs::create_dir_all(&grids)?;
        Ok(Self {
            root: workspace.root.clone(),
            examples: workspace.release().join("examples"),
            python: python(workspace)?,
            grids,
            machine: workspace.root.join(machine),
        })
    }

    /// The engines that our side was built with.
    ///
    /// # Errors
    /// When our side cannot be run.
    pub(crate) fn ours(&self) -> Outcome<Vec<Engine>> {
        let known = text_of(self.example("trajectory").arg("engines"))?;
        let known: Vec<&str> = known.lines().collect();
        let ours = [Engine::Rapier, Engine::Reduced].into_iter();
        Ok(ours.filter(|e| e.argument().is_some_and(|name| known.contains(&name))).collect())
    }

    /// One run of one engine.
    ///
    /// # Errors
    /// When the program fails or writes something else than agreed.
    pub(crate) fn run(&self, engine: Engine, job: &Job<'_>) -> Outcome<Run> {
        let mut command = match engine.argument() {
            Some(name) => self.our_command(name, job),
            None => self.mujoco_command(engine, job)?,
        };
        let output = checked(&mut command)?;
        let cost: Value = serde_json::from_slice(&output.stderr)?;
        let step_ns = cost["step_ns"].as_f64().ok_or("no number `step_ns` was reported")?;
        let text = String::from_utf8(output.stdout)?;
        let trajectory = Trajectory::parse(&text)?;
        Ok(Run { text, trajectory, step_ns })
    }

    /// Runs one of our examples, its output going where ours goes.
    ///
    /// # Errors
    /// When it fails.
    pub(crate) fn pass_on(&self, example: &str) -> Outcome<()> {
        let status = self.example(example).status()?;
        if status.success() { Ok(()) } else { Err(format!("{example}: {status}").into()) }
    }

    /// The file of manoeuvres.
    pub(crate) fn manoeuvres(&self) -> PathBuf {
        self.root.join(YARDSTICK).join("manoeuvres.toml")
    }

    /// Where recorded trajectories are kept.
    pub(crate) fn recorded(&self, manoeuvre: &str) -> PathBuf {
        self.root.join(YARDSTICK).join("recorded").join(format!("{manoeuvre}.csv"))
    }

    fn example(&self, name: &str) -> Command {
        let mut command = Command::new(self.examples.join(name));
        command.current_dir(&self.root);
        command
    }

    fn our_command(&self, engine: &str, job: &Job<'_>) -> Command {
        let mut command = self.example("trajectory");
        let rate = job.rate_hz.to_string();
        command.args(["run", engine, job.manoeuvre, rate.as_str(), job.terrain]);
        command.arg(&self.machine);
        command
    }

    /// Has MuJoCo print how its wheels stand.
    ///
    /// # Errors
    /// When it cannot be run.
    pub(crate) fn contacts(&self, terrain: &str) -> Outcome<()> {
        let mut command = self.mujoco("xt28_mujoco.contacts", terrain)?;
        print!("{}", text_of(&mut command)?);
        Ok(())
    }

    fn mujoco_command(&self, engine: Engine, job: &Job<'_>) -> Outcome<Command> {
        let mut command = self.mujoco("xt28_mujoco", job.terrain)?;
        command.arg(job.manoeuvre).arg(format!("--rate={}", job.rate_hz));
        command.args(engine.mujoco_arguments()).args(job.mujoco);
        let start = text_of(self.example("trajectory").args(["start", job.terrain]))?;
        command.arg(format!("--start={}", start.trim()));
        Ok(command)
    }

    /// A module of MuJoCo's side on a ground.
    fn mujoco(&self, module: &str, terrain: &str) -> Outcome<Command> {
        let mut command = with(&self.root, &self.python, module);
        command.arg("--machine").arg(&self.machine);
        command.arg("--manoeuvres").arg(self.manoeuvres());
        // Level ground is a plane to both.
        if terrain != "flat" {
            command.arg("--grid").arg(self.grid(terrain)?);
        }
        Ok(command)
    }

    /// The heights that our side sees, as a file for the other.
    fn grid(&self, terrain: &str) -> Outcome<PathBuf> {
        let path = self.grids.join(format!("{terrain}.asc"));
        if !path.exists() {
            fs::write(&path, text_of(self.example("trajectory").args(["grid", terrain]))?)?;
        }
        Ok(path)
    }
}

fn text_of(command: &mut Command) -> Outcome<String> {
    Ok(String::from_utf8(checked(command)?.stdout)?)
}

fn checked(command: &mut Command) -> Outcome<Output> {
    let output = command.output().map_err(|error| format!("{command:?}: {error}"))?;
    if output.status.success() {
        return Ok(output);
    }
    let why = String::from_utf8_lossy(&output.stderr);
    let last = why.trim().lines().last().unwrap_or("no message").to_owned();
    Err(format!("{command:?}: {last}").into())
}
