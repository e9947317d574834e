//! An arm whose valve is open and whose stroke does not change: stuck sensor, or stuck arm.

/// Travel that a valve's opening must have promised before the stroke is missed, m (assumed).
const PROMISED_M: f64 = 0.060;
/// A stroke that moved this far does answer, mm (assumed).
const MOVED_MM: f64 = 3.0;
/// A valve less open than this may be closed for all the ECU knows (assumed: dead band, wear).
const OPENING_MIN: f64 = 0.10;
/// So close to an end the cylinder itself may stop the arm, mm.
const END_MM: f64 = 5.0;

/// Watches one arm. One that did not answer is believed again once it moves.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StallCheck {
    anchor_mm: f64,
    promised_m: f64,
}

impl StallCheck {
    /// One task period: the valve's `opening` (+ extends) as commanded for it, the stroke after it,
    /// and how fast a full opening moves the arm. True while the arm does not answer.
    pub(crate) fn step(
        &mut self,
        opening: f64,
        stroke_mm: f64,
        stroke_max_mm: f64,
        full_travel_m: f64,
    ) -> bool {
        if (stroke_mm - self.anchor_mm).abs() >= MOVED_MM {
            (self.anchor_mm, self.promised_m) = (stroke_mm, 0.0);
        }
        let at_end = (opening < 0.0 && stroke_mm <= END_MM)
            || (opening > 0.0 && stroke_mm >= stroke_max_mm - END_MM);
        if opening.abs() >= OPENING_MIN && !at_end {
            let promised_m = self.promised_m + opening * full_travel_m;
            self.promised_m = promised_m.clamp(-2.0 * PROMISED_M, 2.0 * PROMISED_M);
        }
        self.promised_m.abs() >= PROMISED_M
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Full speed 0.2 m/s, in 10 ms.
    const TRAVEL_M: f64 = 0.002;

    fn ticks_to_stall(opening: f64, mut stroke_mm: impl FnMut(u32) -> f64) -> Option<u32> {
        let mut check = StallCheck::default();
        (0..1000).find(|tick| check.step(opening, stroke_mm(*tick), 500.0, TRAVEL_M))
    }

    #[test]
    fn a_stuck_stroke_under_an_open_valve_is_missed_after_a_second() {
        assert_eq!(ticks_to_stall(0.3, |_| 250.0), Some(99));
        assert_eq!(ticks_to_stall(-0.3, |_| 250.0), Some(99));
        assert_eq!(ticks_to_stall(0.3, |tick| 100.0 + f64::from(tick / 10)), None, "moves slowly");
        assert_eq!(ticks_to_stall(0.09, |_| 250.0), None, "hardly open");
        assert_eq!(ticks_to_stall(0.3, |_| 497.0), None, "at its end");
        assert_eq!(ticks_to_stall(-0.3, |_| 3.0), None, "at its other end");
    }

    #[test]
    fn a_valve_that_swings_promises_nothing_and_movement_is_believed() {
        let mut check = StallCheck::default();
        for tick in 0..1000 {
            let opening = if tick / 20 % 2 == 0 { 0.3 } else { -0.3 };
            assert!(!check.step(opening, 250.0, 500.0, TRAVEL_M));
        }
        (0..200).for_each(|_| _ = check.step(0.3, 250.0, 500.0, TRAVEL_M));
        assert!(check.step(0.0, 250.0, 500.0, TRAVEL_M));
        assert!(!check.step(0.0, 254.0, 500.0, TRAVEL_M));
    }
}
