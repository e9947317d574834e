//! `xt28 run`: one scenario, on the virtual bus in lockstep or as programs on a real one.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use xt28_machine::SimTime;
use xt28_scenarios::{
    Controller, Cost, Lockstep, Recording, Report, STEPS_PER_TICK, Scenario, ScenarioError, Setup,
    Terms,
};
use xt28_sim::Solver;

use crate::artefacts::Artefacts;
use crate::pace::Pace;
use crate::say::{say, tell};
use crate::{Failure, Verdict, processes};

/// Run a scenario and say whether it holds
///
/// Exit status: 0 all that the scenario expects holds; 1 something does not; 2 it could not be run.
#[derive(Args)]
pub(crate) struct Run {
    /// A built-in name (see `xt28 scenarios`) or a TOML file
    scenario: String,
    /// Seed of all noise, instead of the scenario's own
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    seed: Option<u64>,
    /// Machine file (TOML), instead of the scenario's own
    #[arg(long, value_name = "FILE")]
    machine: Option<PathBuf>,
    /// What drives, instead of the scenario's own policy: as `gateway --policy` has it. In lockstep the machine waits
    /// for the answers of a controller that connects to `rosbridge:PORT`
    #[arg(long, value_name = "POLICY")]
    policy: Option<String>,
    /// Effects that the machine gets beside the scenario's own (TOML; see `xt28 effects`)
    #[arg(long, value_name = "FILE")]
    effects: Option<PathBuf>,
    /// What solves the rigid bodies: `rapier`, the reference, or `reduced`, the fast core
    #[arg(long, default_value_t, value_name = "NAME")]
    solver: Solver,
    /// `virtual`, or a CAN interface such as vcan0, where emulator and gateway run as programs
    #[arg(long, default_value = VIRTUAL, value_name = "BUS")]
    bus: String,
    /// Pace the virtual bus by wall time, which waits for no controller once it drives; a real bus always is
    #[arg(long)]
    realtime: bool,
    /// Write the candump log here
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Print the report as JSON instead of a table
    #[arg(long)]
    json: bool,
    /// Write log, picture (SVG) and report into this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

const VIRTUAL: &str = "virtual";
/// How long a controller may take to connect, and for each answer.
const PATIENCE: Duration = Duration::from_secs(60);

impl Run {
    /// What a bare `xt28` runs.
    pub(crate) fn demo() -> Self {
        Self {
            scenario: "straight-25m".to_owned(),
            seed: None,
            machine: None,
            policy: None,
            effects: None,
            solver: Solver::default(),
            bus: VIRTUAL.to_owned(),
            realtime: false,
            record: None,
            json: false,
            out: Some(PathBuf::from("out")),
        }
    }

    pub(crate) fn execute(&self) -> Result<Verdict, Failure> {
        let mut scenario = self.scenario()?;
        if let Some(machine) = &self.machine {
            scenario.machine = Some(machine.clone());
        }
        if let Some(policy) = &self.policy {
            scenario.drive_by(policy)?;
        }
        let mut setup = Setup::new(scenario, self.seed)?;
        setup.solver = self.solver;
        if let Some(path) = &self.effects {
            setup.add_effects(path)?;
        }
        setup.ensure_startable()?;
        let name = &setup.scenario.name;
        let artefacts = Artefacts::new(name, self.record.as_deref(), self.out.as_deref())?;
        let own = self.effects.as_deref().into_iter().chain([Path::new(&self.scenario)]);
        let read: Vec<PathBuf> = setup.files().collect();
        artefacts.ensure_apart(read.iter().map(PathBuf::as_path).chain(own))?;
        let (recording, cost) = if self.bus == VIRTUAL {
            self.lockstep(&setup, &artefacts)?
        } else {
            processes::run(&setup, &self.bus, &artefacts)?
        };
        let report = Report { cost: Some(cost), ..recording.report(&setup, &self.bus) };
        // First, so that a folder without room costs no report.
        if self.json {
            say!("{:#}\n", report.json());
        } else {
            say!("{}", report.table());
        }
        artefacts.write(&setup, &recording, &report)?;
        Ok(if report.passed() { Verdict::Positive } else { Verdict::Negative })
    }

    /// The scenario that is named.
    fn scenario(&self) -> Result<Scenario, Failure> {
        let name = &self.scenario;
        match Scenario::find(name) {
            // As a file that `xt28 scenarios ramp > mine` left.
            Err(ScenarioError::Unknown { .. }) if Path::new(name).is_file() => {
                let remedy = format!("write ./{name}, or name it {name}.toml");
                Err(format!("no scenario `{name}`, but a file {name} is there; {remedy}").into())
            }
            found => Ok(found?),
        }
    }

    fn lockstep(&self, setup: &Setup, artefacts: &Artefacts) -> Result<(Recording, Cost), Failure> {
        let bar = progress_bar(setup);
        let mut run = match self.controller(setup, &bar)? {
            Some(controller) => {
                Lockstep::with_controller(setup, controller, artefacts.log_writer()?)?
            }
            None => Lockstep::new(setup, artefacts.log_writer()?)?,
        };
        let mut pace = Pace::start(self.realtime);
        let (mut emulator, mut ticks) = (Duration::ZERO, 0_u32);
        loop {
            pace.wait_until(Duration::from_nanos(run.now().as_nanos()));
            let ticked = run.tick(&mut || pace.elapsed());
            let Some(cost) = ticked.map_err(|error| artefacts.told(error))? else {
                break;
            };
            emulator += cost.emulator;
            ticks += 1;
            if self.realtime {
                pace.begin_later(run.take_held_up());
            }
            bar.set_position(run.now().as_nanos() / 1_000_000);
        }
        let recording = run.finish().map_err(|error| artefacts.told(error))?;
        let wall_s = pace.elapsed().as_secs_f64();
        bar.finish_and_clear();
        let steps = f64::from(ticks.max(1)) * f64::from(STEPS_PER_TICK);
        let cost = Cost {
            wall_s,
            physics_step_us: Some(emulator.as_secs_f64() * 1e6 / steps),
            lateness_max_ms: pace.lateness_max_ms(),
        };
        Ok((recording, cost))
    }

    /// Listens for a controller elsewhere, if one is to drive.
    fn controller(&self, setup: &Setup, bar: &ProgressBar) -> Result<Option<Controller>, Failure> {
        let terms = Terms { patience: PATIENCE, waits_for_each: !self.realtime };
        let beside = bar.clone();
        let hearer = Box::new(move |at: SimTime, what: &str| {
            beside.suspend(|| tell!("{:8.2} s  controller: {what}", at.as_secs_f64()));
        });
        let controller = Controller::open(setup, terms, hearer)?;
        if let Some(controller) = &controller {
            tell!("a controller may connect to ws://{}", controller.address());
        }
        Ok(controller)
    }
}

/// A bar over simulated time; indicatif draws it on a terminal only.
fn progress_bar(setup: &Setup) -> ProgressBar {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most an hour
    let bar = ProgressBar::new((setup.scenario.duration_s * 1e3) as u64);
    let template = "{msg} [{bar:40}] {percent:>3} %  {elapsed}";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.with_message(setup.scenario.name.clone())
}
