//! A run of the emulated machine with exact sensors: its frames, its receiver's messages, and what was true.

use ecu_emu::{Emulator, EmulatorConfig, TICK};
use xt28_dbc::e2e::AliveCounter;
use xt28_dbc::{Frame, Outbox};
use xt28_machine::{Machine, SimTime};
use xt28_sim::{Effects, Terrain, VehicleState};
use xt28_ubx::{Message, Parser};

use crate::drive_off::{LASTS_S, commands};

/// What was sent and what was true, tick by tick.
pub(crate) struct Recording {
    /// Frames of each tick.
    pub(crate) frames: Vec<Vec<Frame>>,
    /// What the sensors felt at each tick.
    pub(crate) truth: Vec<VehicleState>,
    /// Messages of the receiver, each with the number of its tick.
    pub(crate) messages: Vec<(usize, Message)>,
}

impl Recording {
    /// The machine with these effects: its arms extend, it drives, it bends.
    pub(crate) fn of(effects: &Effects) -> Self {
        let machine = EmulatorConfig::new(Machine::xt28(), Terrain::Flat, None);
        let config = EmulatorConfig { effects: effects.clone(), ..machine };
        let mut emulator = Emulator::new(&config);
        let mut recording = Self { frames: vec![], truth: vec![], messages: vec![] };
        let (mut counters, mut now) = ([AliveCounter::default(); 2], SimTime::ZERO);
        let (mut parser, mut bytes) = (Parser::new(), Vec::new());
        while now.as_secs_f64() < LASTS_S {
            for frame in commands(now.as_secs_f64(), &mut counters) {
                emulator.on_frame(now, &frame);
            }
            recording.truth.push(emulator.truth());
            let mut out = Outbox::with_capacity(64);
            emulator.tick(now, &mut out);
            recording.frames.push(out.frames().to_vec());
            emulator.take_gnss(&mut bytes);
            let tick = recording.truth.len() - 1;
            recording.messages.extend(parser.push(&bytes).map(|message| (tick, message)));
            bytes.clear();
            now += TICK;
        }
        recording
    }

    /// One signal, once a tick, of the message that `decode` takes.
    pub(crate) fn each<M, E>(
        &self,
        decode: fn(&Frame) -> Result<M, E>,
        signal: impl Fn(&M) -> f64,
    ) -> Vec<f64> {
        let of_tick = |frames: &Vec<Frame>| {
            let message = frames.iter().find_map(|frame| decode(frame).ok());
            signal(&message.expect("it is sent every tick"))
        };
        self.frames.iter().map(of_tick).collect()
    }
}

/// Number of the tick at this time.
pub(crate) fn tick_at(t_s: f64) -> usize {
    (t_s / TICK.as_secs_f64()).round() as usize
}
