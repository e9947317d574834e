//! The engine: its speed and coolant in, the speed request out (facts 2.8).

use core::time::Duration;

use xt28_dbc::messages::{Eec1, Et1};
use xt28_dbc::{CanId, Frame};
use xt28_machine::SimTime;

use crate::life::PERIOD_S;

/// Identifier of the request: proprietary, though shaped like J1939 TSC1.
const REQUEST_ID: CanId = CanId::Extended(0x0000_0001);
/// Speeds that may be requested, rpm (facts 4.9).
const REQUEST_RPM: [f64; 2] = [800.0, 1800.0];
/// rpm per bit of the request.
const RPM_PER_BIT: f64 = 0.125;
/// Without a speed frame for this long the engine is lost: its period is 20 ms (assumed).
const LOST_AFTER: Duration = Duration::from_millis(200);
/// Coolant before the engine has spoken of it, degC (facts 2.5).
const COOLANT_UNKNOWN_DEG_C: f64 = -40.0;
/// Above this J1939 says error or not available, degC (SAE J1939-71: a byte above 250).
const COOLANT_MAX_DEG_C: f64 = 210.0;

/// How soon an engine that is asked for more has it, at the latest: time constant, s (assumed: longer than a
/// governor's).
const SPEEDS_UP_S: f64 = 1.0;

/// What the drive ECU knows of the engine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EngineLink {
    requested_rpm: f64,
    /// What it should have reached by now.
    due_rpm: f64,
    speed_rpm: f64,
    coolant_deg_c: f64,
    heard_at: Option<SimTime>,
}

impl EngineLink {
    pub(crate) const fn new(working_rpm: f64) -> Self {
        Self {
            requested_rpm: working_rpm,
            due_rpm: in_range_rpm(working_rpm),
            speed_rpm: 0.0,
            coolant_deg_c: COOLANT_UNKNOWN_DEG_C,
            heard_at: None,
        }
    }

    /// A frame from the engine; others than its speed and its coolant are left alone.
    pub(crate) fn on_frame(&mut self, now: SimTime, frame: &Frame) {
        if let Ok(eec1) = Eec1::decode(frame) {
            self.speed_rpm = eec1.engine_speed_rpm;
            self.heard_at = Some(now);
        } else if let Ok(et1) = Et1::decode(frame)
            && et1.coolant_deg_c <= COOLANT_MAX_DEG_C
        {
            self.coolant_deg_c = et1.coolant_deg_c;
        }
    }

    /// Takes the speed that a command asks for; it stays when the command is lost.
    pub(crate) const fn request(&mut self, rpm: f64) {
        self.requested_rpm = rpm;
    }

    /// The speed asked of the engine, in its range, rpm.
    pub(crate) const fn asked_rpm(&self) -> f64 {
        in_range_rpm(self.requested_rpm)
    }

    /// One task period. Speed over the speed that an engine asked for this has by now, if nothing drags it; `None`
    /// while nothing is heard of it.
    pub(crate) fn step(&mut self, now: SimTime) -> Option<f64> {
        let missing_rpm = self.asked_rpm() - self.due_rpm;
        let share = if missing_rpm > 0.0 { 1.0 - (-PERIOD_S / SPEEDS_UP_S).exp() } else { 1.0 };
        self.due_rpm += share * missing_rpm;
        (!self.is_lost(now)).then(|| self.speed_rpm / self.due_rpm)
    }

    /// The request: 1 for speed control, then the speed.
    pub(crate) fn request_frame(&self) -> Frame {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 14400 at most
        let raw = (self.asked_rpm() / RPM_PER_BIT).round() as u16;
        let [lsb, msb] = raw.to_le_bytes();
        Frame::new(REQUEST_ID, &[1, lsb, msb, 0, 255, 0, 255, 255]).expect("eight bytes")
    }

    /// Engine speed, rpm; 0 before the first frame.
    pub(crate) const fn speed_rpm(&self) -> f64 {
        self.speed_rpm
    }

    /// Its coolant, degC; -40 before the first frame, and it stays when none comes.
    pub(crate) const fn coolant_deg_c(&self) -> f64 {
        self.coolant_deg_c
    }

    /// True before the first frame, and when none came for too long.
    pub(crate) fn is_lost(&self, now: SimTime) -> bool {
        self.heard_at.is_none_or(|at| now.since(at) > LOST_AFTER)
    }
}

const fn in_range_rpm(rpm: f64) -> f64 {
    let [low, high] = REQUEST_RPM;
    rpm.max(low).min(high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_are_bounded_and_in_eighths_of_rpm() {
        let mut engine = EngineLink::new(1200.0);
        // 1200 rpm are 9600 = 0x2580.
        assert_eq!(engine.request_frame().data(), [1, 0x80, 0x25, 0, 255, 0, 255, 255]);
        for (asked, raw) in [(0.0, 6400), (2550.0, 14_400), (f64::NAN, 6400)] {
            engine.request(asked);
            let frame = engine.request_frame();
            assert_eq!(u16::from_le_bytes([frame.data()[1], frame.data()[2]]), raw);
        }
    }
}
