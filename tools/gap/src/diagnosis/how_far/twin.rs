//! The whole machine, ECUs and plant, set out from measured states on a run's own commands.

use ecu_emu::{Emulator, EmulatorConfig, TICK};
use xt28_dbc::{Frame, Outbox};
use xt28_machine::{Machine, SimTime};
use xt28_sim::effects::BusEffects;
use xt28_sim::{Effects, Held, Solver};

use super::machine_sample::{Horizon, MachineSample, Quantity, TICKS_PER_SAMPLE, fix, measured};
use super::measured::Measured;
use super::reader::Reader;
use crate::commands::{Command, Speaker, commands};
use crate::diagnosis::inquiry::FieldRun;
use crate::diagnosis::onset::FirstOnset;
use crate::diagnosis::signals::{DT_S, Signals};
use crate::{Decoder, GapError};

/// Ticks at the first commands before the log begins: the ECUs wake, their filters settle.
const SETTLE: usize = 300;
/// Ticks from one measured state to the next.
pub(super) const SEGMENT: usize = 500;
/// A segment shorter than this says nothing of 5 s.
const SHORTEST: usize = 300;
/// The ECUs' tick after the log's zero, s: what a gateway sends at the start of its period is taken in
/// the tick it was meant for.
const PHASE_S: f64 = 0.001;

/// A run, ready to be foretold again and again.
#[derive(Clone, Debug)]
pub(super) struct PreparedRun {
    pub(super) signals: Signals,
    pub(super) measured: Vec<MachineSample>,
    /// Commands as our own frames, with the tick that hears them.
    frames: Vec<(usize, Frame)>,
    decoder: Decoder,
}

/// What the machine is foretold to show, from one measured state on.
#[derive(Clone, Debug)]
pub(super) struct Forecast {
    /// Sample of the run that its first sample stands beside.
    pub(super) from: usize,
    pub(super) samples: Vec<MachineSample>,
}

/// The machine on its way along a run.
#[derive(Clone)]
struct Bench<'a> {
    run: &'a PreparedRun,
    emulator: Emulator,
    reader: Reader,
    outbox: Outbox,
    next_frame: usize,
    /// Where the antenna was at every tick, east and north, m.
    antenna_m: Vec<[f64; 2]>,
    gnss_late_s: f64,
}

impl PreparedRun {
    /// # Errors
    /// [`GapError::Command`] for a command that our bus cannot say.
    pub(super) fn new(run: &FieldRun, machine: &Machine) -> Result<Self, GapError> {
        let commands = commands(&run.log, machine.drive.engine_speed_rpm)?;
        let mut speaker = Speaker::default();
        let mut frames = Vec::new();
        let mut say = |tick: usize, at_s: f64, command: &Command| -> Result<(), GapError> {
            let frame = speaker.frame(command).map_err(|error| GapError::Command {
                log: run.log.name().to_owned(),
                at_s,
                problem: error.to_string(),
            })?;
            frames.push((tick, frame));
            Ok(())
        };
        let first = |is: fn(&Command) -> bool| commands.iter().find(|(_, c)| is(c));
        let firsts = [
            first(|c| matches!(c, Command::Arm { .. })),
            first(|c| matches!(c, Command::Drive { .. })),
        ];
        for tick in 0..SETTLE {
            for (_, command) in firsts.into_iter().flatten() {
                say(tick, 0.0, command)?;
            }
        }
        for (at_s, command) in &commands {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let tick = ((at_s - PHASE_S) / DT_S).ceil().max(0.0) as usize;
            say(SETTLE + tick, *at_s, command)?;
        }
        Ok(Self {
            measured: measured(&run.signals),
            signals: run.signals.clone(),
            frames,
            decoder: Reader::decoder()?,
        })
    }

    /// The machine with `before` until `since` in the run and with `effects` from then on.
    ///
    /// A forecast that begins later has them from its start. One that begins earlier goes over from one
    /// machine to the other, whose way is shifted to where the first one is: what else the second had
    /// become by then it keeps, which is little where what it does passes within seconds.
    pub(super) fn foretell_since(
        &self,
        machine: &Machine,
        [before, effects]: [&Effects; 2],
        since: &FirstOnset,
        horizon: Horizon,
    ) -> Vec<Forecast> {
        let foretell = |effects| self.foretell(machine, effects, horizon, Held::default());
        let since_s = since.in_run(self.signals.began_s);
        if since_s <= 0.0 {
            return foretell(effects);
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let since = (since_s / (DT_S * TICKS_PER_SAMPLE as f64)).ceil() as usize;
        let both = foretell(before).into_iter().zip(foretell(effects));
        both.map(|(before, after)| splice(before, &after, since)).collect()
    }

    /// The machine with `effects`, foretold over the run; blocks of `held` put out what was measured.
    pub(super) fn foretell(
        &self,
        machine: &Machine,
        effects: &Effects,
        horizon: Horizon,
        held: Held,
    ) -> Vec<Forecast> {
        let state = Measured::new(&self.signals, machine, effects);
        let mut bench = Bench::new(self, machine, effects, &state);
        // Before the first tick, or the ECUs would hear of an engine at rest.
        bench.emulator.place(&state.at(0));
        for tick in 0..SETTLE {
            bench.track(tick, &state, 0);
        }
        if horizon == Horizon::Run {
            return vec![bench.set_out(0, self.signals.len, &state, held)];
        }
        let mut forecasts = Vec::new();
        let mut from = 0;
        while from + SHORTEST <= self.signals.len {
            let end = (from + SEGMENT).min(self.signals.len);
            forecasts.push(bench.clone().set_out(from, end, &state, held));
            for i in from..end {
                bench.track(SETTLE + i, &state, i);
            }
            from = end;
        }
        forecasts
    }
}

impl<'a> Bench<'a> {
    fn new(
        run: &'a PreparedRun,
        machine: &Machine,
        effects: &Effects,
        state: &Measured<'_>,
    ) -> Self {
        // Commands come when they came in the log: what the bus did to them is in it already.
        let effects = Effects { bus: BusEffects::default(), ..effects.clone() };
        let gnss_late_s = effects.sensors.gnss_latency.delay_s;
        let config = EmulatorConfig {
            effects,
            solver: Solver::Reduced,
            stroke_m: state.at(0).stroke_m,
            ..EmulatorConfig::new(machine.clone(), run.signals.terrain.clone(), None)
        };
        Self {
            run,
            emulator: Emulator::set_down(&config),
            reader: Reader::new(),
            outbox: Outbox::with_capacity(64),
            next_frame: 0,
            antenna_m: Vec::with_capacity(run.signals.len),
            gnss_late_s,
        }
    }

    /// One tick where the log has the machine at its tick `i`.
    fn track(&mut self, tick: usize, state: &Measured<'_>, i: usize) {
        let now = self.hear(tick);
        let state = state.at(i);
        self.emulator.track(now, &state, &mut self.outbox);
        if tick >= SETTLE {
            let [east, north, _] = state.antenna_position_m;
            self.antenna_m.push([east, north]);
        }
        self.reader.hear(&self.run.decoder, self.outbox.frames());
        self.outbox.clear();
    }

    /// From where the log has the machine at its tick `from` on by itself until `end`.
    fn set_out(mut self, from: usize, end: usize, state: &Measured<'_>, held: Held) -> Forecast {
        let start = state.at(from);
        self.emulator.place(&start);
        let first = from.div_ceil(TICKS_PER_SAMPLE);
        let mut samples = Vec::with_capacity((end - from).div_ceil(TICKS_PER_SAMPLE));
        for i in from..end {
            let now = self.hear(SETTLE + i);
            let [east, north, _] = self.emulator.truth().antenna_position_m;
            self.antenna_m.push([east, north]);
            if held == Held::default() {
                self.emulator.tick(now, &mut self.outbox);
            } else {
                self.emulator.tick_held(now, &state.at(i), held, &mut self.outbox);
            }
            self.reader.hear(&self.run.decoder, self.outbox.frames());
            self.outbox.clear();
            if i % TICKS_PER_SAMPLE == 0 {
                let mut sample = self.reader.sample(&self.run.decoder);
                if let Some(place) = self.fix(i) {
                    sample[Quantity::Position.columns()].copy_from_slice(&place);
                }
                samples.push(sample);
            }
        }
        Forecast { from: first, samples }
    }

    /// What the receiver said in the fix that is in force at tick `i`.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn fix(&self, i: usize) -> Option<[f64; 2]> {
        let [at_s, ..] = fix(&self.run.signals, i)?;
        let last = (self.antenna_m.len() - 1) as f64;
        let place = ((at_s - self.gnss_late_s) / DT_S).clamp(0.0, last);
        let (k, share) = (place as usize, place.fract());
        let (a, b) = (self.antenna_m[k], self.antenna_m[(k + 1).min(self.antenna_m.len() - 1)]);
        Some([0, 1].map(|axis| a[axis] + share * (b[axis] - a[axis])))
    }

    /// Lets the ECUs hear the commands of a tick; its instant.
    fn hear(&mut self, tick: usize) -> SimTime {
        let now = SimTime::from_nanos(tick as u64 * TICK.as_nanos() as u64);
        while let Some((_, frame)) =
            self.run.frames.get(self.next_frame).filter(|(at, _)| *at <= tick)
        {
            self.emulator.on_frame(now, frame);
            self.next_frame += 1;
        }
        now
    }
}

/// `before` up to sample `since` of the run, `after` from there on, its way shifted to go on from there.
fn splice(mut before: Forecast, after: &Forecast, since: usize) -> Forecast {
    let from = since.saturating_sub(before.from).min(before.samples.len());
    let mut shift = [0.0; 2];
    if let (Some(last), true) = (from.checked_sub(1), from < before.samples.len()) {
        let columns = Quantity::Position.columns();
        for (shift, c) in shift.iter_mut().zip(columns) {
            let apart = before.samples[last][c] - after.samples[last][c];
            *shift = if apart.is_finite() { apart } else { 0.0 };
        }
    }
    for (ours, theirs) in before.samples[from..].iter_mut().zip(&after.samples[from..]) {
        *ours = *theirs;
        ours[Quantity::Position.columns()].iter_mut().zip(shift).for_each(|(x, by)| *x += by);
    }
    before
}

#[cfg(test)]
mod tests {
    use super::super::machine_sample::WIDTH;
    use super::*;

    #[test]
    fn a_machine_goes_over_at_the_instant_and_from_its_place() {
        let forecast = |value: f64| Forecast { from: 10, samples: vec![[value; WIDTH]; 5] };
        let spliced = splice(forecast(1.0), &forecast(4.0), 12);
        let (stroke, east) = (0, Quantity::Position.columns().start);
        let of = |c: usize| spliced.samples.iter().map(|sample| sample[c]).collect::<Vec<f64>>();
        assert_eq!(of(stroke), [1.0, 1.0, 4.0, 4.0, 4.0]);
        assert_eq!(of(east), [1.0; 5]);
        let all = splice(forecast(1.0), &forecast(4.0), 3);
        assert_eq!((all.samples[0][stroke], all.samples[0][east]), (4.0, 4.0));
        assert_eq!(splice(forecast(1.0), &forecast(4.0), 99).samples, forecast(1.0).samples);
    }
}
