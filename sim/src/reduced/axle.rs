//! What slows a wheel about its axle within one step: rolling resistance and a brake that holds.
//!
//! Implicit, as contacts are: an impulse against the rate at the step's end. Rolling resistance near rest is
//! steeper than a sliding wheel's own inertia.

use super::spatial::saturating_tanh;
use crate::bodies::RollingDrag;

/// Torque per creep of a holding brake, Nm s (assumed): as stiff as the contacts' friction.
const BRAKE_CREEP_NMS: f64 = 1.0e8;
/// A drag that has come this near to its most has no slope to speak of, as a share of its slope at rest:
/// what is left would not even show in how fast the solver ends, but factors need not be taken anew.
const SATURATED: f64 = 1.0e-8;

/// Rolling resistance over a step: its torque as of the step's start, and what becomes of it as the wheel
/// turns slower or faster.
#[derive(Clone, Copy, Debug)]
struct Drag {
    /// Impulse that it comes to as the wheel turns faster, Nm s.
    most: f64,
    per_fade_s_rad: f64,
    /// Share of `most` in force at the step's start.
    start: f64,
}

impl Drag {
    /// That of `law` on a wheel that turns at `rate_rad_s` when the step begins.
    fn new(law: &RollingDrag, rate_rad_s: f64, dt_s: f64) -> Self {
        if law.most_nm <= 0.0 {
            return Self { most: 0.0, per_fade_s_rad: 1.0, start: 0.0 };
        }
        let per_fade_s_rad = 1.0 / law.fade_rad_s;
        let start = saturating_tanh(rate_rad_s * per_fade_s_rad);
        Self { most: law.most_nm * dt_s, per_fade_s_rad, start }
    }
}

/// One wheel about its axle, ready for the step's solver.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axle {
    drag: Drag,
    /// Largest impulse of the brake, Nm s.
    brake: f64,
    /// Its impulse per rate while it holds, kg m².
    creep: f64,
    /// At the solver's present guess.
    now: Made,
    /// At the guess that is tried.
    next: Made,
    /// Minus the derivative of the impulse where it was taken last, kg m².
    slope: f64,
    /// What the solver's present step would add to the rate, rad/s.
    step_rad_s: f64,
    /// By how much the impulse tried is not the one foreseen, Nm s.
    pub(super) missed: f64,
}

/// What it makes at one rate.
#[derive(Clone, Copy, Debug)]
struct Made {
    rate_rad_s: f64,
    /// On the wheel, beside that of the drag at the step's start, Nm s.
    impulse: f64,
    /// Minus the derivative of that, kg m².
    slope: f64,
}

impl Axle {
    /// A wheel that turns at `rate_rad_s` when the step begins, with a brake that holds `hold_nm`.
    pub(super) fn new(law: &RollingDrag, hold_nm: f64, rate_rad_s: f64, dt_s: f64) -> Self {
        let none = Made { rate_rad_s, impulse: 0.0, slope: 0.0 };
        let mut axle = Self {
            drag: Drag::new(law, rate_rad_s, dt_s),
            brake: hold_nm * dt_s,
            creep: BRAKE_CREEP_NMS * dt_s,
            now: none,
            next: none,
            slope: 0.0,
            step_rad_s: 0.0,
            missed: 0.0,
        };
        axle.now = axle.made(rate_rad_s);
        axle
    }

    fn made(&self, rate_rad_s: f64) -> Made {
        let mut made = Made { rate_rad_s, impulse: 0.0, slope: 0.0 };
        if self.drag.most > 0.0 {
            let share = saturating_tanh(rate_rad_s * self.drag.per_fade_s_rad);
            made.impulse = self.drag.most * (self.drag.start - share);
            let left = 1.0 - share * share;
            if left > SATURATED {
                made.slope = self.drag.most * self.drag.per_fade_s_rad * left;
            }
        }
        let holds = self.creep * rate_rad_s;
        if holds.abs() < self.brake {
            made.slope += self.creep;
        }
        made.impulse -= holds.clamp(-self.brake, self.brake);
        made
    }

    /// Impulse at the present guess, Nm s.
    pub(super) const fn impulse(&self) -> f64 {
        self.now.impulse
    }

    /// Takes the derivative at the present guess; minus that, kg m².
    pub(super) const fn derive(&mut self) -> f64 {
        self.slope = self.now.slope;
        self.slope
    }

    /// Takes what the solver would add to the rate.
    pub(super) const fn set_step(&mut self, step_rad_s: f64) {
        self.step_rad_s = step_rad_s;
    }

    /// Looks at `share` of the step; how much what was missed there works along it.
    pub(super) fn try_share(&mut self, share: f64) -> f64 {
        let step_rad_s = share * self.step_rad_s;
        self.next = self.made(self.now.rate_rad_s + step_rad_s);
        self.missed = self.now.impulse - self.slope * step_rad_s - self.next.impulse;
        self.step_rad_s * self.missed
    }

    /// Makes what was tried the present guess.
    pub(super) const fn take(&mut self) {
        self.now = self.next;
    }
}
