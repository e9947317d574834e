//! What the tyres take of a steering joint: three axles, two joints, one way too few to roll.
//!
//! However the machine moves sideways and turns, the side slips of its three axles cannot all vanish
//! while its joints turn, or stand at angles that belong to no common circle. What must be left of
//! them is one number, along the pattern of side forces that is balanced in itself. Tyres answer it
//! as bristles do: they deflect until they slide, and let go as the wheels roll on.

use std::borrow::Cow;

use xt28_machine::{GRAVITY_M_S2, Machine};
use xt28_sim::Effects;

use super::axles::Axles;
use crate::diagnosis::signals::{DT_S, Make, Samples, Signals};

/// Share of the middle axle's grip at which the tyres slide, against each joint. Below one: the
/// wheels of an axle slide also against their own drive (seen on the nominal logs of a second plant:
/// 18 of 28 kNm at the front joint, 17 at the rear).
const SLIDES_AT: [f64; 2] = [0.68, 0.61];
/// Deflection at which they slide, m, along the pattern (from the same logs).
const SLIDES_M: f64 = 0.009;
/// Rolling in which a deflection is let go, m (from the same logs).
const RELAXATION_M: f64 = 1.2;

/// How fast the tyres of sound machines creep at most, m/s/N (assumed: 8 mm/s for every kN, as those of our own plants
/// do by make; docs/diagnosis-log.md, item 128).
const MAKE_CREEPS_M_S_N: f64 = 8.0e-6;

/// Torque that the front (0) or rear (1) joint needs against the tyres, Nm; left > 0: as effects say, and on tyres of
/// a make that creeps as fast as sound ones do. By how much tyres grip, that differs from make to make; joints hear of
/// slippery ground by how it creeps alone (docs/diagnosis-log.md, items 9 and 127).
#[must_use]
pub(super) fn scrubs_nm(
    signals: &Signals,
    machine: &Machine,
    effects: &Effects,
    joint: usize,
) -> [Samples; 2] {
    let most_nm = most_nm(machine)[joint];
    [Make::Firm, Make::Creeping].map(|make| {
        let scrubs = scrubs(signals, machine, effects, make);
        scrubs.iter().map(|[deflection, _]| most_nm * deflection).collect()
    })
}

/// How much faster than by the ground alone tyres of a make creep, m/s/N.
const fn creeps_m_s_n(make: Make) -> f64 {
    match make {
        Make::Firm => 0.0,
        Make::Creeping => MAKE_CREEPS_M_S_N,
    }
}

/// Torque that each wheel needs against the same tyres, Nm, forward > 0.
///
/// The forces of the pattern do no work but along the slip that is left of the axles: what a joint, as it
/// straightens, puts into the ground beyond that drives the machine on, and its pumps need to do less.
#[must_use]
pub(super) fn scrub_drag_nm(signals: &Signals, machine: &Machine, effects: &Effects) -> Samples {
    let wheel_nm = grip(effects) * most_n(machine) * machine.wheels.radius_m / 6.0;
    scrubs(signals, machine, effects, Make::Firm)
        .iter()
        .map(|[deflection, ahead]| wheel_nm * deflection * ahead)
        .collect()
}

/// Torque against each joint while the tyres slide, Nm.
fn most_nm(machine: &Machine) -> [f64; 2] {
    let axle_n = machine.wheels.friction * machine.mass_kg() * GRAVITY_M_S2 / 3.0;
    SLIDES_AT.map(|share| share * axle_n * Axles::new(machine).lever_m())
}

/// Force along the pattern while they do, N.
fn most_n(machine: &Machine) -> f64 {
    let axles = Axles::new(machine);
    let lever_m = [[1.0, 0.0], [0.0, 1.0]].map(|rate| axles.misfit_m_s([0.0; 2], rate, 0.0));
    let most_nm = most_nm(machine);
    0.5 * (most_nm[0] / lever_m[0] + most_nm[1] / lever_m[1])
}

/// Mean friction of the wheels over nominal friction.
fn grip(effects: &Effects) -> f64 {
    effects.wheels.iter().map(|(_, e)| e.slippery_ground.friction_factor).sum::<f64>() / 6.0
}

/// Deflection along the pattern as a share of the one at which the tyres slide, -1 to 1, and slip along
/// the pattern for each metre that the machine goes ahead with joints that stand; sample by sample.
fn scrubs<'a>(
    signals: &'a Signals,
    machine: &Machine,
    effects: &Effects,
    make: Make,
) -> Cow<'a, [[f64; 2]]> {
    let lets_go_per_s = lets_go_per_s(machine, effects, creeps_m_s_n(make));
    let made = || deflections(signals, machine, lets_go_per_s);
    if effects.wheels.iter().any(|(_, e)| e.slippery_ground.creep_m_s_n > 0.0) {
        return made().into();
    }
    // Of another friction or mass they let go otherwise.
    signals.scrubs(make, lets_go_per_s, made).map_or_else(|| made().into(), Cow::from)
}

/// The same of tyres that let go of `lets_go_per_s` of their deflection while they stand.
fn deflections(signals: &Signals, machine: &Machine, lets_go_per_s: f64) -> Vec<[f64; 2]> {
    let axles = Axles::new(machine);
    let mut deflection_m = 0.0_f64;
    let step = |i: usize| {
        let angle = [0, 1].map(|j| signals.joint_rad[j][i]);
        let rate = [0, 1].map(|j| signals.joint_rate_rad_s[j][i]);
        let ahead = signals.mean_wheel_speed_rad_s(i) * machine.wheels.radius_m;
        let slip = axles.misfit_m_s(angle, rate, ahead);
        deflection_m += DT_S * (slip - ahead.abs() / RELAXATION_M * deflection_m);
        deflection_m /= 1.0 + DT_S * lets_go_per_s;
        deflection_m = deflection_m.clamp(-SLIDES_M, SLIDES_M);
        [deflection_m / SLIDES_M, axles.misfit_m_s(angle, [0.0; 2], 1.0)]
    };
    (0..signals.len).map(step).collect()
}

/// How fast tyres that creep let go of what they are deflected by: as stiff as they slide late, they give way in
/// proportion to their force, the axles each by its part of the pattern. A wheel that does not creep holds its axle.
fn lets_go_per_s(machine: &Machine, effects: &Effects, more_m_s_n: f64) -> f64 {
    let mut holds_n_s_m = [0.0; 3];
    for (w, e) in effects.wheels.iter() {
        holds_n_s_m[w.axle() as usize] += 1.0 / (e.slippery_ground.creep_m_s_n + more_m_s_n);
    }
    let pattern = Axles::new(machine).pattern();
    let gives_m_s_n = (0..3).map(|k| pattern[k] * pattern[k] / holds_n_s_m[k]).sum::<f64>();
    most_n(machine) / SLIDES_M * gives_m_s_n
}

#[cfg(test)]
mod tests {
    use xt28_machine::Wheel;

    use super::super::still::still;
    use super::*;

    #[test]
    fn tyres_that_creep_let_go_of_what_a_joint_deflects_them_by() {
        let (machine, mut s) = (Machine::xt28(), still(4));
        for i in 0..s.len {
            s.joint_rad[0][i] = 0.05 * i as f64 * DT_S;
            s.joint_rate_rad_s[0][i] = 0.05;
        }
        let after = |creep_m_s_n: f64| {
            let mut effects = Effects::default();
            for w in Wheel::ALL {
                effects.wheels[w].slippery_ground.creep_m_s_n = creep_m_s_n;
            }
            scrubs_nm(&s, &machine, &effects, 0)[0][350].abs()
        };
        let [firm, creeping] = [0.0, 1.0e-4].map(after);
        assert!(firm > 10.0e3 && creeping < 0.1 * firm, "{firm}, where they creep {creeping}");
        // What slips along the pattern takes as much of the joint as the joint slips it by, twice two wheels' worth.
        let lever_m = Axles::new(&machine).misfit_m_s([0.0; 2], [1.0, 0.0], 0.0).abs();
        let wanted = 0.05 * lever_m * 2.0 / 1.0e-4 * lever_m;
        assert!((creeping / wanted - 1.0).abs() < 0.1, "{creeping}, not {wanted}");
    }
}
