//! One run: gateway, bus, ECUs and machine stepped together, everything on the bus written down.

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use xt28_dbc::{EncodeError, Frame};
use xt28_machine::SimTime;
use xt28_sim::Placed;

use crate::ecu::TICK_S;
use crate::ecu::arm::{ArmEcu, opening};
use crate::ecu::drive::{DriveEcu, DrivePins};
use crate::machine::{Foreign, Inputs, STEP_S};
use crate::manoeuvre::{Command, Script};
use crate::sensing::Sensors;
use crate::truth::Truth;
use crate::wire::Wire;

/// Time at the first command before the log begins, ticks.
const SETTLE_TICKS: u64 = 500;
/// Steps of the machine in a tick of the ECUs.
const STEPS: u64 = 5;
/// Steps into a tick at which either ECU's task runs.
const ARM_STEP: u64 = 1;
const DRIVE_STEP: u64 = 2;
/// When the senders put their frames on the bus, µs into a tick, and what a frame takes.
const ARM_US: u64 = 2_000;
const DRIVE_US: u64 = 5_000;
const ENGINE_US: u64 = 8_000;
const FRAME_US: u64 = 140;

/// What is true when: each entry holds from its time on, s from the start of the log.
pub(crate) type Timeline = Vec<(f64, Truth)>;

/// Runs `script` on the machine of `timeline`; frames with their times, in order.
///
/// # Errors
/// A number that the wire cannot say: the machine has gone astray.
pub(crate) fn run<B: Placed>(
    timeline: &Timeline,
    script: &Script,
    random: &mut ChaCha8Rng,
) -> Result<Vec<(SimTime, Frame)>, EncodeError> {
    let mut bench = Bench::<B>::new(timeline, script, random);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // some thousands
    let ticks = SETTLE_TICKS + (script.seconds / TICK_S).round() as u64;
    for tick in 0..ticks {
        bench.tick(tick)?;
    }
    let mut log = bench.log;
    log.sort_by_key(|(at, _)| *at);
    Ok(log)
}

struct Bench<'a, B> {
    timeline: &'a Timeline,
    script: &'a Script,
    random: &'a mut ChaCha8Rng,
    machine: Foreign<B>,
    arm: ArmEcu,
    drive: DriveEcu,
    sensors: Sensors,
    wire: Wire,
    inputs: Inputs,
    /// On their way to the ECUs: when they arrive, ticks from the start of settling.
    underway: Vec<(f64, Command, [bool; 2])>,
    heard: Command,
    fixes: u64,
    log: Vec<(SimTime, Frame)>,
}

impl<'a, B: Placed> Bench<'a, B> {
    fn new(timeline: &'a Timeline, script: &'a Script, random: &'a mut ChaCha8Rng) -> Self {
        let first = script.at(0.0);
        let truth = &timeline[0].1;
        let stroke_m = first.stroke_mm.map(|mm| mm * 1e-3);
        let machine = Foreign::new(truth, script.ramp.as_ref(), stroke_m);
        let mut noise = random.clone();
        noise.set_stream(random.get_stream() + 1);
        Self {
            arm: ArmEcu::new(truth),
            drive: DriveEcu::new(truth),
            sensors: Sensors::new(noise, &machine.now(truth), truth.machine.sensors.gnss_antenna_m),
            wire: Wire::default(),
            inputs: Inputs::default(),
            underway: Vec::new(),
            heard: first,
            fixes: 0,
            log: Vec::new(),
            timeline,
            script,
            random,
            machine,
        }
    }

    fn truth_at(&self, time_s: f64) -> &'a Truth {
        let now = self.timeline.iter().rev().find(|(from_s, _)| *from_s <= time_s);
        &now.unwrap_or(&self.timeline[0]).1
    }

    fn tick(&mut self, tick: u64) -> Result<(), EncodeError> {
        #[allow(clippy::cast_precision_loss)] // some thousands
        let time_s = (tick as f64 - SETTLE_TICKS as f64) * TICK_S;
        let truth = self.truth_at(time_s);
        self.command(truth, tick, time_s)?;
        for step in 0..STEPS {
            if step == ARM_STEP {
                self.arm(truth, tick)?;
            }
            if step == DRIVE_STEP {
                self.drive(truth, tick)?;
            }
            #[allow(clippy::cast_precision_loss)]
            let now_s = time_s + step as f64 * STEP_S;
            self.machine.step(truth, &self.inputs, now_s);
        }
        if tick >= SETTLE_TICKS && (tick - SETTLE_TICKS).is_multiple_of(5) {
            let rpm = self.machine.now(truth).engine_rpm;
            self.send(truth, tick, ENGINE_US, vec![Wire::engine(rpm)?]);
        }
        Ok(())
    }

    /// The gateway's turn: commands on their way, and a fix if one is due.
    fn command(&mut self, truth: &Truth, tick: u64, time_s: f64) -> Result<(), EncodeError> {
        let command = self.script.at(time_s);
        let frames = self.wire.commands(&command)?;
        let bus = &truth.bus;
        // Drawn whether used or not, so that the same seed has the same noise without a fault.
        let [late, arm_lost, drive_lost] = [(); 3].map(|()| self.random.random::<f64>());
        let late_s = bus.late_s * late;
        let settled = tick >= SETTLE_TICKS;
        let arrives = [arm_lost, drive_lost].map(|drawn| !settled || drawn >= bus.loss);
        #[allow(clippy::cast_precision_loss)]
        let at = tick as f64 + late_s / TICK_S;
        // One sender: what is later than the next does not overtake it.
        let at = self.underway.last().map_or(at, |(before, ..)| before.max(at));
        self.underway.push((at, command, arrives));
        if settled {
            let late_us = (at * TICK_S * 1e6) - tick as f64 * 1e4;
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let late_us = late_us.max(0.0) as u64;
            for (i, frame) in frames.into_iter().enumerate() {
                if arrives[i] {
                    self.note(truth, tick, late_us + FRAME_US * i as u64, frame);
                }
            }
        }
        let here = self.machine.now(truth);
        self.sensors.watch(&truth.sensors, &here, truth.machine.sensors.gnss_antenna_m);
        if settled && (tick - SETTLE_TICKS) * 2 >= self.fixes * 25 {
            self.fixes += 1;
            let fix = self.sensors.fix(&truth.sensors);
            self.send(truth, tick, 2 * FRAME_US, Wire::fix(&fix)?);
        }
        Ok(())
    }

    fn arm(&mut self, truth: &Truth, tick: u64) -> Result<(), EncodeError> {
        #[allow(clippy::cast_precision_loss)]
        let now = tick as f64 + ARM_US as f64 * 1e-6 / TICK_S;
        while let Some((_, command, arrives)) =
            self.underway.first().copied().filter(|(at, ..)| *at <= now)
        {
            self.underway.remove(0);
            if arrives[0] {
                self.heard.stroke_mm = command.stroke_mm;
            }
            if arrives[1] {
                self.heard.throttle_percent = command.throttle_percent;
                self.heard.front_deg = command.front_deg;
            }
        }
        let here = self.machine.now(truth);
        let pins = self.sensors.arm_pins(&truth.sensors, &here);
        let report = self.arm.tick(truth, &self.heard.stroke_mm, &pins);
        self.inputs.arm = report.current_ma.map(opening);
        if tick >= SETTLE_TICKS {
            let slow = (tick - SETTLE_TICKS).is_multiple_of(5);
            self.send(truth, tick, ARM_US, Wire::arm(&report, slow)?);
        }
        Ok(())
    }

    fn drive(&mut self, truth: &Truth, tick: u64) -> Result<(), EncodeError> {
        let here = self.machine.now(truth);
        let (wheel_rad_s, joint_deg) = self.sensors.drive_pins(&truth.sensors, &here);
        let pins = DrivePins {
            throttle: self.heard.throttle_percent / 100.0,
            target_deg: self.heard.front_deg,
            joint_deg,
            wheel_rad_s,
        };
        let report = self.drive.tick(truth, &pins);
        self.inputs.steer = report.steer;
        self.inputs.drive = report.demand;
        if tick >= SETTLE_TICKS {
            let count = tick - SETTLE_TICKS;
            let frames = self.wire.drive(&report, &wheel_rad_s, joint_deg, here.pump_pa, count)?;
            self.send(truth, tick, DRIVE_US, frames);
        }
        Ok(())
    }

    /// Puts frames of an ECU on the bus, one after another, unless they are lost.
    fn send(&mut self, truth: &Truth, tick: u64, from_us: u64, frames: Vec<Frame>) {
        for (i, frame) in frames.into_iter().enumerate() {
            let lost = self.random.random::<f64>() < truth.bus.loss;
            if !lost {
                self.note(truth, tick, from_us + FRAME_US * i as u64, frame);
            }
        }
    }

    fn note(&mut self, truth: &Truth, tick: u64, from_us: u64, frame: Frame) {
        let uneven = self.random.random::<f64>() * truth.bus.jitter_s * 1e6;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // below a tick
        let at_us = (tick - SETTLE_TICKS) * 10_000 + from_us + uneven as u64;
        self.log.push((SimTime::from_micros(at_us), frame));
    }
}
