//! What the tyres take of a steering joint: three axles, two joints, one way too few to roll.
//!
//! However the machine moves sideways and turns, the side slips of its three axles cannot all vanish
//! while its joints turn, or stand at angles that belong to no common circle. What must be left of
//! them is one number, along the pattern of side forces that is balanced in itself. Tyres answer it
//! as bristles do: they deflect until they slide, and let go as the wheels roll on.

use xt28_machine::{Machine, Wheel};
use xt28_sim::Effects;

use super::axles::Axles;
use crate::diagnosis::signals::{DT_S, Samples, Signals};

/// Share of the middle axle's grip at which the tyres slide, against each joint. Below one: the
/// wheels of an axle slide also against their own drive (seen on the nominal logs of a second plant:
/// 18 of 28 kNm at the front joint, 17 at the rear).
const SLIDES_AT: [f64; 2] = [0.68, 0.61];
/// Deflection at which they slide, m, along the pattern (from the same logs).
const SLIDES_M: f64 = 0.009;
/// Rolling in which a deflection is let go, m (from the same logs).
const RELAXATION_M: f64 = 1.2;

/// Torque that the front (0) or rear (1) joint needs against the tyres, Nm; left > 0.
#[must_use]
pub(super) fn scrub_nm(
    signals: &Signals,
    machine: &Machine,
    effects: &Effects,
    joint: usize,
) -> Samples {
    let grip: f64 =
        Wheel::ALL.iter().map(|w| effects.wheels[*w].slippery_ground.friction_factor).sum();
    let axles = Axles::new(machine);
    let axle_n = machine.mass_kg() * xt28_machine::GRAVITY_M_S2 / 3.0;
    let most_nm =
        SLIDES_AT[joint] * machine.wheels.friction * grip / 6.0 * axle_n * axles.lever_m();
    let mut deflection_m = 0.0_f64;
    (0..signals.len)
        .map(|i| {
            let angle = [0, 1].map(|j| signals.joint_rad[j][i]);
            let rate = [0, 1].map(|j| signals.joint_rate_rad_s[j][i]);
            let ahead = signals.mean_wheel_speed_rad_s(i) * machine.wheels.radius_m;
            let slip = axles.misfit_m_s(angle, rate, ahead);
            deflection_m += DT_S * (slip - ahead.abs() / RELAXATION_M * deflection_m);
            deflection_m = deflection_m.clamp(-SLIDES_M, SLIDES_M);
            most_nm * deflection_m / SLIDES_M
        })
        .collect()
}
