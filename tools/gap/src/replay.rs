//! A log's commands through our ECUs and plant.
//!
//! **Clocks.** The log's zero is its first frame. Our ECUs tick every 10 ms, the first time 1 ms
//! after that zero: commands that a gateway sends at the start of its period are then taken in the
//! tick they were meant for, and what the log's ECUs send a few milliseconds later stands beside
//! what ours sent in the same tick. Commands keep their recorded times; a lost one is not made up.
//!
//! **Resampling.** Values are compared at the log's instants; ours are held from tick to tick, as
//! a bus holds them ([`Series::at`]).
//!
//! **Start.** The machine is set to the strokes and cylinder loads first measured and stands for
//! 5 s at the log's first commands before the log begins, heading east from the origin. Loads,
//! because on six wheels a millimetre of stroke is 2 kN of load: strokes alone leave them open.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

use ecu_emu::{Emulator, EmulatorConfig, TICK};
use xt28_dbc::{Outbox, XT28_DBC};
use xt28_machine::{Machine, PerWheel, SimTime};
use xt28_sim::{Effects, Solver, Terrain};

use crate::commands::{Command, Speaker, commands};
use crate::comparison::rows;
use crate::ecu_watch::EcuWatch;
use crate::{Channel, Decoder, FaultKind, FieldLog, GapError, Mapping, Report, Series, overlay};

/// Time at the first commands before the log begins.
const SETTLE: Duration = Duration::from_secs(5);
/// The ECUs' tick after the log's zero.
const PHASE: Duration = Duration::from_millis(1);

/// No bus is silent for longer within a drive, s (assumed); a clock that was set is ahead by days.
const SILENCE_MAX_S: f64 = 60.0;

/// What our machine did on a log's commands.
#[derive(Clone, Debug, PartialEq)]
pub struct Replay {
    series: BTreeMap<Channel, Series>,
    notes: Vec<String>,
    wheel_radius_m: f64,
}

impl Replay {
    /// Runs the commands of `log` on `machine` with `effects`, solved by `solver`, on `terrain`. Twice the same gives
    /// twice the same.
    ///
    /// # Errors
    /// [`GapError::Command`] for a command that our bus cannot say; [`GapError::ClockSteps`] where the
    /// log's clock leaps ahead; [`GapError::Undriven`].
    pub fn run(
        log: &FieldLog,
        machine: &Machine,
        effects: &Effects,
        solver: Solver,
        terrain: &Terrain,
    ) -> Result<Self, GapError> {
        steady(log)?;
        drivable(log)?;
        let commands = commands(log, machine.drive.engine_speed_rpm)?;
        let first = |channel| log.series(channel).and_then(|s| s.iter().next()).map(|(_, v)| v);
        // Strokes are logged in whole millimetres, cut off: the middle of the step is meant.
        let stroke_m = PerWheel::from_fn(|wheel| {
            first(Channel::Stroke(wheel)).map_or(0.0, |stroke_m| stroke_m + 0.0005)
        });
        let loads = PerWheel::from_fn(|wheel| first(Channel::CylinderLoad(wheel)));
        let config = EmulatorConfig {
            effects: effects.clone(),
            solver,
            stroke_m,
            load_n: loads
                .0
                .iter()
                .all(Option::is_some)
                .then(|| loads.map(Option::unwrap_or_default)),
            ..EmulatorConfig::new(machine.clone(), terrain.clone(), None)
        };
        let mut bench = Bench::new(&config, log.name())?;
        bench.settle(&commands)?;
        bench.follow(&commands, log.duration_s())?;
        let notes = bench.watch.notes();
        Ok(Self { series: bench.series, notes, wheel_radius_m: machine.wheels.radius_m })
    }

    /// Our samples, over the log's seconds.
    #[must_use]
    pub const fn all_series(&self) -> &BTreeMap<Channel, Series> {
        &self.series
    }

    /// How far ours is from `log`, which was read with the DBC at `dbc`.
    #[must_use]
    pub fn report(&self, log: &FieldLog, dbc: &Path) -> Report {
        Report {
            log: log.name().to_owned(),
            dbc: dbc.display().to_string(),
            duration_s: log.duration_s(),
            frames: log.frames(),
            faults: log.faults().to_vec(),
            notes: self.notes.clone(),
            rows: rows(log.all_series(), &self.series, self.wheel_radius_m),
        }
    }

    /// Draws ours over `log` into an SVG file.
    ///
    /// # Errors
    /// [`GapError::Write`].
    pub fn draw(&self, log: &FieldLog, path: &Path) -> Result<(), GapError> {
        let title = format!("{}: log (grey) and replay", log.name());
        overlay::write(path, &title, log.all_series(), &self.series, self.wheel_radius_m)
    }
}

/// The emulated machine on our clock, with what it sent.
struct Bench<'a> {
    emulator: Emulator,
    decoder: Decoder,
    speaker: Speaker,
    outbox: Outbox,
    watch: EcuWatch,
    now: SimTime,
    log: &'a str,
    series: BTreeMap<Channel, Series>,
}

/// Refuses a log of two clocks, whose leap would be simulated second by second.
fn steady(log: &FieldLog) -> Result<(), GapError> {
    let leap = log.faults().iter().find_map(|fault| match fault.kind {
        FaultKind::ClockAhead { by_s, .. } if by_s > SILENCE_MAX_S => Some((fault.line, by_s)),
        _ => None,
    });
    leap.map_or(Ok(()), |(line, by_s)| {
        Err(GapError::ClockSteps { log: log.name().to_owned(), line, by_s })
    })
}

/// Refuses a log that does not say whether the drive is enabled: ours stands still until it is told so.
fn drivable(log: &FieldLog) -> Result<(), GapError> {
    let channel = Channel::Enable;
    let is_told = log.series(channel).is_some_and(|series| !series.is_empty());
    let undriven =
        || GapError::Undriven { log: log.name().to_owned(), channel: channel.to_string() };
    if is_told { Ok(()) } else { Err(undriven()) }
}

impl<'a> Bench<'a> {
    fn new(config: &EmulatorConfig, log: &'a str) -> Result<Self, GapError> {
        Ok(Self {
            emulator: Emulator::new(config),
            decoder: Decoder::parse(XT28_DBC, Path::new("xt28.dbc"), &Mapping::default())?,
            speaker: Speaker::default(),
            outbox: Outbox::with_capacity(64),
            watch: EcuWatch::default(),
            now: SimTime::ZERO,
            log,
            series: BTreeMap::new(),
        })
    }

    /// Stands at the first command of each kind.
    fn settle(&mut self, commands: &[(f64, Command)]) -> Result<(), GapError> {
        let first = |is: fn(&Command) -> bool| commands.iter().find(|(_, c)| is(c));
        let firsts = [
            first(|c| matches!(c, Command::Arm { .. })),
            first(|c| matches!(c, Command::Drive { .. })),
        ];
        while self.now.since(SimTime::ZERO) < SETTLE {
            for (_, command) in firsts.into_iter().flatten() {
                self.say(0.0, command)?;
            }
            self.emulator.tick(self.now, &mut self.outbox);
            self.outbox.clear();
            self.now += TICK;
        }
        Ok(())
    }

    /// Follows the commands at their times until `end_s`.
    fn follow(&mut self, commands: &[(f64, Command)], end_s: f64) -> Result<(), GapError> {
        let mut due = commands.iter().peekable();
        loop {
            let at_s = (self.now.since(SimTime::ZERO) + PHASE).as_secs_f64() - SETTLE.as_secs_f64();
            if at_s > end_s {
                return Ok(());
            }
            while let Some((command_s, command)) = due.next_if(|(command_s, _)| *command_s <= at_s)
            {
                self.say(*command_s, command)?;
            }
            let antenna_m = self.emulator.truth().antenna_position_m;
            self.emulator.tick(self.now, &mut self.outbox);
            for frame in self.outbox.frames() {
                self.watch.see(at_s, frame);
                let Some(tap) = self.decoder.tap(frame.id()) else { continue };
                for (channel, value) in tap.values(frame) {
                    if let Ok(value) = value {
                        self.series.entry(channel).or_default().push(at_s, value);
                    }
                }
            }
            for (channel, value) in [Channel::East, Channel::North].into_iter().zip(antenna_m) {
                self.series.entry(channel).or_default().push(at_s, value);
            }
            self.outbox.clear();
            self.now += TICK;
        }
    }

    fn say(&mut self, at_s: f64, command: &Command) -> Result<(), GapError> {
        let frame = self.speaker.frame(command).map_err(|error| GapError::Command {
            log: self.log.to_owned(),
            at_s,
            problem: error.to_string(),
        })?;
        self.emulator.on_frame(self.now, &frame);
        Ok(())
    }
}
