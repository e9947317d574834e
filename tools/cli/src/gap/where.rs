//! `xt28 gap where`: each block on measured inputs, and how far it parts from the log.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;
use xt28_gap::diagnosis::{Evidence, Knob, Signals};
use xt28_gap::{Decoder, Known, Mapping, RunSet};
use xt28_machine::Machine;
use xt28_sim::effects::Overlay;

use super::about;
use crate::say::say;
use crate::{Failure, Verdict};

/// Drive each block of the simulator with what was measured, and say which one parts from the log
///
/// A block's gap is the mean square of what is left once masses and stiffnesses are at their best, in
/// units of what separates two models of one nominal machine. A sound machine, whose every part is a
/// little off, shows up to about 6; beyond 10 there is something to explain.
#[derive(Args)]
pub(crate) struct Where {
    /// candump logs of one machine, plain or gzipped
    #[arg(required = true)]
    logs: Vec<PathBuf>,
    /// DBC that the logs were sent with
    #[arg(long, value_name = "FILE")]
    dbc: PathBuf,
    /// Which signal of that DBC is which channel (TOML), where names differ from ours
    #[arg(long, value_name = "FILE")]
    mapping: Option<PathBuf>,
    /// Machine file (TOML); the built-in machine when left out
    #[arg(long, value_name = "FILE")]
    machine: Option<PathBuf>,
    /// Effects that our machine gets (TOML; see `xt28 effects`)
    #[arg(long, value_name = "FILE")]
    effects: Option<PathBuf>,
    /// Terrain file (TOML) of all runs, instead of what about.toml says
    #[arg(long, value_name = "FILE")]
    terrain: Option<PathBuf>,
    /// What is known of the logs (TOML), foremost their ground; about.toml beside the first log, if
    /// there, else the ground is taken as level
    #[arg(long, value_name = "FILE")]
    about: Option<PathBuf>,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
}

/// A block with more than this has something to explain.
const GAP_MIN: f64 = 10.0;

impl Where {
    pub(crate) fn execute(&self) -> Result<Verdict, Failure> {
        let mapping =
            self.mapping.as_deref().map_or_else(|| Ok(Mapping::default()), Mapping::load)?;
        let decoder = Decoder::load(&self.dbc, &mapping)?;
        let machine = self.machine.as_deref().map_or_else(|| Ok(Machine::xt28()), Machine::load)?;
        let effects =
            self.effects.as_deref().map_or_else(|| Ok(Overlay::default()), Overlay::load)?;
        let about = about(&self.logs, self.about.as_ref());
        let known = Known { about: about.as_deref(), terrain: self.terrain.as_deref() };
        let set = RunSet::load(&self.logs, &decoder, known, false)?;
        for note in set.notes() {
            eprintln!("{note}");
        }
        let runs = set.runs().iter().map(|run| Signals::new(&run.log, run.terrain.clone()));
        let runs: Vec<Signals> = runs.collect::<Result<_, _>>()?;
        let evidence = Evidence::new(&runs, &machine, effects.effects(), &Knob::tolerances());
        let mut gaps = evidence.gaps();
        gaps.sort_by(|(_, a), (_, b)| b.total_cmp(a));
        if self.json {
            let rows = gaps.iter().map(|(generator, gap)| {
                json!({
                    "block": generator.block().to_string(),
                    "residual": generator.to_string(),
                    "gap_over_floor": gap,
                })
            });
            say!("{:#}\n", json!({ "where": rows.collect::<Vec<_>>() }));
        } else {
            say!("{:<26} {:>14}\n", "block on measured inputs", "gap over floor");
            for (generator, gap) in &gaps {
                let mark = if *gap > GAP_MIN { "  <- to explain" } else { "" };
                say!("{:<26} {gap:>14.2}{mark}\n", generator.to_string());
            }
        }
        let sound = gaps.iter().all(|(_, gap)| *gap <= GAP_MIN);
        Ok(if sound { Verdict::Positive } else { Verdict::Negative })
    }
}
