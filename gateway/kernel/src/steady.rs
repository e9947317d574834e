//! Which readings are ones to start from: those that have not leapt for as long as an ECU takes to call a sensor
//! broken.
//!
//! A target begins where the arm or the joint is. A wire that breaks or touches another reads as an end of the range
//! until the ECU finds it out, and a target that began there would drive the arm away from what is asked.

use crate::{Measured, WHEELS};

/// A stroke that changes by more from one step to the next has leapt, m (assumed: half as much again as a target
/// moves while the sensors may be silent).
const STROKE_LEAP_M: f64 = 0.03;
/// The same of the joint, rad (assumed: 4 degrees, a third more than its target moves meanwhile).
const ANGLE_LEAP_RAD: f64 = 0.07;

/// The readings of the last step, strokes first and then the joint, and when each leapt last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Steadiness {
    reading: [f64; WHEELS + 1],
    leapt_ns: [u64; WHEELS + 1],
}

impl Steadiness {
    /// Nothing was read yet: the first readings are leaps.
    pub(crate) const UNKNOWN: Self =
        Self { reading: [f64::INFINITY; WHEELS + 1], leapt_ns: [0; WHEELS + 1] };

    /// With what is read at `now_ns`. What is not known has leapt.
    pub(crate) fn after(mut self, measured: &Measured, now_ns: u64) -> Self {
        let joint = [(measured.front_angle_rad, ANGLE_LEAP_RAD)];
        let readings = measured.stroke_m.into_iter().map(|stroke_m| (stroke_m, STROKE_LEAP_M));
        for (k, (reading, leap)) in readings.chain(joint).enumerate() {
            let change = libm::fabs(reading - self.reading[k]);
            if change.is_nan() || change > leap {
                self.leapt_ns[k] = now_ns;
            }
            self.reading[k] = reading;
        }
        self
    }

    /// Whether an arm's stroke has been steady for `span_ns`.
    pub(crate) const fn has_arm(&self, wheel: usize, span_ns: u64, now_ns: u64) -> bool {
        now_ns.saturating_sub(self.leapt_ns[wheel]) >= span_ns
    }

    /// Whether all strokes and the joint have been.
    pub(crate) fn has_all(&self, span_ns: u64, now_ns: u64) -> bool {
        (0..=WHEELS).all(|k| self.has_arm(k, span_ns, now_ns))
    }
}
