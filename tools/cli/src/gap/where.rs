//! `xt28 gap where`: each block on measured inputs, and how far it parts from the log.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;
use xt28_gap::diagnosis::{
    Evidence, Floors, Generator, Knob, Signals, ensure_agreeing, share_resistance, swapped_wheels,
    with_noise_of,
};
use xt28_gap::{Decoder, Known, KnownRun, Mapping, RunSet};
use xt28_machine::Machine;
use xt28_sim::effects::Overlay;

use super::about;
use super::remarks::{Given, remarks};
use crate::ground::Ground;
use crate::say::{say, tell};
use crate::{Failure, Verdict};

/// Drive each block of the simulator with what was measured, and say which one parts from the log
///
/// A block's gap is the root mean square of all its signals' errors on all logs, in units of what separates
/// two models of one nominal machine. Masses, stiffnesses and the like are where they fit best, and no effect is
/// believed but those of --effects. `diagnose` shows other gaps: of each signal alone, on the logs that are
/// fitted, and with small effects allowed for as well.
///
/// A sound machine, whose every part is a little off, shows up to about 2.5; beyond 3.2 there is something to
/// explain. Blocks of which nothing can be judged have none: how the machine stands, travels and is driven is
/// judged on level ground, or on a slope that is known, alone.
///
/// Exit status: 0 no block has something to explain; 1 one has; 2 it could not be done.
#[derive(Args)]
pub(crate) struct Where {
    /// Logs of one machine: candump, plain or gzipped, or MCAP with `can_msgs` frames
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
    /// Terrain file (TOML) of all runs, or the scenario that they are of, instead of what about.toml says
    #[arg(long, value_name = "FILE")]
    terrain: Option<PathBuf>,
    /// What is known of the logs (TOML), foremost their ground; about.toml beside the first log, if
    /// there, else the ground is taken as level
    #[arg(long, value_name = "FILE")]
    about: Option<PathBuf>,
    /// Take a log that ends in the middle of a line as ending before it
    #[arg(long)]
    accept_cut: bool,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
}

/// A block with more than this has something to explain.
const GAP_MIN: f64 = 3.2;

impl Where {
    pub(crate) fn execute(&self) -> Result<Verdict, Failure> {
        let mapping =
            self.mapping.as_deref().map_or_else(|| Ok(Mapping::default()), Mapping::load)?;
        let decoder = Decoder::load(&self.dbc, &mapping)?;
        let machine = self.machine.as_deref().map_or_else(|| Ok(Machine::xt28()), Machine::load)?;
        let effects =
            self.effects.as_deref().map_or_else(|| Ok(Overlay::default()), Overlay::load)?;
        let about = about(&self.logs, self.about.as_ref())?;
        let ground = Ground::find(self.terrain.as_deref())?;
        let (is_asked, terrain) = (self.about.is_some(), ground.as_ref().map(Ground::file));
        let known = Known { about: about.as_deref(), is_asked, terrain };
        let set = RunSet::load(&self.logs, &decoder, known, self.accept_cut)?;
        let machine_file = self.machine.as_deref();
        let given = Given {
            decoder: &decoder,
            about: about.as_deref(),
            dbc: &self.dbc,
            machine: machine_file,
        };
        for note in remarks(&set, &given)? {
            tell!("{note}");
        }
        let signals = |run: &KnownRun| Signals::new(&run.log, run.terrain.clone());
        let runs: Vec<Signals> = set.runs().iter().map(signals).collect::<Result<_, _>>()?;
        // First, as wheels in another order make an attitude that does not agree.
        if let Some(swap) = swapped_wheels(&runs, &machine) {
            tell!("wheels look swapped: {swap}; nothing is put in order by itself");
        }
        ensure_agreeing(&runs, &machine)?;
        let readings = set.runs().iter().map(|run| run.log.all_series());
        let mut runs: Vec<Signals> = runs
            .into_iter()
            .zip(readings)
            .map(|(signals, readings)| with_noise_of(signals, readings, &machine))
            .collect();
        share_resistance(runs.iter_mut(), &machine);
        if let Some(remark) = Floors::remark(runs.iter().map(|run| &run.floors)) {
            tell!("{remark}");
        }
        let evidence =
            Evidence::new(&runs, &machine, effects.effects(&machine)?, &Knob::tolerances());
        let mut gaps = evidence.gaps();
        // The largest first; what has none comes last.
        gaps.sort_by(|(_, a), (_, b)| b.unwrap_or(-1.0).total_cmp(&a.unwrap_or(-1.0)));
        say!("{}", if self.json { json(&gaps) } else { table(&gaps) });
        let sound = gaps.iter().all(|(_, gap)| !is_to_explain(*gap));
        Ok(if sound { Verdict::Positive } else { Verdict::Negative })
    }
}

fn is_to_explain(gap: Option<f64>) -> bool {
    gap.is_some_and(|gap| gap > GAP_MIN)
}

fn json(gaps: &[(Generator, Option<f64>)]) -> String {
    let rows = gaps.iter().map(|(generator, gap)| {
        json!({
            "block": generator.block().to_string(),
            "residual": generator.to_string(),
            "gap_over_noise": gap,
        })
    });
    format!("{:#}\n", json!({ "where": rows.collect::<Vec<_>>() }))
}

fn table(gaps: &[(Generator, Option<f64>)]) -> String {
    let mut out = format!("{:<26} {:>14}\n", "block on measured inputs", "gap over noise");
    for (generator, gap) in gaps {
        let (gap, mark) = match gap {
            Some(gap) if is_to_explain(Some(*gap)) => (format!("{gap:.2}"), "  <- to explain"),
            Some(gap) => (format!("{gap:.2}"), ""),
            None => ("-".to_owned(), "  nothing to judge"),
        };
        out += &format!("{:<26} {gap:>14}{mark}\n", generator.to_string());
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_that_nothing_was_measured_of_has_no_gap_of_nought() {
        let gaps =
            [(Generator::Drive, Some(4.5)), (Generator::Bus, Some(0.3)), (Generator::Travel, None)];
        let table = table(&gaps);
        let lines: Vec<&str> = table.lines().collect();
        assert!(lines[0].ends_with("gap over noise"));
        assert!(lines[1].ends_with("4.50  <- to explain"), "{table}");
        assert!(lines[2].ends_with("0.30"), "{table}");
        assert!(lines[3].ends_with("-  nothing to judge"), "{table}");
        let json: serde_json::Value = serde_json::from_str(&json(&gaps)).unwrap();
        assert_eq!(json["where"][0]["gap_over_noise"], 4.5);
        assert!(json["where"][2]["gap_over_noise"].is_null());
    }
}
