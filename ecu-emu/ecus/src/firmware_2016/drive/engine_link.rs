//! The engine: speed, load and coolant in, the speed request out (facts 2.8, 4.9).

use core::time::Duration;

use xt28_dbc::messages::{Eec1, Eec2, EngineRequest, Et1};
use xt28_dbc::{CanId, Frame};

use crate::firmware_2016::Quirks;

const REQUEST_ID: CanId = EngineRequest::ID;
/// Speeds that may be asked for, rpm; the first is asked until the roller has been at its start.
const REQUEST_RPM: [i32; 2] = [800, 1800];
/// The roller: rpm and mV at its end, and what one gives of the other.
const ROLLER_END: [i32; 2] = [2000, 4500];
const ROLLER_SPAN: [i32; 2] = [1200, 4298];
/// Below this the roller counts as at its start, mV, once so long has passed since power-up.
const ROLLER_START_MV: i32 = 222;
const ROLLER_WAIT: Duration = Duration::from_secs(2);
/// Load that J1939 calls not available.
const NOT_AVAILABLE: f64 = 255.0;
/// Offset of the coolant in its frame, degC.
const COOLANT_OFFSET: i32 = 40;

/// What the drive ECU knows of the engine, and whether the roller may speak.
#[derive(Clone, Copy, Debug)]
pub(super) struct EngineLink {
    quirks: Quirks,
    pub(super) speed_rpm: f64,
    pub(super) load_percent: f64,
    /// degC; -40 before the first frame.
    pub(super) coolant_deg_c: i32,
    /// Sum of raw coolant + 1 over the frames heard; wraps.
    pub(super) coolant_sum: i32,
    armed: bool,
}

impl EngineLink {
    pub(super) const fn new(quirks: Quirks) -> Self {
        Self {
            quirks,
            speed_rpm: 0.0,
            load_percent: 0.0,
            coolant_deg_c: -COOLANT_OFFSET,
            coolant_sum: 0,
            armed: false,
        }
    }

    /// A frame of the engine; those that the firmware does not use are left alone.
    pub(super) fn on_frame(&mut self, frame: &Frame) {
        if let Ok(eec1) = Eec1::decode(frame) {
            self.speed_rpm = eec1.engine_speed_rpm;
        } else if let Ok(eec2) = Eec2::decode(frame) {
            if self.quirks.load_not_available_is_255 || eec2.load_percent < NOT_AVAILABLE {
                self.load_percent = eec2.load_percent;
            }
        } else if let Ok(et1) = Et1::decode(frame) {
            #[allow(clippy::cast_possible_truncation)] // a byte less 40
            let coolant = et1.coolant_deg_c as i32;
            self.coolant_deg_c = coolant;
            self.coolant_sum = self.coolant_sum.wrapping_add(coolant + COOLANT_OFFSET + 1);
        }
    }

    /// The request at this tick, `powered` after power-up, for a roller at `roller_mv`: `None` if it
    /// never spoke.
    pub(super) fn request(&mut self, powered: Duration, roller_mv: Option<i32>) -> Frame {
        let mv = roller_mv.or(self.quirks.unheard_input_reads_0_mv.then_some(0));
        let [low, high] = REQUEST_RPM;
        let mut rpm = low;
        if let Some(mv) = mv {
            self.armed |= powered >= ROLLER_WAIT && mv < ROLLER_START_MV;
            if self.armed {
                let [end_rpm, end_mv] = ROLLER_END;
                rpm = (end_rpm + (mv - end_mv) * ROLLER_SPAN[0] / ROLLER_SPAN[1]).clamp(low, high);
            }
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 6400 to 14400
        let [lsb, msb] = ((rpm * 8) as u16).to_le_bytes();
        Frame::new(REQUEST_ID, &[1, lsb, msb, 0, 255, 0, 255, 255]).expect("eight bytes")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rpm(link: &mut EngineLink, s: u64, mv: Option<i32>) -> f64 {
        let frame = link.request(Duration::from_secs(s), mv);
        EngineRequest::decode(&frame).unwrap().speed_rpm
    }

    #[test]
    fn the_roller_speaks_once_it_was_at_its_start() {
        let mut link = EngineLink::new(Quirks::firmware());
        assert_eq!(rpm(&mut link, 1, Some(202)), 800.0, "too early");
        assert_eq!(rpm(&mut link, 3, Some(3000)), 800.0);
        assert_eq!(rpm(&mut link, 3, Some(221)), 806.0, "1200 rpm over 4298 mV, cut off");
        assert_eq!(rpm(&mut link, 3, Some(3000)), 1582.0);
        assert_eq!(rpm(&mut link, 3, Some(4500)), 1800.0);
    }

    /// Facts 4.9: a frame that never came reads 0 mV, and so arms the roller.
    #[test]
    fn silence_arms_the_roller() {
        for (quirks, wanted) in [(Quirks::firmware(), 1582.0), (Quirks::none(), 800.0)] {
            let mut link = EngineLink::new(quirks);
            rpm(&mut link, 3, None);
            assert_eq!(rpm(&mut link, 3, Some(3000)), wanted);
        }
    }

    #[test]
    fn a_load_that_is_not_available_is_taken_at_its_word() {
        for (quirks, wanted) in [(Quirks::firmware(), 255.0), (Quirks::none(), 30.0)] {
            let mut link = EngineLink::new(quirks);
            link.on_frame(&Eec2 { load_percent: 30.0 }.encode().unwrap());
            link.on_frame(&Eec2 { load_percent: 255.0 }.encode().unwrap());
            assert_eq!(link.load_percent, wanted);
        }
    }

    #[test]
    fn coolant_is_known_once_said_and_summed_up() {
        let mut link = EngineLink::new(Quirks::firmware());
        assert_eq!(link.coolant_deg_c, -40);
        link.on_frame(&Et1 { coolant_deg_c: 85.0 }.encode().unwrap());
        link.on_frame(&Et1 { coolant_deg_c: 86.0 }.encode().unwrap());
        assert_eq!((link.coolant_deg_c, link.coolant_sum), (86, 126 + 127));
    }
}
