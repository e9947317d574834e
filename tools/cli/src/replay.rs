//! `xt28 replay`: a field log's commands through our ECUs and plant, against what the log measured.

use std::path::{Path, PathBuf};

use clap::Args;
use xt28_gap::{About, Decoder, FieldLog, Mapping, Replay as Run, Terrain};
use xt28_machine::Machine;
use xt28_sim::Solver;
use xt28_sim::effects::Overlay;

use crate::files::{Form, no_input, replaceable, writable};
use crate::ground::Ground;
use crate::say::{say, tell};
use crate::{Failure, Verdict};

/// Feed the commands of a field log to our machine and compare what both did
///
/// Exit status: 0 all judged signals are within their bounds; 1 one is not, or none could be judged; 2 it could
/// not be done.
#[derive(Args)]
pub(crate) struct Replay {
    /// candump log, plain or gzipped, or MCAP with `can_msgs` frames
    log: PathBuf,
    /// DBC that the log was sent with
    #[arg(long, value_name = "FILE")]
    dbc: PathBuf,
    /// Which signal of that DBC is which channel (TOML), where names differ from ours
    #[arg(long, value_name = "FILE")]
    mapping: Option<PathBuf>,
    /// Machine file (TOML); the built-in machine when left out
    #[arg(long, value_name = "FILE")]
    machine: Option<PathBuf>,
    /// Effects that our machine gets (TOML; see `xt28 effects`); the nominal machine without it
    #[arg(long, value_name = "FILE")]
    effects: Option<PathBuf>,
    /// What solves the rigid bodies: `rapier`, the reference, or `reduced`, the fast core
    #[arg(long, default_value_t, value_name = "NAME")]
    solver: Solver,
    /// Terrain file (TOML), or the scenario that the log is of; else as about.toml says, else flat
    #[arg(long, value_name = "FILE")]
    terrain: Option<PathBuf>,
    /// What is known of the logs (TOML); about.toml beside the log, if there
    #[arg(long, value_name = "FILE", conflicts_with = "terrain")]
    about: Option<PathBuf>,
    /// Take a log that ends in the middle of a line as ending before it
    #[arg(long)]
    accept_cut: bool,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
    /// Draw our signals over the log's into this SVG file
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
}

impl Replay {
    pub(crate) fn execute(&self) -> Result<Verdict, Failure> {
        if let Some(plot) = &self.plot {
            let files = [&self.mapping, &self.machine, &self.effects, &self.terrain, &self.about];
            let about = self.log.with_file_name("about.toml");
            let read = files.into_iter().flatten().chain([&self.log, &self.dbc, &about]);
            no_input(plot, "--plot", read.map(PathBuf::as_path))?;
            replaceable(plot, "--plot", Form::Page)?;
            writable([plot.as_path()])?;
        }
        let mapping =
            self.mapping.as_deref().map_or_else(|| Ok(Mapping::default()), Mapping::load)?;
        let decoder = Decoder::load(&self.dbc, &mapping)?;
        let log = FieldLog::load(&self.log, &decoder, self.accept_cut)?;
        log.ensure_one_clock()?;
        let machine = self.machine.as_deref().map_or_else(|| Ok(Machine::xt28()), Machine::load)?;
        let effects =
            self.effects.as_deref().map_or_else(|| Ok(Overlay::default()), Overlay::load)?;
        let replay =
            Run::run(&log, &machine, &effects.effects(&machine)?, self.solver, &self.ground()?)?;
        let report = replay.report(&log, &self.dbc);
        if self.json {
            say!("{:#}\n", report.json());
        } else {
            say!("{}", report.table());
        }
        if let Some(path) = &self.plot {
            replay.draw(&log, path)?;
            tell!("wrote {}", path.display());
        }
        Ok(if report.passed() { Verdict::Positive } else { Verdict::Negative })
    }

    fn ground(&self) -> Result<Terrain, Failure> {
        if let Some(path) = &self.terrain {
            let ground = Ground::find(Some(path))?;
            return Ok(ground.map_or(Ok(Terrain::Flat), |ground| Terrain::load(ground.file()))?);
        }
        let beside = self.log.parent().unwrap_or(Path::new("")).join("about.toml");
        if let Some(path) = &self.about {
            return Ok(About::terrain_of(path, &self.log)?);
        }
        if !beside.exists() {
            tell!(
                "ASSUMED: {} was driven on level ground; say --terrain or --about if it was not",
                self.log.display()
            );
            return Ok(Terrain::Flat);
        }
        if About::load(&beside)?.run_of(&self.log).is_none() {
            tell!(
                "IGNORED: {} has no [[run]] for {}, which is taken as driven on level ground; name it there, or say \
                 --about or --terrain",
                beside.display(),
                self.log.display()
            );
            return Ok(Terrain::Flat);
        }
        Ok(About::terrain_of(&beside, &self.log)?)
    }
}
