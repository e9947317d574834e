//! Rolling resistance of one wheel, taken at the end of the engine's step.
//!
//! The tyre's block ([`crate::Tyre`]) foresees how its tread will move as if it alone changed the
//! wheel's spin. Beside it, other torques may grow with the spin by some 0.8 J/dt (32 kNm s/rad; J
//! the wheel's inertia, dt 5 ms): beyond, both brake the same spin twice over, and the wheel is thrown
//! to and fro at half the step rate. The drive takes 10 of that, and a front wheel's rolling resistance
//! near rest the remainder from a coefficient of 0.035 on. Taken at the end of a step in which nothing
//! else acts it is still as steep as J/dt, and from 0.07 on no better.
//!
//! So it comes after the tyre, and foresees the spin as the tyre does: from the change over the
//! step before, and from what all that turns the wheel, itself included, has changed since. Linearised
//! with drive, tyre and a rigid machine behind, that is stable for coefficients to 0.5 and more.

use crate::RollingDrag;

/// Most passes of Newton's method: they leave a millionth of the largest torque at most.
const PASSES: usize = 6;
/// A pass that moves the rate by less is the last, in units of the fade: on a wheel that rolls the
/// second is.
const SETTLED: f64 = 1e-9;

/// A wheel's rolling and what it remembers of the step before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rolling {
    inertia_kg_m2: f64,
    rate_rad_s: f64,
    /// All that turned the wheel about its axle, Nm.
    turning_nm: f64,
}

impl Rolling {
    /// A wheel at rest with this inertia about its axle.
    pub(super) const fn new(inertia_kg_m2: f64) -> Self {
        Self { inertia_kg_m2, rate_rad_s: 0.0, turning_nm: 0.0 }
    }

    /// Torque of the rolling resistance over the coming step of `dt_s` s, Nm, on a wheel that turns at
    /// `rate_rad_s` now and that motor and patch are about to turn with `turning_nm`.
    pub(super) fn step(
        &mut self,
        drag: &RollingDrag,
        rate_rad_s: f64,
        turning_nm: f64,
        dt_s: f64,
    ) -> f64 {
        let per_nm = dt_s / self.inertia_kg_m2;
        let free_rad_s =
            2.0 * rate_rad_s - self.rate_rad_s + per_nm * (turning_nm - self.turning_nm);
        let drag_nm = slowed_by_nm(drag, free_rad_s, per_nm);
        self.rate_rad_s = rate_rad_s;
        self.turning_nm = turning_nm + drag_nm;
        drag_nm
    }
}

/// Torque of the drag on a wheel that would turn at `free_rad_s` without it, Nm, and that every Nm
/// slows by `per_nm` rad/s: the one that belongs to the rate which it leaves.
fn slowed_by_nm(drag: &RollingDrag, free_rad_s: f64, per_nm: f64) -> f64 {
    if drag.most_nm <= 0.0 {
        return 0.0;
    }
    // Rates in units of the fade. From rest on tanh bends one way only, so that no pass overshoots.
    let steep = per_nm * drag.most_nm / drag.fade_rad_s;
    let free = free_rad_s.abs() / drag.fade_rad_s;
    let mut rate = 0.0_f64;
    for _ in 0..PASSES {
        let share = rate.tanh();
        let by = (free - rate - steep * share) / (1.0 + steep * (1.0 - share * share));
        rate += by;
        if by.abs() < SETTLED {
            break;
        }
    }
    -(drag.most_nm * rate.tanh()).copysign(free_rad_s)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn the_torque_belongs_to_the_rate_that_it_leaves(
            most_nm in 0.0..5.0e4_f64, free_rad_s in -5.0..5.0_f64, per_nm in 1e-6..1e-4_f64,
        ) {
            let drag = RollingDrag::tanh(most_nm, 0.05, 0.0);
            let nm = slowed_by_nm(&drag, free_rad_s, per_nm);
            let left_rad_s = free_rad_s + per_nm * nm;
            prop_assert!(left_rad_s * free_rad_s >= 0.0, "it turns the wheel around: {left_rad_s}");
            let wanted_nm = RollingDrag::tanh(most_nm, 0.05, left_rad_s).torque_nm;
            prop_assert!((nm - wanted_nm).abs() <= 1e-4 * most_nm, "{nm}, not {wanted_nm}");
        }
    }

    /// Pushed by less than the most, a wheel comes to creep at the rate that bears the push.
    #[test]
    fn a_lone_wheel_bears_a_push_without_shaking() {
        let (inertia_kg_m2, dt_s) = (200.0, 0.005);
        for most_nm in [300.0, 3e3, 3e4] {
            let (mut rolling, mut rate_rad_s) = (Rolling::new(inertia_kg_m2), 1.0);
            let push_nm = 0.5 * most_nm;
            let mut last = rate_rad_s;
            for _ in 0..4000 {
                let drag = RollingDrag::tanh(most_nm, 0.05, rate_rad_s);
                let nm = rolling.step(&drag, rate_rad_s, push_nm, dt_s);
                last = rate_rad_s;
                rate_rad_s += dt_s / inertia_kg_m2 * (push_nm + nm);
            }
            let bears_rad_s = 0.05 * 0.5_f64.atanh();
            assert!((rate_rad_s / bears_rad_s - 1.0).abs() < 1e-6, "{most_nm}: {rate_rad_s}");
            assert!((rate_rad_s - last).abs() < 1e-9, "{most_nm}: {last}, {rate_rad_s}");
        }
    }
}
