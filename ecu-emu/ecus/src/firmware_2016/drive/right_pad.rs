//! The right armrest: buttons, mini-joystick, roller (facts 2.7, 4.6, 4.7).

use core::time::Duration;

use xt28_dbc::Frame;
use xt28_machine::SimTime;

use crate::firmware_2016::Quirks;
use crate::firmware_2016::pads::{PadReading, Pattern, read_right};
use crate::firmware_2016::toggle::Toggle;

/// Silence after which the armrest is missed, where it is watched at all.
const DEADLINE: Duration = Duration::from_millis(200);

/// The armrest as the ECU knows it.
#[derive(Clone, Copy, Debug)]
pub(super) struct RightPad {
    quirks: Quirks,
    pattern: Pattern,
    steer_mv: i32,
    roller_mv: Option<i32>,
    heard_at: SimTime,
    pub(super) toggle: Toggle,
}

impl RightPad {
    pub(super) fn new(quirks: Quirks) -> Self {
        Self {
            quirks,
            pattern: Pattern::default(),
            steer_mv: 0,
            roller_mv: None,
            heard_at: SimTime::ZERO,
            toggle: Toggle::default(),
        }
    }

    /// Takes a frame; others than the pad's are left alone.
    pub(super) fn on_frame(&mut self, now: SimTime, frame: &Frame) {
        let Some(reading) = read_right(frame) else { return };
        self.heard_at = now;
        match reading {
            PadReading::Buttons(pattern) => self.pattern = pattern,
            PadReading::Steer(mv) => self.steer_mv = mv,
            PadReading::Roller(mv) => self.roller_mv = Some(mv),
            PadReading::StickX(_) | PadReading::StickY(_) => {}
        }
    }

    /// One tick of the toggle rule.
    pub(super) fn step(&mut self, now: SimTime) {
        if !self.quirks.silence_freezes_inputs && now.since(self.heard_at) > DEADLINE {
            self.pattern = Pattern::default();
            self.steer_mv = 0;
        }
        self.toggle.step(self.pattern, self.quirks.repeated_press_swallowed, 0, &[]);
    }

    /// Mini-joystick, mV; 0 before it spoke, which is rest.
    pub(super) const fn steer_mv(&self) -> i32 {
        self.steer_mv
    }

    /// Roller, mV.
    pub(super) const fn roller_mv(&self) -> Option<i32> {
        self.roller_mv
    }
}
