//! Two ECUs, an engine, a receiver and a plant, advanced together in ticks of 10 ms.

use core::time::Duration;

use xt28_dbc::messages::Eec1;
use xt28_dbc::{Frame, Outbox};
use xt28_ecus::{ArmEcu, ArmOutputs, DriveEcu, DriveOutputs, Port};
use xt28_machine::{Machine, PerWheel, SimTime};
use xt28_sim::{GnssReceiver, Imu, Plant, STEP, Terrain, Vehicle, VehicleState};
use xt28_ubx::Geodetic;

use crate::engine::Engine;
use crate::receiver::Receiver;
use crate::wiring;

/// One task period of both ECUs.
pub const TICK: Duration = Duration::from_millis(10);
/// How long the machine stands before a run, so that it starts settled.
const SETTLE: Duration = Duration::from_secs(5);

/// What an emulated machine is made of.
#[derive(Clone, Debug)]
pub struct EmulatorConfig {
    /// The machine's numbers.
    pub machine: Machine,
    /// What it stands on.
    pub terrain: Terrain,
    /// Strokes at the start, m.
    pub stroke_m: PerWheel<f64>,
    /// Loads of the cylinders at the start, N, where they are known. Six wheels carry a stiff machine
    /// in many ways at all but the same strokes; without loads it is as the springs would have it.
    pub load_n: Option<PerWheel<f64>>,
    /// Seed of the sensor noise; without one the sensors are exact.
    pub seed: Option<u64>,
    /// Where the receiver believes the start to be.
    pub origin: Geodetic,
}

impl EmulatorConfig {
    /// The machine on `terrain`, arms at 0.17 m, noise from `seed`.
    #[must_use]
    pub const fn new(machine: Machine, terrain: Terrain, seed: Option<u64>) -> Self {
        let stroke_m = PerWheel::splat(0.17);
        Self { machine, terrain, stroke_m, load_n: None, seed, origin: Geodetic::BENCH_ORIGIN }
    }
}

/// The emulated machine, seen from its CAN bus and its receiver's serial port.
pub struct Emulator {
    arm_ecu: ArmEcu,
    drive_ecu: DriveEcu,
    arm_out: ArmOutputs,
    drive_out: DriveOutputs,
    engine: Engine,
    eec1_due: SimTime,
    gnss: GnssReceiver,
    receiver: Receiver,
    gnss_bytes: Vec<u8>,
    plant: Vehicle,
}

impl Emulator {
    /// A machine that has stood for 5 s, its arms set to their strokes by hand.
    #[must_use]
    pub fn new(config: &EmulatorConfig) -> Self {
        let machine = &config.machine;
        let mut plant = Vehicle::new(machine, &config.terrain, config.stroke_m);
        let engine = Engine::new(machine.drive.engine_speed_rpm);
        for _ in 0..SETTLE.as_nanos() / STEP.as_nanos() {
            let setting = wiring::setting(config, plant.state(), engine.speed_rpm());
            plant.step(&setting);
        }
        Self {
            arm_ecu: ArmEcu::new(machine),
            drive_ecu: DriveEcu::new(machine),
            arm_out: ArmOutputs::default(),
            drive_out: DriveOutputs::default(),
            engine,
            eec1_due: SimTime::ZERO,
            gnss: GnssReceiver::new(machine, config.seed),
            receiver: Receiver::new(config.origin),
            gnss_bytes: Vec::with_capacity(512),
            plant,
        }
    }

    /// A frame from the bus that both ECUs sit on (`CAN_1`).
    pub fn on_frame(&mut self, now: SimTime, frame: &Frame) {
        self.arm_ecu.on_frame(now, Port::Can1, frame);
        self.drive_ecu.on_frame(now, Port::Can1, frame);
    }

    /// One tick at `now`: sensors are read, both ECUs run, the plant moves on to the next tick.
    /// Frames for the bus are added to `out`.
    pub fn tick(&mut self, now: SimTime, out: &mut Outbox) {
        let state = *self.plant.state();
        for frame in wiring::imu_frames(&Imu.step(&state)) {
            self.arm_ecu.on_frame(now, Port::Can2, &frame);
        }
        let eec1 = self.engine.eec1();
        self.drive_ecu.on_frame(now, Port::Can3, &eec1);

        self.arm_ecu.tick(now, &wiring::arm_pins(&state), &mut self.arm_out);
        self.drive_ecu.tick(now, &wiring::drive_pins(&state), &mut self.drive_out);
        for frame in self.drive_out.can3.frames() {
            self.engine.on_frame(frame);
        }
        let sent = [&self.arm_out.can1, &self.drive_out.can1];
        sent.iter().flat_map(|outbox| outbox.frames()).for_each(|frame| out.push(*frame));
        if now >= self.eec1_due {
            self.eec1_due = now + Eec1::PERIOD;
            out.push(eec1);
        }
        if let Some(fix) = self.gnss.step(now, &state) {
            // A fix that no message can say (a machine on the pole) is a fix that is not there.
            let _ = self.receiver.encode(&fix, &mut self.gnss_bytes);
        }
        self.engine.step(TICK.as_secs_f64());
        let actuation = wiring::actuation(&self.arm_out, &self.drive_out, self.engine.speed_rpm());
        for _ in 0..TICK.as_nanos() / STEP.as_nanos() {
            self.plant.step(&actuation);
        }
    }

    /// The receiver's bytes since the last call, appended to `bytes`.
    pub fn take_gnss(&mut self, bytes: &mut Vec<u8>) {
        bytes.append(&mut self.gnss_bytes);
    }

    /// What is true of the machine now.
    #[must_use]
    pub fn truth(&self) -> &VehicleState {
        self.plant.state()
    }
}
