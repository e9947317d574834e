//! Two ECUs, an engine, a receiver and a plant, advanced together in ticks of 10 ms.

use core::time::Duration;

use xt28_dbc::messages::{Eec1, LeftPadButtons};
use xt28_dbc::{Frame, Outbox};
use xt28_ecus::Profile;
use xt28_ecus::firmware_2016::Quirks;
use xt28_ecus::pins::Calibration;
use xt28_machine::{Machine, PerWheel, SimTime};
use xt28_sim::{
    Actuation, Effects, GnssReceiver, Held, Imu, STEP, Sensors, Solver, Terrain, Track,
    VehicleState,
};
use xt28_ubx::Geodetic;

use crate::acquisition::Acquisition;
use crate::ecus::{Ecus, Outputs, Pins};
use crate::engine::{Engine, EngineSpeaker};
use crate::inbox::Inbox;
use crate::mishaps::Mishaps;
use crate::power::Supplies;
use crate::receiver::Receiver;
use crate::sensor_faults::SensorFaults;
use crate::wires::{Wire, Wires};
use crate::{Cab, Operator, wiring};

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
    /// What solves its rigid bodies.
    pub solver: Solver,
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
    /// Whose control runs in the ECUs.
    pub profile: Profile,
    /// Oddities of the firmware of 2016; that profile only.
    pub quirks: Quirks,
    /// Who sits in the cab; that profile only.
    pub operator: Operator,
    /// What goes wrong with sensors and supply.
    pub mishaps: Mishaps,
}

impl EmulatorConfig {
    /// The nominal machine on `terrain`, arms at 0.17 m, noise from `seed`; the paper's profile.
    #[must_use]
    pub fn new(machine: Machine, terrain: Terrain, seed: Option<u64>) -> Self {
        Self {
            machine,
            effects: Effects::default(),
            solver: Solver::default(),
            terrain,
            stroke_m: PerWheel::splat(0.17),
            load_n: None,
            seed,
            origin: Geodetic::BENCH_ORIGIN,
            profile: Profile::Paper,
            quirks: Quirks::firmware(),
            operator: Operator::idle(),
            mishaps: Mishaps::default(),
        }
    }
}

/// The emulated machine, seen from its CAN bus and its receiver's serial port.
pub struct Emulator {
    profile: Profile,
    ecus: Ecus,
    out: Outputs,
    wires: Wires,
    inbox: Inbox,
    operator: Operator,
    pads_due: SimTime,
    engine: Engine,
    engine_speaker: EngineSpeaker,
    sensors: Sensors,
    calibration: Calibration,
    sensor_faults: SensorFaults,
    acquisition: Acquisition,
    supplies: Supplies,
    imu: Imu,
    gnss: GnssReceiver,
    receiver: Receiver,
    gnss_bytes: Vec<u8>,
    plant: Box<dyn Track + Send>,
    /// Greatest force of the ground on the frames over the last tick, N.
    chassis_force_n: f64,
}

impl Emulator {
    /// A machine that has stood for 5 s, its arms set to their strokes by hand.
    #[must_use]
    pub fn new(config: &EmulatorConfig) -> Self {
        let mut emulator = Self::set_down(config);
        let engine_rpm = emulator.engine.speed_rpm();
        let set = |plant: &mut dyn Track| {
            for _ in 0..SETTLE.as_nanos() / STEP.as_nanos() {
                plant.step(&wiring::setting(config, plant.state(), engine_rpm));
            }
        };
        let arms = PerWheel::default();
        if config.effects.arms == arms {
            set(emulator.plant.as_mut());
            return emulator;
        }
        // By hand, not by the valves: those that are late, dead in the middle or leak set no arm, and what they were
        // told last would work on.
        let sound =
            EmulatorConfig { effects: Effects { arms, ..config.effects }, ..config.clone() };
        let mut plant = Self::set_down(&sound).plant;
        set(plant.as_mut());
        emulator.plant.place(plant.state(), &Actuation::idle(engine_rpm));
        emulator
    }

    /// A machine just set down, its strokes as configured and its springs not yet settled: for one that
    /// is then led along a measurement by [`Self::track`].
    #[must_use]
    pub fn set_down(config: &EmulatorConfig) -> Self {
        let machine = &config.machine;
        let effects = &config.effects;
        let (terrain, stroke_m) = (&config.terrain, config.stroke_m);
        let plant = config.solver.vehicle(machine, effects, terrain, stroke_m, STEP);
        let engine = Engine::new(machine.drive.engine_speed_rpm);
        Self {
            profile: config.profile,
            ecus: Ecus::new(config),
            out: Outputs::default(),
            wires: Wires::default(),
            inbox: Inbox::new(effects.bus, config.seed),
            operator: config.operator.clone(),
            pads_due: SimTime::ZERO,
            engine,
            engine_speaker: EngineSpeaker::new(machine.drive.engine_torque_max_nm),
            sensors: Sensors::new(effects),
            calibration: match config.profile {
                Profile::Paper => Calibration::of(machine),
                // That firmware has its sensors' spans in its code.
                Profile::Firmware2016 => Calibration::default(),
            },
            sensor_faults: SensorFaults::new(&config.mishaps.faults, config.seed),
            acquisition: Acquisition::new(config.seed),
            supplies: Supplies::new(&config.mishaps.events),
            imu: Imu::new(effects),
            gnss: GnssReceiver::new(machine, effects, config.seed),
            receiver: Receiver::new(config.origin),
            gnss_bytes: Vec::with_capacity(512),
            plant,
            chassis_force_n: 0.0,
        }
    }

    /// A frame from the bus that both ECUs sit on (`CAN_1`).
    pub fn on_frame(&mut self, now: SimTime, frame: &Frame) {
        if self.inbox.is_direct() {
            self.ecus.on_bus(now, frame);
        } else {
            self.inbox.put(now, frame);
        }
    }

    /// One tick at `now`: sensors are read, both ECUs run, the plant moves on to the next tick.
    /// Frames for the bus are added to `out`.
    pub fn tick(&mut self, now: SimTime, out: &mut Outbox) {
        let actuation = self.control(now, out);
        self.go_on(|plant| plant.step(&actuation));
    }

    /// One tick at `now` along a measurement: the plant is where `measured` has it, the ECUs read it
    /// there and go on, and what no sensor shows of the plant goes on with them. [`Self::tick`] then
    /// sets out from there.
    pub fn track(&mut self, now: SimTime, measured: &VehicleState, out: &mut Outbox) {
        let actuation = self.control(now, out);
        self.go_on(|plant| plant.track(measured, &actuation));
    }

    /// Puts the plant where `measured` has it, between two ticks.
    pub fn place(&mut self, measured: &VehicleState) {
        let Outputs { arm, drive } = &self.out;
        let actuation = wiring::actuation(arm, drive, self.engine.speed_rpm());
        self.plant.place(measured, &actuation);
        self.chassis_force_n = 0.0;
    }

    /// One tick at `now` in which the blocks of `held` put out what `measured` says.
    pub fn tick_held(
        &mut self,
        now: SimTime,
        measured: &VehicleState,
        held: Held,
        out: &mut Outbox,
    ) {
        let actuation = self.control(now, out);
        self.go_on(|plant| {
            plant.hold(measured, &actuation, held);
            plant.step(&actuation);
        });
    }

    /// The plant's part of a tick, step by step.
    fn go_on(&mut self, mut step: impl FnMut(&mut (dyn Track + Send))) {
        self.chassis_force_n = 0.0;
        for _ in 0..TICK.as_nanos() / STEP.as_nanos() {
            step(&mut *self.plant);
            self.chassis_force_n = self.chassis_force_n.max(self.plant.state().chassis_force_n);
        }
    }

    /// The ECUs' part of a tick: sensors are read, both run; what they then ask of the plant.
    fn control(&mut self, now: SimTime, out: &mut Outbox) -> Actuation {
        while let Some((at, frame)) = self.inbox.take_due(now) {
            self.ecus.on_bus(at, &frame);
        }
        let state = *self.plant.state();
        let readings = self.sensors.read(&state);
        let cab = self.operator.cab(now);
        self.hear_wires(now, &state, &cab);
        let mut pins = Pins {
            arm: wiring::arm_pins(&readings, &self.calibration),
            drive: wiring::drive_pins(&readings, &self.calibration),
            cab: cab.pins(),
        };
        self.sensor_faults.apply(now, &mut pins);
        self.acquisition.read(&mut pins);
        [pins.arm.supply_mv, pins.drive.supply_mv] = self.supplies.voltages_mv(now);
        self.ecus.reset(now, self.supplies.take_resets(now));
        self.ecus.tick(now, &pins, &mut self.out);
        self.out.spread(&mut self.wires);
        self.send(out);
        if let Some(fix) = self.gnss.step(now, &state) {
            // A fix that no message can say (a machine on the pole) is a fix that is not there.
            let _ = self.receiver.encode(&fix, &mut self.gnss_bytes);
        }
        self.engine.step(TICK.as_secs_f64());
        let Outputs { arm, drive } = &self.out;
        wiring::actuation(arm, drive, self.engine.speed_rpm())
    }

    /// What the wires of their own bring the ECUs, and on the display's what was sent in the last
    /// tick.
    fn hear_wires(&mut self, now: SimTime, state: &VehicleState, cab: &Cab) {
        for frame in self.wires.frames(Wire::Display) {
            self.ecus.on_wire(now, Wire::Display, frame);
        }
        self.wires.clear();
        let imu = wiring::imu_frames(&self.imu.step(state));
        if !self.sensor_faults.imu_is_silent(now) {
            self.wires.extend(Wire::Inertial, &imu);
        }
        for frame in self.engine_speaker.frames(now, state).into_iter().flatten() {
            self.wires.extend(Wire::Engine, &[frame]);
        }
        if self.profile == Profile::Firmware2016 && now >= self.pads_due && !cab.pads_silent {
            self.pads_due = now + LeftPadButtons::PERIOD;
            self.wires.extend(Wire::LeftArmrest, &cab.left_frames());
            self.wires.extend(Wire::RightArmrest, &cab.right_frames());
        }
        for wire in [Wire::Inertial, Wire::LeftArmrest, Wire::RightArmrest, Wire::Engine] {
            for frame in self.wires.frames(wire) {
                self.ecus.on_wire(now, wire, frame);
            }
        }
    }

    /// The bus gets what both ECUs send there, the engine what is for it.
    fn send(&mut self, out: &mut Outbox) {
        self.out.bus().for_each(|frame| out.push(*frame));
        for frame in self.wires.frames(Wire::Engine) {
            self.engine.on_frame(frame);
            // The bench's bus shows the engine's speed, as the logs of the paper's machine do.
            if self.profile == Profile::Paper && frame.id() == Eec1::ID {
                out.push(*frame);
            }
        }
    }

    /// A frame from somebody else on another of the machine's wires: an armrest, a display, a bench.
    pub fn on_wire_frame(&mut self, now: SimTime, wire: Wire, frame: &Frame) {
        self.ecus.on_wire(now, wire, frame);
    }

    /// What was on another of the machine's wires in the last tick, in the order it was sent.
    #[must_use]
    pub fn on_wire(&self, wire: Wire) -> &[Frame] {
        self.wires.frames(wire)
    }

    /// The receiver's bytes since the last call, appended to `bytes`.
    pub fn take_gnss(&mut self, bytes: &mut Vec<u8>) {
        bytes.append(&mut self.gnss_bytes);
    }

    /// What is true of the machine now. The force on its frames is the greatest since the last tick: a knock
    /// between two ticks has happened too.
    #[must_use]
    pub fn truth(&self) -> VehicleState {
        let state = *self.plant.state();
        let chassis_force_n = state.chassis_force_n.max(self.chassis_force_n);
        VehicleState { chassis_force_n, ..state }
    }
}

/// A snapshot: ticked alike, it goes on bit for bit like the original.
impl Clone for Emulator {
    fn clone(&self) -> Self {
        Self {
            profile: self.profile,
            ecus: self.ecus.clone(),
            out: self.out.clone(),
            wires: self.wires.clone(),
            inbox: self.inbox.clone(),
            operator: self.operator.clone(),
            pads_due: self.pads_due,
            engine: self.engine.clone(),
            engine_speaker: self.engine_speaker.clone(),
            sensors: self.sensors.clone(),
            calibration: self.calibration,
            sensor_faults: self.sensor_faults.clone(),
            acquisition: self.acquisition.clone(),
            supplies: self.supplies.clone(),
            imu: self.imu,
            gnss: self.gnss.clone(),
            receiver: self.receiver.clone(),
            gnss_bytes: self.gnss_bytes.clone(),
            plant: self.plant.snapshot(),
            chassis_force_n: self.chassis_force_n,
        }
    }
}

#[cfg(test)]
mod tests;
