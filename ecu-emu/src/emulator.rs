//! Two ECUs, an engine, a receiver and a plant, advanced together in ticks of 10 ms.

use core::time::Duration;

use xt28_dbc::messages::Eec1;
use xt28_dbc::{Frame, Outbox};
use xt28_ecus::{ArmEcu, ArmOutputs, DriveEcu, DriveOutputs, Port};
use xt28_machine::{Machine, PerWheel, SimTime};
use xt28_sim::{Effects, GnssReceiver, Imu, Plant, STEP, Sensors, Terrain, Vehicle, VehicleState};
use xt28_ubx::Geodetic;

use crate::ecu_effects;
use crate::engine::{self, Engine};
use crate::inbox::Inbox;
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
    /// What is true of it beyond the nominal machine: in plant, sensors, ECUs and on the bus.
    pub effects: Effects,
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
    /// The nominal machine on `terrain`, arms at 0.17 m, noise from `seed`.
    #[must_use]
    pub fn new(machine: Machine, terrain: Terrain, seed: Option<u64>) -> Self {
        Self {
            machine,
            effects: Effects::default(),
            terrain,
            stroke_m: PerWheel::splat(0.17),
            load_n: None,
            seed,
            origin: Geodetic::BENCH_ORIGIN,
        }
    }
}

/// The emulated machine, seen from its CAN bus and its receiver's serial port.
pub struct Emulator {
    arm_ecu: ArmEcu,
    drive_ecu: DriveEcu,
    arm_out: ArmOutputs,
    drive_out: DriveOutputs,
    inbox: Inbox,
    engine: Engine,
    eec1_due: SimTime,
    sensors: Sensors,
    imu: Imu,
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
        let effects = &config.effects;
        let mut plant = Vehicle::with(machine, effects, &config.terrain, config.stroke_m, STEP);
        let engine = Engine::new(machine.drive.engine_speed_rpm);
        for _ in 0..SETTLE.as_nanos() / STEP.as_nanos() {
            let setting = wiring::setting(config, plant.state(), engine.speed_rpm());
            plant.step(&setting);
        }
        Self {
            arm_ecu: ecu_effects::arm_ecu(machine, effects),
            drive_ecu: ecu_effects::drive_ecu(machine, effects),
            arm_out: ArmOutputs::default(),
            drive_out: DriveOutputs::default(),
            inbox: Inbox::new(effects.bus, config.seed),
            engine,
            eec1_due: SimTime::ZERO,
            sensors: Sensors::new(effects),
            imu: Imu::new(effects),
            gnss: GnssReceiver::new(machine, effects, config.seed),
            receiver: Receiver::new(config.origin),
            gnss_bytes: Vec::with_capacity(512),
            plant,
        }
    }

    /// A frame from the bus that both ECUs sit on (`CAN_1`).
    pub fn on_frame(&mut self, now: SimTime, frame: &Frame) {
        if self.inbox.is_direct() {
            self.hear(now, frame);
        } else {
            self.inbox.put(now, frame);
        }
    }

    fn hear(&mut self, now: SimTime, frame: &Frame) {
        self.arm_ecu.on_frame(now, Port::Can1, frame);
        self.drive_ecu.on_frame(now, Port::Can1, frame);
    }

    /// One tick at `now`: sensors are read, both ECUs run, the plant moves on to the next tick.
    /// Frames for the bus are added to `out`.
    pub fn tick(&mut self, now: SimTime, out: &mut Outbox) {
        while let Some((at, frame)) = self.inbox.take_due(now) {
            self.hear(at, &frame);
        }
        let state = *self.plant.state();
        let readings = self.sensors.read(&state);
        for frame in wiring::imu_frames(&self.imu.step(&state)) {
            self.arm_ecu.on_frame(now, Port::Can2, &frame);
        }
        let eec1 = engine::eec1(state.engine_speed_rpm);
        self.drive_ecu.on_frame(now, Port::Can3, &eec1);

        self.arm_ecu.tick(now, &wiring::arm_pins(&readings), &mut self.arm_out);
        self.drive_ecu.tick(now, &wiring::drive_pins(&readings), &mut self.drive_out);
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
