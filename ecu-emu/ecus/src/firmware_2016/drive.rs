//! The transmission and steering ECU ("DMS") of 2016: armrest, pedals and engine in, currents out.

mod engine_link;
mod follower;
mod frames;
mod pedals;
mod pump_regulator;
mod right_pad;
mod sensing;
mod sequence;
mod slip;
mod steering;
mod steering_valve;
mod wheel_speed;

use xt28_dbc::Frame;
use xt28_machine::{PerWheel, SimTime, Wheel};

use self::engine_link::EngineLink;
use self::pedals::{Pedal, SpeedLimit};
use self::pump_regulator::PumpRegulator;
use self::right_pad::RightPad;
use self::sequence::{DriveState, FULL};
use self::slip::Slip;
use self::steering::{SteerInputs, Steering};
use super::{CabPins, Quirks};
use crate::power::{Power, Running};
use crate::{DriveOutputs, DrivePins, Port};

/// Above this filtered pedal no drive state is left, below it the brake may be set, per mille.
const PEDAL_LOW: f64 = 150.0;

/// The transmission and steering ECU as the firmware of 2016 has it.
///
/// Takes the right armrest on [`Port::Can2`] and the engine on [`Port::Can3`]. It knows no timeouts:
/// what falls silent keeps its last value.
#[derive(Clone, Debug)]
pub struct DriveEcu2016 {
    power: Power,
    quirks: Quirks,
    pad: RightPad,
    pedal: Pedal,
    limit: SpeedLimit,
    state: DriveState,
    braked: bool,
    regulator: PumpRegulator,
    slip: Slip,
    steering: Steering,
    engine: EngineLink,
    powered_at: Option<SimTime>,
}

/// What a tick's drive puts out: displacements of the pumps, demands of the circuits.
type Debugged = [i32; 4];

impl DriveEcu2016 {
    /// An ECU just switched on: neutral, parking brake released, front steering.
    #[must_use]
    pub fn new(quirks: Quirks) -> Self {
        Self {
            power: Power::default(),
            quirks,
            pad: RightPad::new(quirks),
            pedal: Pedal::default(),
            limit: SpeedLimit::default(),
            state: DriveState::default(),
            braked: false,
            regulator: PumpRegulator::default(),
            slip: Slip::default(),
            steering: Steering::new(quirks),
            engine: EngineLink::new(quirks),
            powered_at: None,
        }
    }

    /// A frame that arrived at `port`. Frames that are not for this ECU are left alone.
    pub fn on_frame(&mut self, now: SimTime, port: Port, frame: &Frame) {
        if !self.power.is_on() {
            return;
        }
        match port {
            Port::Can2 => self.pad.on_frame(now, frame),
            Port::Can3 => self.engine.on_frame(frame),
            Port::Can1 | Port::Can4 => {}
        }
    }

    /// Pulls the reset line for a moment: the ECU goes dark and forgets all.
    pub fn reset(&mut self, now: SimTime) {
        self.power.reset(now);
    }

    /// One task period of 10 ms. `out` is cleared and filled.
    pub fn tick(&mut self, now: SimTime, pins: &DrivePins, cab: &CabPins, out: &mut DriveOutputs) {
        match self.power.step(now, pins.supply_mv) {
            Running::On => {}
            Running::Started(_) => *self = Self { power: self.power, ..Self::new(self.quirks) },
            Running::Off => return out.go_dark(),
        }
        out.can1.clear();
        out.can3.clear();
        out.can4.clear();
        let powered = now.since(*self.powered_at.get_or_insert(now));
        let (joint, pump) = (sensing::joints(pins), sensing::pumps(pins));
        let chair_front = sensing::chair_front(cab.chair_mv);
        let pedal = self.pedal.step(cab, chair_front);
        let counts = wheel_speed::counts(pins, self.quirks);
        let mean_count = wheel_speed::mean(&counts);
        out.can3.push(self.engine.request(powered, self.pad.roller_mv()));

        self.pad.step(now);
        self.obey();
        self.limit.step(self.engine.load_percent, self.quirks);
        let debugged = self.drive(pedal, pump, &counts, mean_count, out);
        let joystick = steering::joystick(self.pad.steer_mv(), chair_front);
        let inputs = SteerInputs { joystick, joint, mean_count, state: self.state };
        let [front, rear] = self.steering.step(&inputs).map(|sides| sides.map(f64::from));
        [out.steer_front_a_ma, out.steer_front_b_ma] = front;
        [out.steer_rear_a_ma, out.steer_rear_b_ma] = rear;
        out.brake_released = !self.braked;

        let shown = frames::Shown {
            braked: self.braked,
            turn: self.steering.mode(),
            state: self.state,
            chair_front,
            joint,
            engine_rpm: self.engine.speed_rpm,
            coolant_deg_c: self.engine.coolant_deg_c,
            limit_percent: self.limit.user_percent(),
            mean_count,
        };
        let mut can1 = core::mem::take(&mut out.can1);
        frames::sensors(pump, &counts, joint, self.quirks, &mut can1);
        frames::currents(out, &mut can1);
        frames::shown(&shown, cab, &mut can1);
        let coolant = [self.engine.coolant_deg_c, self.engine.coolant_sum];
        let times = if self.quirks.debug_frames_sent_twice { 2 } else { 1 };
        for _ in 0..times {
            frames::debug(debugged, coolant, &mut can1);
        }
        out.can1 = can1;
        frames::shown(&shown, cab, &mut out.can4);
    }

    /// What the buttons ask for (facts 4.4 to 4.7). All act once but the two of the limit.
    fn obey(&mut self) {
        let Some(button) = self.pad.toggle.mode() else { return };
        match button {
            9 => self.regulator.toggle(),
            10 => self.change(DriveState::Reverse),
            11 => self.change(DriveState::Neutral),
            12 => self.change(DriveState::Forward),
            21 => self.change(DriveState::Overdrive),
            13..=15 => self.steering.press(button),
            16 if self.pedal.filtered() < PEDAL_LOW => self.braked = !self.braked,
            19 | 20 if self.pad.toggle.is_held() => {
                self.limit.shift(button == 19);
                return;
            }
            _ => {}
        }
        self.pad.toggle.clear();
    }

    /// Another drive state, unless the pedal is down. Nothing else is asked: not speed, nor door.
    fn change(&mut self, state: DriveState) {
        let free = state == DriveState::Neutral && !self.quirks.neutral_refused_under_pedal;
        if state == self.state || (self.pedal.filtered() > PEDAL_LOW && !free) {
            return;
        }
        self.state = state;
        self.steering.direction_turned();
    }

    /// Pumps and motors: the sequence law, trimmed by slip or by pressures.
    fn drive(
        &mut self,
        pedal: f64,
        pressure: [i32; 4],
        counts: &PerWheel<i32>,
        mean_count: i32,
        out: &mut DriveOutputs,
    ) -> Debugged {
        let second = self.regulator.step(pedal, pressure, self.state, self.quirks);
        let limit = self.limit.in_force();
        let demand = [pedal, second].map(|pedal| pedals::demand(pedal, limit));
        let [first, second] = demand.map(sequence::displacements);
        let slip = self.slip.step(counts, mean_count, self.quirks);
        let slip = if self.regulator.is_on() { PerWheel::splat(0) } else { slip };
        if self.braked {
            out.pump_ma = [0.0; 4];
            out.motor_ma = PerWheel::splat(0.0);
        } else {
            // Motors 1, 4, 6 on pump 1; 2, 3, 5 on pump 2.
            let motor = PerWheel::from_fn(|w| match w {
                Wheel::Fr | Wheel::Ml | Wheel::Bl => first[1],
                Wheel::Fl | Wheel::Mr | Wheel::Br => second[1],
            });
            let displacement = sequence::motors(self.state, motor, slip);
            out.pump_ma = sequence::pumps_ma(self.state, [first[0], second[0]]).map(f64::from);
            out.motor_ma = displacement.map(|d| f64::from(sequence::motor_ma(d, self.quirks)));
        }
        debug_assert!(first[0] <= FULL && second[0] <= FULL);
        if self.regulator.is_on() { [first[0], second[0], demand[0], demand[1]] } else { [0; 4] }
    }
}
