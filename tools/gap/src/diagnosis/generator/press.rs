//! What a wheel presses the ground with, and what radius that leaves it to roll on.

use xt28_machine::{ArmPose, GRAVITY_M_S2, Machine, PerWheel, Wheel};
use xt28_sim::Parts;
use xt28_sim::effects::SoftTyre;

/// Share of a tyre's deflection by which the radius is smaller that it rolls on: a third is a radial
/// tyre's, the whole a rigid band's; models that put the contact midway have a half.
const RADIUS_SHARE: f64 = 0.45;

/// Weight of a wheel and its arm that the pivot does not carry, N.
pub(super) fn own_n(machine: &Machine, parts: &Parts, wheel: Wheel) -> f64 {
    let arm_kg = parts.arms[wheel].body.mass_kg * machine.vehicle.arm_com_share;
    (parts.wheel.mass_kg + arm_kg) * GRAVITY_M_S2
}

/// What a wheel of its own weight `own_n` presses with at rest where its cylinder carries `load_n`, N.
pub(super) fn normal_n(own_n: f64, load_n: f64, pose: &ArmPose) -> f64 {
    (own_n + load_n * pose.lever_m / pose.reach_m).max(0.0)
}

/// The same of all six, of their own weights, the loads of their cylinders and how their arms stand.
pub(super) fn normals_n(
    own_n: &PerWheel<f64>,
    load_n: impl Fn(Wheel) -> f64,
    pose: &PerWheel<ArmPose>,
) -> PerWheel<f64> {
    PerWheel::from_fn(|w| normal_n(own_n[w], load_n(w), &pose[w]))
}

/// The same of both wheels of each axle together, front to rear, N.
pub(super) fn axles_n(
    own_n: &PerWheel<f64>,
    load_n: &PerWheel<f64>,
    pose: &PerWheel<ArmPose>,
) -> [f64; 3] {
    let mut axles_n = [0.0; 3];
    for (w, normal_n) in normals_n(own_n, |w| load_n[w], pose).iter() {
        axles_n[w.axle() as usize] += normal_n;
    }
    axles_n
}

/// Radius that a wheel pressed by `normal_n` rolls on, m: less than the machine file's by what its tyre gives way
/// beyond a near rigid one, whether the file or an effect makes it soft.
pub(super) fn rolling_radius_m(parts: &Parts, wheel: Wheel, normal_n: f64) -> f64 {
    let sag_m = |stiffness_n_m: f64| normal_n / stiffness_n_m;
    let near_rigid_n_m = SoftTyre::default().stiffness_n_m;
    parts.radius_m
        - RADIUS_SHARE * (sag_m(parts.tyres[wheel].stiffness_n_m) - sag_m(near_rigid_n_m))
}

#[cfg(test)]
mod tests {
    use xt28_sim::Effects;

    use super::*;

    #[test]
    fn a_soft_tyre_rolls_on_a_smaller_radius_the_harder_it_is_pressed() {
        let machine = Machine::xt28();
        let mut soft = Effects::default();
        soft.wheels[Wheel::Mr].soft_tyre.stiffness_n_m = 3.0e5;
        let parts = Parts::new(&machine, &soft);
        let radius_m = |wheel, normal_n| rolling_radius_m(&parts, wheel, normal_n);
        assert!((radius_m(Wheel::Mr, 30.0e3) - (machine.wheels.radius_m - 0.045)).abs() < 2.0e-3);
        assert!((radius_m(Wheel::Mr, 0.0) - machine.wheels.radius_m).abs() < 1e-12);
        assert!((radius_m(Wheel::Ml, 30.0e3) - machine.wheels.radius_m).abs() < 1e-12);
    }

    #[test]
    fn a_tyre_is_as_soft_by_the_machine_file_as_by_an_effect() {
        let mut soft = Effects::default();
        soft.wheels[Wheel::Mr].soft_tyre.stiffness_n_m = 3.0e5;
        let by_effect = Parts::new(&Machine::xt28(), &soft);
        let mut machine = Machine::xt28();
        machine.vehicle.tyre_stiffness_n_m = 3.0e5;
        let by_file = Parts::new(&machine, &Effects::default());
        let [effect_m, file_m] =
            [&by_effect, &by_file].map(|parts| rolling_radius_m(parts, Wheel::Mr, 30.0e3));
        assert!((effect_m - file_m).abs() < 1e-12, "{effect_m} {file_m}");
    }
}
