//! The pendulum-arm ECU ("SMS"): commands and sensors in, solenoid currents and frames out.

mod attitude;
mod automatic;
mod command;
mod frames;
mod position_control;
mod sensing;
mod stroke_limit;

use std::sync::Arc;

use xt28_dbc::e2e::AliveCounter;
use xt28_dbc::messages::{ArmTarget, ArmValve};
use xt28_dbc::{Frame, Outbox};
use xt28_machine::{Machine, PerWheel, SimTime, Wheel};

use self::attitude::AttitudeFilter;
use self::automatic::{Automatic, Currents};
use self::command::{ArmCommands, ArmDemand};
use self::position_control::PositionControl;
pub use self::position_control::PositionGains;
use self::sensing::{ArmReadings, ArmSensing};
use self::stroke_limit::StrokeLimit;
use crate::diagnostics::{ARM, ArmData, ArmMonitor, ArmSeen, Diagnostics};
use crate::input_check::Supply;
use crate::life::{Commanded, Health, SELF_TEST, State};
use crate::power::{Cause, Power, Running};
use crate::{Port, Refusal, pins};

/// What the arm ECU's input pins carry, mV.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmPins {
    /// Position sensors of the cylinders.
    pub stroke_mv: PerWheel<f64>,
    /// Pressure sensors of the bore chambers (A).
    pub pressure_a_mv: PerWheel<f64>,
    /// Pressure sensors of the rod chambers (B).
    pub pressure_b_mv: PerWheel<f64>,
    /// Supply.
    pub supply_mv: f64,
}

/// What the arm ECU puts out in a tick.
#[derive(Clone, Debug, Default)]
pub struct ArmOutputs {
    /// Current of the solenoids that retract (A), mA.
    pub solenoid_a_ma: PerWheel<f64>,
    /// Current of the solenoids that extend (B), mA.
    pub solenoid_b_ma: PerWheel<f64>,
    /// Frames for the bus with the gateway.
    pub can1: Outbox,
    /// Outputs that put a passive accumulator on its cylinder; firmware of 2016 only.
    pub accumulator_on: PerWheel<bool>,
    /// Frames for the inertial unit's bus.
    pub can2: Outbox,
    /// Frames for the display's bus; firmware of 2016 only.
    pub can4: Outbox,
}

/// The pendulum-arm ECU, profile of the paper: modes off, automatic, manual position and manual
/// valve. The passive accumulators are under all of them: they are hydraulics, not control.
///
/// The soft limits are the ends of the paper's stroke range, not the 20 and 460 mm of the public
/// firmware (facts 3.6).
#[derive(Clone, Debug)]
pub struct ArmEcu {
    commands: ArmCommands,
    state: State,
    refusal: Refusal,
    /// A silence stopped what was carried out, and lasts.
    commands_lost: bool,
    gains: PerWheel<PositionGains>,
    limit: StrokeLimit,
    control: PerWheel<PositionControl>,
    automatic: Automatic,
    sensing: ArmSensing,
    attitude: AttitudeFilter,
    counter: AliveCounter,
    monitor: ArmMonitor,
    diagnostics: Diagnostics<ArmData>,
    power: Power,
    /// Why it started anew, until it is taken into use again.
    restarted_by: Option<Cause>,
    /// What it starts anew from.
    machine: Arc<Machine>,
}

impl ArmEcu {
    /// An ECU just switched on.
    #[must_use]
    pub fn new(machine: &Machine) -> Self {
        Self::boot(Arc::new(machine.clone()), Diagnostics::new(&ARM))
    }

    fn boot(machine: Arc<Machine>, diagnostics: Diagnostics<ArmData>) -> Self {
        Self {
            commands: ArmCommands::new(machine.arms.stroke_max_m),
            state: State::Init,
            refusal: Refusal::None,
            commands_lost: false,
            gains: PerWheel::splat(PositionGains::new(&machine.hydraulics)),
            limit: StrokeLimit::up_to(machine.arms.stroke_max_m),
            control: PerWheel::splat(PositionControl::default()),
            automatic: Automatic::new(&machine),
            sensing: ArmSensing::new(&machine),
            attitude: AttitudeFilter::default(),
            counter: AliveCounter::default(),
            monitor: ArmMonitor::new(&machine),
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
        let diagnostics = self.diagnostics.clone().restart(&ARM);
        let gains = self.gains;
        let fresh = Self::boot(Arc::clone(&self.machine), diagnostics);
        *self = Self { gains, state: SELF_TEST, restarted_by: Some(cause), ..fresh };
    }

    /// Sets the gains of the manual modes, arm by arm, as a service tool would.
    pub const fn set_position_gains(&mut self, gains: PerWheel<PositionGains>) {
        self.gains = gains;
    }

    /// A frame that arrived at `port`. Frames that are not for this ECU are left alone.
    pub fn on_frame(&mut self, now: SimTime, port: Port, frame: &Frame) {
        if !self.power.is_on() {
            return;
        }
        let taken = match (port, frame.id()) {
            (Port::Can1, ArmTarget::ID) => self.commands.on_target(now, frame),
            (Port::Can1, ArmValve::ID) => self.commands.on_valve(now, frame),
            (Port::Can2, _) => {
                if let Some(reading) = pins::read_imu(frame) {
                    self.attitude.on_reading(now, reading);
                }
                return;
            }
            (Port::Can1, _) => return self.diagnostics.on_frame(now, frame),
            _ => return,
        };
        if let Err(refusal) = taken {
            self.refusal = refusal;
        }
    }

    /// One task period of 10 ms. `out` is cleared and filled.
    pub fn tick(&mut self, now: SimTime, pins: &ArmPins, out: &mut ArmOutputs) {
        match self.power.step(now, pins.supply_mv) {
            Running::On => {}
            Running::Started(cause) => self.restart(cause),
            Running::Off => return out.go_dark(),
        }
        let readings = self.sensing.step(pins);
        self.attitude.step();
        let demand = self.commands.fresh(now);
        let (health, faults) = self.diagnose(now, pins, &readings, demand.as_ref());
        let commanded =
            demand.map(|d| Commanded { request: d.request(), frames: self.commands.frames() });
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

        let demand = demand.filter(|_| self.state == State::Active).unwrap_or(ArmDemand::Off);
        let currents = self.currents(&demand, &readings, health);
        out.solenoid_a_ma = currents.actual_ma.map(|[a, _]| a);
        out.solenoid_b_ma = currents.actual_ma.map(|[_, b]| b);

        out.can1.clear();
        out.can2.clear();
        frames::pressures(&readings, &mut out.can1);
        frames::motion(&readings, &mut out.can1);
        frames::forces(&readings, &mut out.can1);
        frames::attitude(&readings, &self.attitude, &mut out.can1);
        frames::currents(&currents, &mut out.can1);
        let status = frames::Status {
            demand: &demand,
            state: self.state,
            faults,
            accepted: self.commands.accepted(),
            refusal: self.refusal,
            supply: Supply::read(pins.supply_mv),
            counter: self.counter.next_count(),
        };
        frames::status(&status, &mut out.can1);
        self.monitor.commanded(currents.actual_ma.map(|[a, b]| pins::valve_opening(a, b)));
        let data = self.data(pins, &readings, &currents);
        self.diagnostics.tick(now, data, &mut out.can1);
    }

    /// Where the ECU is in its life.
    #[must_use]
    pub const fn state(&self) -> State {
        self.state
    }

    /// What the solenoids get for a demand.
    fn currents(&mut self, demand: &ArmDemand, readings: &ArmReadings, health: Health) -> Currents {
        if let ArmDemand::Automatic(height_m) = demand {
            self.control = PerWheel::splat(PositionControl::default());
            // One false input sets all six arms in motion, so all wait until it is known for broken.
            if health == Health::Doubtful {
                self.automatic.reset();
                return Currents::default();
            }
            let angles_deg = self.attitude.angles_deg();
            return self.automatic.step(*height_m, readings, angles_deg, &self.limit);
        }
        self.automatic.reset();
        let wanted = self.openings(demand, readings);
        let opening = PerWheel::from_fn(|w| self.limit.hold(wanted[w], readings.stroke_mm[w]));
        Currents::immediate(opening.map(pins::valve_ma))
    }

    /// Valve openings of the manual modes, + extends.
    fn openings(&mut self, demand: &ArmDemand, readings: &ArmReadings) -> PerWheel<f64> {
        let ArmDemand::Position(target_mm) = demand else {
            self.control = PerWheel::splat(PositionControl::default());
            return match demand {
                // Only a stroke that is known says which way an arm may still go.
                ArmDemand::Valve(opening) => PerWheel::from_fn(|w| {
                    if self.monitor.trusts(w) { self.gains[w].bounded(opening[w]) } else { 0.0 }
                }),
                _ => PerWheel::splat(0.0),
            };
        };
        PerWheel::from_fn(|wheel: Wheel| {
            let control = &mut self.control[wheel];
            // An arm whose stroke is in doubt waits where it is.
            if let Some(target_mm) = target_mm[wheel].filter(|_| self.monitor.trusts(wheel)) {
                control.step(&self.gains[wheel], target_mm, readings.stroke_mm[wheel])
            } else {
                control.reset();
                0.0
            }
        })
    }

    /// What stops the arms: the inputs that are in the loop of the mode asked for. In the manual
    /// modes those are the strokes, in automatic all that there are (facts 3.9).
    fn diagnose(
        &mut self,
        now: SimTime,
        pins: &ArmPins,
        readings: &ArmReadings,
        demand: Option<&ArmDemand>,
    ) -> (Health, u16) {
        let seen = ArmSeen {
            stroke_mm: &readings.stroke_mm,
            attitude_lost: self.attitude.is_lost(now),
            commands_lost: demand.is_none() && self.commands_lost,
            restarted_by: self.restarted_by,
        };
        let found = self.monitor.step(now, pins, seen, self.diagnostics.memory());
        let needed = match demand {
            Some(ArmDemand::Automatic(_)) if seen.attitude_lost => Health::Broken,
            Some(ArmDemand::Automatic(_)) => found.position.max(found.pressure),
            _ => found.position,
        };
        (needed, found.faults)
    }

    /// What a service tool may ask for until the next task period.
    fn data(&self, pins: &ArmPins, readings: &ArmReadings, currents: &Currents) -> ArmData {
        ArmData {
            state: self.state,
            pins: Some(*pins),
            stroke_mm: readings.stroke_mm,
            pressure_a_kpa: readings.pressure_a_kpa,
            pressure_b_kpa: readings.pressure_b_kpa,
            load_dan: readings.load_dan,
            attitude_deg: self.attitude.angles_deg(),
            current_ma: currents.actual_ma,
        }
    }
}

impl ArmOutputs {
    /// As an ECU without a supply leaves it: no current, no frame.
    pub(crate) fn go_dark(&mut self) {
        self.solenoid_a_ma = PerWheel::splat(0.0);
        self.solenoid_b_ma = PerWheel::splat(0.0);
        self.accumulator_on = PerWheel::splat(false);
        self.can1.clear();
        self.can2.clear();
        self.can4.clear();
    }
}
