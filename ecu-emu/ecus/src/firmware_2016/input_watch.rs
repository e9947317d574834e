//! Diagnosis of analogue inputs: out of their window for 200 ms is a fault (facts 3.2).

use core::time::Duration;

use xt28_machine::SimTime;

/// So long out of the window before it is a fault.
const DEBOUNCE: Duration = Duration::from_millis(200);
/// Window of every input but two, mV.
const WINDOW_MV: [f64; 2] = [200.0, 4800.0];
/// Lower end for the position sensors of the front wheels, mV.
const FRONT_POSITION_LOW_MV: f64 = 450.0;

/// Watches one input.
#[derive(Clone, Copy, Debug)]
pub(super) struct InputWatch {
    low_mv: f64,
    out_since: Option<SimTime>,
}

impl Default for InputWatch {
    fn default() -> Self {
        Self { low_mv: WINDOW_MV[0], out_since: None }
    }
}

impl InputWatch {
    /// The window of a front wheel's position sensor.
    pub(super) const fn front_position() -> Self {
        Self { low_mv: FRONT_POSITION_LOW_MV, out_since: None }
    }

    /// Whether `mv` at `now` makes the input a broken one. What is not a number is out.
    pub(super) fn is_broken(&mut self, now: SimTime, mv: f64) -> bool {
        if (self.low_mv..=WINDOW_MV[1]).contains(&mv) {
            self.out_since = None;
            return false;
        }
        now.since(*self.out_since.get_or_insert(now)) >= DEBOUNCE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_after_200_ms_that_clears_by_itself() {
        let mut watch = InputWatch::front_position();
        let at = SimTime::from_millis;
        assert!(!watch.is_broken(at(0), 449.0));
        assert!(!watch.is_broken(at(190), f64::NAN));
        assert!(watch.is_broken(at(200), 4801.0));
        assert!(!watch.is_broken(at(210), 450.0));
        let mut other = InputWatch::default();
        assert!(!other.is_broken(at(0), 449.0) && !other.is_broken(at(300), 200.0));
    }
}
