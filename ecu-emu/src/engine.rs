//! The diesel engine's own controller: follows the requested speed, says what J1939 has it say.

use core::ops::Range;

use xt28_dbc::Frame;
use xt28_dbc::messages::{Eec1, Eec2, Et1};
use xt28_machine::SimTime;
use xt28_sim::VehicleState;

/// Lowest and highest speed the engine takes a request for, rpm (facts 4.9).
const SPEED_RANGE_RPM: [f64; 2] = [800.0, 1800.0];
/// Time constant of the governor, s (assumed).
const TIME_CONSTANT_S: f64 = 0.3;
/// Share of its torque that an idling engine takes for itself and its small pumps (assumed).
const LOAD_IDLE: f64 = 0.10;
/// Share of the engine's power that reaches the wheels (assumed).
const EFFICIENCY: f64 = 0.7;
/// Coolant of a warm engine, degC (assumed).
const COOLANT_DEG_C: f64 = 85.0;
/// A slower engine is not loaded but stalling, rad/s (assumed).
const SPEED_MIN_RAD_S: f64 = 10.0;
/// What J1939 says where there is nothing to be said.
const NOT_AVAILABLE: u8 = 0xFF;
const RAD_S_PER_RPM: f64 = core::f64::consts::TAU / 60.0;

/// The engine.
#[derive(Clone, Debug)]
pub(crate) struct Engine {
    speed_rpm: f64,
    requested_rpm: f64,
}

impl Engine {
    /// An engine that runs at `speed_rpm`.
    pub(crate) fn new(speed_rpm: f64) -> Self {
        let [low, high] = SPEED_RANGE_RPM;
        let speed_rpm = speed_rpm.clamp(low, high);
        Self { speed_rpm, requested_rpm: speed_rpm }
    }

    /// Takes the ECU's request: byte 0 = 1 (speed control), bytes 1-2 the speed in 0.125 rpm
    /// (facts 2.8). Anything else is not for the engine.
    pub(crate) fn on_frame(&mut self, frame: &Frame) {
        const REQUEST: u32 = 0x0000_0001;
        if frame.id().raw() != REQUEST || !frame.id().is_extended() {
            return;
        }
        if let [1, low, high, ..] = *frame.data() {
            let rpm = f64::from(u16::from_le_bytes([low, high])) * 0.125;
            self.requested_rpm = rpm.clamp(SPEED_RANGE_RPM[0], SPEED_RANGE_RPM[1]);
        }
    }

    /// Runs for `dt_s` s.
    pub(crate) fn step(&mut self, dt_s: f64) {
        let share = 1.0 - (-dt_s / TIME_CONSTANT_S).exp();
        self.speed_rpm += share * (self.requested_rpm - self.speed_rpm);
    }

    /// Speed that the governor holds, rpm; under load the engine may turn slower.
    pub(crate) const fn speed_rpm(&self) -> f64 {
        self.speed_rpm
    }
}

/// What the engine says on its bus, each frame at its own period.
#[derive(Clone, Debug)]
pub(crate) struct EngineSpeaker {
    torque_max_nm: f64,
    due: [SimTime; 3],
}

impl EngineSpeaker {
    /// That of an engine with `torque_max_nm`.
    pub(crate) const fn new(torque_max_nm: f64) -> Self {
        Self { torque_max_nm, due: [SimTime::ZERO; 3] }
    }

    /// The frames due at `now`: speed, load, coolant.
    pub(crate) fn frames(&mut self, now: SimTime, state: &VehicleState) -> [Option<Frame>; 3] {
        let said = [
            (Eec1::PERIOD, eec1(state.engine_speed_rpm)),
            (Eec2::PERIOD, self.eec2(state)),
            (Et1::PERIOD, et1()),
        ];
        let mut frames = [None; 3];
        for ((frame, due), (period, said)) in frames.iter_mut().zip(&mut self.due).zip(said) {
            if now >= *due {
                *due = now + period;
                *frame = Some(said);
            }
        }
        frames
    }

    /// Torque that the wheels take of the engine, as a share of its greatest.
    fn eec2(&self, state: &VehicleState) -> Frame {
        let wheels = state.wheel_torque_nm.0.iter().zip(&state.wheel_speed_rad_s.0);
        let power_w: f64 = wheels.map(|(torque, speed)| torque * speed).sum();
        let engine_rad_s = (state.engine_speed_rpm * RAD_S_PER_RPM).max(SPEED_MIN_RAD_S);
        let torque_nm = power_w.max(0.0) / EFFICIENCY / engine_rad_s;
        let load_percent = (100.0 * (LOAD_IDLE + torque_nm / self.torque_max_nm)).clamp(0.0, 125.0);
        let frame = Eec2 { load_percent }.encode().expect("a clamped load is in the frame's range");
        saying_only(2..3, frame)
    }
}

fn et1() -> Frame {
    let frame = Et1 { coolant_deg_c: COOLANT_DEG_C }.encode();
    saying_only(0..1, frame.expect("a temperature in the frame's range"))
}

/// The engine's frame at a speed; a speed that the frame cannot say is said as its nearest.
fn eec1(speed_rpm: f64) -> Frame {
    let engine_speed_rpm = speed_rpm.clamp(0.0, SPEED_RANGE_RPM[1]);
    let frame =
        Eec1 { engine_speed_rpm }.encode().expect("a clamped speed is in the frame's range");
    saying_only(3..5, frame)
}

/// The frame with all but those bytes "not available" (SAE J1939-71, 5.1.4; the recorded machine's too). Zeros
/// there are a torque of -125 % and oil at -273 degC to whoever reads them.
fn saying_only(bytes: Range<usize>, mut frame: Frame) -> Frame {
    let others = frame.data_mut().iter_mut().enumerate().filter(|(i, _)| !bytes.contains(i));
    others.for_each(|(_, byte)| *byte = NOT_AVAILABLE);
    frame
}

#[cfg(test)]
mod tests {
    use xt28_dbc::CanId;

    use super::*;

    /// The request of 1800 rpm (14400 eighths) from an engine of 1200, its mode byte so.
    fn asked(id: CanId, mode: u8) -> Engine {
        let mut engine = Engine::new(1200.0);
        engine.on_frame(&Frame::new(id, &[mode, 0x40, 0x38, 0, 255, 0, 255, 255]).unwrap());
        engine
    }

    #[test]
    fn a_request_is_followed_within_the_governors_time() {
        let mut engine = asked(CanId::Extended(1), 1);
        (0..30).for_each(|_| engine.step(0.01));
        let wanted_rpm = 1800.0 - 600.0 * (-1.0_f64).exp();
        assert!((engine.speed_rpm() - wanted_rpm).abs() < 1e-6, "{}", engine.speed_rpm());
        (0..1000).for_each(|_| engine.step(0.01));
        assert!((engine.speed_rpm() - 1800.0).abs() < 1e-6);
    }

    #[test]
    fn what_is_no_request_is_left_alone() {
        for (id, mode) in
            [(CanId::Extended(2), 1), (CanId::Standard(1), 1), (CanId::Extended(1), 0)]
        {
            let mut engine = asked(id, mode);
            engine.step(10.0);
            assert_eq!(engine.speed_rpm(), 1200.0, "{id} {mode}");
        }
        assert_eq!([Engine::new(100.0), Engine::new(9e9)].map(|e| e.speed_rpm()), SPEED_RANGE_RPM);
    }

    #[test]
    fn what_the_engine_does_not_say_is_not_available() {
        let state = VehicleState { engine_speed_rpm: 1200.0, ..VehicleState::default() };
        let frames = EngineSpeaker::new(1300.0).frames(SimTime::ZERO, &state);
        let said = frames.map(|frame| format!("{:?}", frame.expect("all are due at first")));
        // The first as in the logs of the recorded machine. 10 % of load, 125 - 40 degC.
        let wanted =
            ["0CF00400#FFFFFF8025FFFFFF", "0CF00300#FFFF0AFFFFFFFFFF", "18FEEE00#7DFFFFFFFFFFFFFF"];
        assert_eq!(said, wanted);
    }
}
