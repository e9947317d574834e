//! The left armrest: joystick in mA, silence (facts 2.4, 3.8, 3.9).

use crate::firmware_2016::Quirks;
use crate::firmware_2016::pads::{PadReading, Pattern, read_left};
use crate::firmware_2016::toggle::Toggle;
use crate::firmware_2016::whole::cut;

/// Between these the joystick is at rest, mV.
const REST_MV: [i32; 2] = [2150, 2550];
/// Travel beyond rest, mV, for 300 mA: 4300 mV up; 350 mV is not all of the way down.
const UP_MV: f64 = 1750.0;
const DOWN_MV: f64 = 2200.0;
const DOWN_EVEN_MV: f64 = 1800.0;
const FULL_MA: f64 = 300.0;
/// Added for each run of the fault task without a frame, ms, and above which the pad is lost.
const SILENCE_STEP_MS: u32 = 50;
const SILENCE_MAX_MS: u32 = 180;

/// Levelling, and the buttons that shift its height without ending it.
pub(super) const LEVELLING: u8 = 18;
const SHIFTS: [u8; 2] = [13, 14];

/// The armrest as the ECU knows it.
#[derive(Clone, Copy, Debug)]
pub(super) struct LeftPad {
    quirks: Quirks,
    pattern: Pattern,
    stick_mv: [Option<i32>; 2],
    pub(super) toggle: Toggle,
    silence_ms: u32,
}

impl LeftPad {
    pub(super) fn new(quirks: Quirks) -> Self {
        Self {
            quirks,
            pattern: Pattern::default(),
            stick_mv: [None; 2],
            toggle: Toggle::default(),
            silence_ms: 0,
        }
    }

    /// Takes a frame; others than the pad's are left alone.
    pub(super) fn on_frame(&mut self, frame: &xt28_dbc::Frame) {
        match read_left(frame) {
            Some(PadReading::Buttons(pattern)) => {
                self.pattern = pattern;
                self.silence_ms = 0;
            }
            Some(PadReading::StickX(mv)) => self.stick_mv[0] = Some(mv),
            Some(PadReading::StickY(mv)) => self.stick_mv[1] = Some(mv),
            _ => {}
        }
    }

    /// One tick of the toggle rule.
    pub(super) fn step(&mut self) {
        let swallow = self.quirks.repeated_press_swallowed;
        self.toggle.step(self.pattern, swallow, LEVELLING, &SHIFTS);
    }

    /// The button down now, if it is one alone in its byte.
    pub(super) fn down(&self) -> Option<u8> {
        self.pattern.button()
    }

    /// One run of the fault task, every 50 ms; true while the buttons' frame is missed. The
    /// joystick's frames are not watched.
    pub(super) fn is_lost(&mut self) -> bool {
        let lost = self.silence_ms > SILENCE_MAX_MS;
        self.silence_ms = self.silence_ms.saturating_add(SILENCE_STEP_MS);
        lost
    }

    /// Joystick `[x, y]`, mA.
    pub(super) fn stick_ma(&self) -> [i32; 2] {
        self.stick_mv.map(|mv| match mv {
            Some(mv) => self.axis_ma(mv),
            None if self.quirks.unheard_input_reads_0_mv => self.axis_ma(0),
            None => 0,
        })
    }

    fn axis_ma(&self, mv: i32) -> i32 {
        let [low, high] = REST_MV;
        let down = if self.quirks.joystick_lopsided { DOWN_MV } else { DOWN_EVEN_MV };
        if mv > high {
            cut(f64::from(mv - high) * FULL_MA / UP_MV)
        } else if mv < low {
            cut(f64::from(mv - low) * FULL_MA / down)
        } else {
            0
        }
    }
}
