//! The diesel engine's own controller: follows the requested speed, says EEC1.

use xt28_dbc::Frame;
use xt28_dbc::messages::Eec1;

/// Lowest and highest speed the engine takes a request for, rpm (facts 4.9).
const SPEED_RANGE_RPM: [f64; 2] = [800.0, 1800.0];
/// Time constant of the governor, s (assumed).
const TIME_CONSTANT_S: f64 = 0.3;

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

/// The engine's frame at a speed; a speed that the frame cannot say is said as its nearest.
pub(crate) fn eec1(speed_rpm: f64) -> Frame {
    let engine_speed_rpm = speed_rpm.clamp(0.0, SPEED_RANGE_RPM[1]);
    Eec1 { engine_speed_rpm }.encode().expect("a clamped speed is in the frame's range")
}
