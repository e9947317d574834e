//! Loads from pressures, the weight's place, and what each cylinder should carry (facts 3.3, 3.4).

use core::f64::consts::FRAC_PI_2;

use xt28_machine::{Axle, Linkage, PerWheel, Side, Wheel};

use super::sensing::Readings;
use crate::firmware_2016::Quirks;
use crate::firmware_2016::whole::cut;

/// Chamber areas in the code, m2.
const AREA_A_M2: f64 = 0.00785;
const AREA_B_M2: f64 = 0.00589;
/// Closed cylinder length in the force code, m.
const CLOSED_LENGTH_M: f64 = 0.82;
/// Track, wheelbase and front to middle axle in the code, m.
const TRACK_M: f64 = 2.35;
pub(super) const WHEELBASE_M: f64 = 6.05;
pub(super) const FRONT_TO_MIDDLE_M: f64 = 3.70;
/// Greatest share of the middle axle: with it the three are equal at 3.25 m.
const MIDDLE_SHARE: f64 = 0.3388;

/// All that follows from pressures and strokes, daN and whole unless said.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Forces {
    pub(super) chamber_a: PerWheel<i32>,
    pub(super) chamber_b: PerWheel<i32>,
    /// Load of each cylinder, > 0 under weight.
    pub(super) load: PerWheel<i32>,
    /// Vertical force on each wheel.
    pub(super) wheel: PerWheel<i32>,
    /// Where the weight is: % of the track from the left, % of the wheelbase from the front axle.
    pub(super) centre_percent: [i32; 2],
    /// Load that each cylinder should have.
    pub(super) reference: PerWheel<i32>,
    /// Sum of the wheel forces that press.
    pub(super) sum_positive: i32,
    /// Sum of the six vertical references.
    pub(super) sum_reference: i32,
}

/// The force code.
#[derive(Clone, Copy, Debug)]
pub(super) struct ForceCode {
    linkage: Linkage,
}

impl ForceCode {
    pub(super) const fn new(linkage: Linkage, quirks: Quirks) -> Self {
        let short = quirks.force_closed_length_0_82;
        Self { linkage: if short { linkage.with_closed_length(CLOSED_LENGTH_M) } else { linkage } }
    }

    /// The forces of this tick.
    pub(super) fn step(&self, r: &Readings) -> Forces {
        let chamber_a = r.pressure_a_kpa.map(|kpa| cut(100.0 * f64::from(kpa) * AREA_A_M2));
        let chamber_b = r.pressure_b_kpa.map(|kpa| cut(100.0 * f64::from(kpa) * AREA_B_M2));
        let load = PerWheel::from_fn(|w| chamber_a[w] - chamber_b[w]);
        let ratio = r.stroke_mm.map(|mm| self.linkage.at_stroke(f64::from(mm) * 1e-3).force_ratio);
        let wheel = PerWheel::from_fn(|w| cut(ratio[w] * f64::from(load[w])));
        let sum_positive = wheel.0.iter().filter(|f| **f > 0).sum();
        let mut forces =
            Forces { chamber_a, chamber_b, load, wheel, sum_positive, ..Forces::default() };
        if let Some(share) = Shares::of(&wheel, sum_positive) {
            let vertical =
                PerWheel::from_fn(|w: Wheel| share.of_wheel(w) * f64::from(sum_positive));
            forces.centre_percent = share.centre_percent;
            forces.reference = PerWheel::from_fn(|w| cut(vertical[w] / ratio[w]));
            forces.sum_reference = cut(vertical.sum());
        }
        forces
    }
}

impl Forces {
    /// (reference - load) / reference of cylinder `w`. The firmware divides by a reference of zero;
    /// ours finds no error there.
    pub(super) fn error(&self, w: Wheel) -> f64 {
        let reference = f64::from(self.reference[w]);
        if reference == 0.0 { 0.0 } else { (reference - f64::from(self.load[w])) / reference }
    }

    /// (load - reference) / reference, %, cut off: the sign of the frame, not of the controller.
    pub(super) fn error_percent(&self, w: Wheel) -> i32 {
        cut(-100.0 * self.error(w))
    }
}

/// Shares of the weight that wheels should carry.
struct Shares {
    centre_percent: [i32; 2],
    axle: [f64; 3],
    right: f64,
}

impl Shares {
    /// `None` where no wheel presses: the firmware divides by zero there.
    fn of(wheel: &PerWheel<i32>, sum: i32) -> Option<Self> {
        if sum == 0 {
            return None;
        }
        let [fr, _, mr, ml, br, bl] = wheel.map(f64::from).0;
        let sum = f64::from(sum);
        let x_m = TRACK_M * (fr + mr + br) / sum;
        let y_m = (FRONT_TO_MIDDLE_M * (ml + mr) + WHEELBASE_M * (bl + br)) / sum;
        let omega = if y_m <= FRONT_TO_MIDDLE_M {
            FRAC_PI_2 * y_m / FRONT_TO_MIDDLE_M
        } else {
            FRAC_PI_2 + FRAC_PI_2 * (y_m - FRONT_TO_MIDDLE_M) / (WHEELBASE_M - FRONT_TO_MIDDLE_M)
        };
        let middle = MIDDLE_SHARE * omega.sin();
        let front = (WHEELBASE_M - y_m - (WHEELBASE_M - FRONT_TO_MIDDLE_M) * middle) / WHEELBASE_M;
        let rear = (y_m - FRONT_TO_MIDDLE_M * middle) / WHEELBASE_M;
        Some(Self {
            centre_percent: [cut(100.0 * x_m / TRACK_M), cut(100.0 * y_m / WHEELBASE_M)],
            axle: [front, middle, rear],
            right: x_m / TRACK_M,
        })
    }

    fn of_wheel(&self, w: Wheel) -> f64 {
        let axle = match w.axle() {
            Axle::Front => self.axle[0],
            Axle::Middle => self.axle[1],
            Axle::Rear => self.axle[2],
        };
        let side = match w.side() {
            Side::Right => self.right,
            Side::Left => 1.0 - self.right,
        };
        axle * side
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shares(wheel: [i32; 6]) -> Shares {
        Shares::of(&PerWheel(wheel), wheel.iter().filter(|f| **f > 0).sum()).unwrap()
    }

    /// Facts 3.4: 2.06 m behind the front axle gives 0.559, 0.260, 0.181; 3.25 m a third each.
    #[test]
    fn shares_of_the_axles_are_the_published_ones() {
        // Front and rear alone: y = 6.05 * rear / all.
        let at = |y_m: f64| {
            let rear = (y_m / WHEELBASE_M * 1e6).round() as i32;
            shares([0, 1_000_000 - rear, 0, 0, 0, rear])
        };
        for (y_m, wanted) in [(2.06, [0.559, 0.260, 0.181]), (3.25, [1.0 / 3.0; 3])] {
            let got = at(y_m).axle;
            assert!(got.iter().zip(wanted).all(|(g, w)| (g - w).abs() < 1e-3), "{got:?}");
            assert!((got.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            let moment = FRONT_TO_MIDDLE_M * got[1] + WHEELBASE_M * got[2];
            assert!((moment - y_m).abs() < 1e-5, "the moment about the front axle is kept");
        }
    }

    #[test]
    fn the_weight_s_place_counts_from_the_left_and_from_the_front() {
        let s = shares([300, 100, 300, 100, 300, 100]);
        assert_eq!(s.centre_percent, [75, 53]);
        assert!((s.of_wheel(Wheel::Fr) / s.of_wheel(Wheel::Fl) - 3.0).abs() < 1e-9);
    }

    #[test]
    fn without_weight_nothing_is_divided_by_it() {
        assert!(Shares::of(&PerWheel::splat(0), 0).is_none());
        assert_eq!(Forces::default().error(Wheel::Fr), 0.0);
    }
}
