//! The transmission and steering ECU ("DMS"): commands and sensors in, currents and frames out.

mod brake;
mod droop;
mod engine;
mod frames;
mod sensing;
mod sequence;
mod slip_trim;
mod steering;
mod turn;

use std::sync::Arc;

use xt28_dbc::e2e::AliveCounter;
use xt28_dbc::messages::DriveTarget;
use xt28_dbc::{Frame, Outbox};
use xt28_machine::{Machine, PerWheel, SimTime};

use self::brake::ParkingBrake;
use self::droop::Relief;
use self::engine::EngineLink;
use self::sensing::DriveReadings;
use self::sequence::{ThrottleLag, displacements};
use self::slip_trim::SlipTrim;
use self::steering::Steering;
pub use self::steering::SteeringGains;
use crate::command_stream::CommandStream;
use crate::diagnostics::{DRIVE, Diagnostics, DriveData, DriveMonitor, DriveSeen};
use crate::life::{Commanded, Health, Request, SELF_TEST, State};
use crate::pins::Calibration;
use crate::power::{Cause, Power, Running};
use crate::{Port, Refusal, pins};

/// What the drive ECU's input pins carry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrivePins {
    /// Sensor of the front joint, mV.
    pub joint_front_mv: f64,
    /// Sensor of the rear joint, mV.
    pub joint_rear_mv: f64,
    /// Speed sensors of the wheel motors, Hz.
    pub wheel_hz: PerWheel<f64>,
    /// Their directions.
    pub wheel_forward: PerWheel<bool>,
    /// Pressure sensors of pumps 1A 1B 2A 2B, mV.
    pub pump_mv: [f64; 4],
    /// Supply, mV.
    pub supply_mv: f64,
}

/// What the drive ECU puts out in a tick.
#[derive(Clone, Debug, Default)]
pub struct DriveOutputs {
    /// Front steering valve, left, mA.
    pub steer_front_a_ma: f64,
    /// Front steering valve, right, mA.
    pub steer_front_b_ma: f64,
    /// Rear steering valve, left, mA.
    pub steer_rear_a_ma: f64,
    /// Rear steering valve, right, mA.
    pub steer_rear_b_ma: f64,
    /// Pumps 1A 1B 2A 2B (A reverse, B forward), mA.
    pub pump_ma: [f64; 4],
    /// Wheel motors, mA; none is full displacement.
    pub motor_ma: PerWheel<f64>,
    /// The spring-applied parking brake is released.
    pub brake_released: bool,
    /// Frames for the bus with the gateway.
    pub can1: Outbox,
    /// Frames for the engine.
    pub can3: Outbox,
    /// Frames for the display's bus, which the arm ECU reads too; firmware of 2016 only.
    pub can4: Outbox,
}

/// What a drive command asks for.
#[derive(Clone, Copy, Debug)]
struct DriveDemand {
    /// -1 (reverse) to 1.
    throttle: f64,
    /// Left > 0.
    front_deg: f64,
    brake: bool,
    enable: bool,
}

/// The transmission and steering ECU, profile of the paper.
///
/// A lost command takes the throttle's demand to zero at once (behind its lag), holds the joints, and applies the parking
/// brake when the machine stands, or after 5 s.
#[derive(Clone, Debug)]
pub struct DriveEcu {
    commands: CommandStream<DriveDemand>,
    state: State,
    refusal: Refusal,
    /// A silence stopped what was carried out, and lasts.
    commands_lost: bool,
    throttle: ThrottleLag,
    trim: SlipTrim,
    relief: Relief,
    working_rpm: f64,
    steering: Steering,
    brake: ParkingBrake,
    engine: EngineLink,
    sensors: Calibration,
    wheel_radius_m: f64,
    status_counter: AliveCounter,
    wheel_counter: AliveCounter,
    monitor: DriveMonitor,
    diagnostics: Diagnostics<DriveData>,
    power: Power,
    /// Why it started anew, until it is taken into use again.
    restarted_by: Option<Cause>,
    /// What it starts anew from.
    machine: Arc<Machine>,
}

impl DriveEcu {
    /// An ECU just switched on.
    #[must_use]
    pub fn new(machine: &Machine) -> Self {
        Self::boot(Arc::new(machine.clone()), Diagnostics::new(&DRIVE))
    }

    fn boot(machine: Arc<Machine>, diagnostics: Diagnostics<DriveData>) -> Self {
        Self {
            commands: CommandStream::default(),
            state: State::Init,
            refusal: Refusal::None,
            commands_lost: false,
            throttle: ThrottleLag::new(&machine.drive),
            trim: SlipTrim::new(&machine),
            relief: Relief::default(),
            working_rpm: machine.drive.engine_speed_rpm,
            steering: Steering::new(&machine.articulation),
            brake: ParkingBrake::default(),
            engine: EngineLink::new(machine.drive.engine_speed_rpm),
            sensors: Calibration::of(&machine),
            wheel_radius_m: machine.wheels.radius_m,
            status_counter: AliveCounter::default(),
            wheel_counter: AliveCounter::default(),
            monitor: DriveMonitor::new(&machine),
            diagnostics,
            power: Power::default(),
            restarted_by: None,
            machine,
        }
    }

    /// Pulls the reset line for a moment: the ECU goes dark and starts anew.
    pub fn reset(&mut self, now: SimTime) {
        self.power.reset(now);
    }

    /// Starts anew: all is forgotten but the trouble codes and the gains.
    fn restart(&mut self, cause: Cause) {
        let diagnostics = self.diagnostics.clone().restart(&DRIVE);
        let gains = self.steering.gains();
        let fresh = Self::boot(Arc::clone(&self.machine), diagnostics);
        *self = Self { state: SELF_TEST, restarted_by: Some(cause), ..fresh };
        self.steering.set_gains(gains);
    }

    /// Sets the gains of the steering, as a service tool would.
    pub const fn set_steering_gains(&mut self, gains: SteeringGains) {
        self.steering.set_gains(gains);
    }

    /// A frame that arrived at `port`. Frames that are not for this ECU are left alone.
    pub fn on_frame(&mut self, now: SimTime, port: Port, frame: &Frame) {
        if !self.power.is_on() {
            return;
        }
        match (port, frame.id()) {
            (Port::Can1, DriveTarget::ID) => {
                if let Err(refusal) = self.on_target(now, frame) {
                    self.refusal = refusal;
                }
            }
            (Port::Can1, _) => self.diagnostics.on_frame(now, frame),
            (Port::Can3, _) => self.engine.on_frame(now, frame),
            _ => {}
        }
    }

    /// One task period of 10 ms. `out` is cleared and filled.
    pub fn tick(&mut self, now: SimTime, pins: &DrivePins, out: &mut DriveOutputs) {
        match self.power.step(now, pins.supply_mv) {
            Running::On => {}
            Running::Started(cause) => self.restart(cause),
            Running::Off => return out.go_dark(),
        }
        let readings = sensing::read(pins, &self.sensors, self.wheel_radius_m);
        let demand = self.commands.fresh(now);
        let (health, faults) = self.diagnose(now, pins, demand.is_none());
        let commanded = demand.map(|d| Commanded {
            request: if d.enable { Request::Move } else { Request::Rest },
            frames: self.commands.frames(),
        });
        let before = self.state;
        self.state = before.next(health, commanded);
        if matches!(self.state, State::Standby | State::Active) {
            self.restarted_by = None;
        }
        let refusal = self.state.refusal(before, commanded);
        self.refusal = refusal.unwrap_or(self.refusal);
        // Not read off the last refusal: any frame may change that, and it outlives the silence.
        let stopped = self.commands_lost || refusal == Some(Refusal::Deadline);
        self.commands_lost = commanded.is_none() && stopped;

        let braked = self.brake.step(now, self.state, demand.map(|d| d.brake), readings.speed_m_s);
        out.brake_released = !braked;
        let active = demand.filter(|_| self.state == State::Active);
        let throttle = active.filter(|_| !braked).map_or(0.0, |d| d.throttle);
        let pump = self.drive(now, throttle, braked, &readings, out);
        // Both joints wait while one of them may not be where its sensor says.
        let steered = active.filter(|_| health == Health::Good);
        self.steer(steered, &readings, out);

        out.can1.clear();
        out.can3.clear();
        out.can3.push(self.engine.request_frame());
        let mut can1 = core::mem::take(&mut out.can1);
        frames::sensors(&readings, self.wheel_counter.next_count(), &mut can1);
        frames::currents(out, &mut can1);
        frames::machine(&readings, braked, pump, &self.engine, &mut can1);
        let status = frames::Status {
            state: self.state,
            faults,
            accepted: self.commands.accepted(),
            refusal: self.refusal,
            brake: braked,
            speed_m_s: readings.speed_m_s,
            counter: self.status_counter.next_count(),
        };
        frames::status(&status, &mut can1);
        let data = self.data(pins, &readings, out);
        self.diagnostics.tick(now, data, &mut can1);
        out.can1 = can1;
    }

    /// Where the ECU is in its life.
    #[must_use]
    pub const fn state(&self) -> State {
        self.state
    }

    fn on_target(&mut self, now: SimTime, frame: &Frame) -> Result<(), Refusal> {
        let target = DriveTarget::decode(frame)?;
        let demand = DriveDemand {
            throttle: target.throttle_percent * 1e-2,
            front_deg: target.front_angle_deg,
            brake: target.brake,
            enable: target.enable,
        };
        // A throttle without enable is a sender that contradicts itself.
        let content = if !target.enable && target.throttle_percent != 0.0 {
            Err(Refusal::NotEnabled)
        } else {
            Ok(demand)
        };
        self.commands.offer(now, target.counter, content)?;
        self.engine.request(target.engine_speed_rpm);
        Ok(())
    }

    /// Displacements for the throttle; returns the one asked of the pumps. A braked machine is not
    /// driven.
    fn drive(
        &mut self,
        now: SimTime,
        throttle: f64,
        braked: bool,
        readings: &DriveReadings,
        out: &mut DriveOutputs,
    ) -> f64 {
        if braked {
            self.throttle.reset();
        }
        let driven = throttle != 0.0;
        let target = droop::demand(throttle, self.working_rpm, self.engine.asked_rpm());
        let share = self.relief.step(self.engine.step(now), driven);
        let displacement = displacements(self.throttle.step(target) * share);
        let [a_ma, b_ma] = pins::pump_ma(displacement.pump);
        let asked = pins::pump_displacement(a_ma, b_ma);
        if asked == 0.0 {
            self.trim.reset();
        }
        let trim = if driven {
            self.trim.step(&readings.wheel_rad_s, readings.joint_deg)
        } else {
            self.trim.hold()
        };
        let [one, two] = trim.pump.map(|share| pins::pump_ma(displacement.pump * share));
        out.pump_ma = [one[0], one[1], two[0], two[1]];
        out.motor_ma = trim.motor.map(|share| pins::motor_ma(displacement.motor * share));
        asked
    }

    fn steer(
        &mut self,
        demand: Option<DriveDemand>,
        readings: &DriveReadings,
        out: &mut DriveOutputs,
    ) {
        let [front, rear] = match demand {
            Some(demand) => {
                self.steering.step(demand.front_deg, readings.joint_deg, readings.speed_m_s)
            }
            None => self.steering.hold(),
        };
        [out.steer_front_a_ma, out.steer_front_b_ma] = pins::steer_ma(front);
        [out.steer_rear_a_ma, out.steer_rear_b_ma] = pins::steer_ma(rear);
    }

    /// Only the joint sensors can stop the machine: they close the steering loop.
    fn diagnose(&mut self, now: SimTime, pins: &DrivePins, silence: bool) -> (Health, u16) {
        let seen = DriveSeen {
            engine_lost: self.engine.is_lost(now),
            commands_lost: silence && self.commands_lost,
            restarted_by: self.restarted_by,
        };
        self.monitor.step(now, pins, seen, self.diagnostics.memory())
    }

    /// What a service tool may ask for until the next task period.
    fn data(&self, pins: &DrivePins, readings: &DriveReadings, out: &DriveOutputs) -> DriveData {
        DriveData {
            state: self.state,
            pins: Some(*pins),
            joint_deg: readings.joint_deg,
            wheel_rpm: readings.wheel_rad_s.map(|rad_s| rad_s * 60.0 / core::f64::consts::TAU),
            pump_bar: readings.pump_pa.map(|pa| pa * 1e-5),
            engine_rpm: self.engine.speed_rpm(),
            pump_ma: out.pump_ma,
            motor_ma: out.motor_ma,
        }
    }
}

impl DriveOutputs {
    /// As an ECU without a supply leaves it: no current, no frame, the brake's spring closed.
    pub(crate) fn go_dark(&mut self) {
        let [can1, can3, can4] = [&mut self.can1, &mut self.can3, &mut self.can4].map(|outbox| {
            outbox.clear();
            core::mem::take(outbox)
        });
        *self = Self { can1, can3, can4, ..Self::default() };
    }
}
