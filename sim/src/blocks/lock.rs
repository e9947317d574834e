//! The closed oil of a cylinder as a spring: the linear lock, or the gas of its accumulator.

use xt28_machine::Machine;

use super::Accumulator;
use super::accumulator::OIL_STIFFNESS_N_M;
use super::curve::{Curve, Knot};
use crate::effects::ArmEffects;

/// Places at which the gas is worked out. It comes closer by 3 to 6 % from one to the next, so that between them
/// its force is right to 1e-10 or, at the ends of the catalogue's ranges, 1e-8.
const KNOTS: usize = 64;

/// Force of the oil against compression: how much further the valve has filled the cylinder than it
/// is long.
#[derive(Clone, Debug, PartialEq)]
pub struct Lock {
    stiffness_n_m: f64,
    gas: Option<Gas>,
    reach_m: [f64; 2],
}

/// The gas beside the lock.
#[derive(Clone, Debug, PartialEq)]
struct Gas {
    /// Slope of the force until the accumulator begins to fill, N/m, and the compression and force there, m and N.
    empty_n_m: f64,
    filling_m: f64,
    filling_n: f64,
    /// Force over compression from there on. It can only be solved for either, and is asked for both at every step.
    pressed: Curve,
    /// Compressions at which the slope of the force changes at once, m, and by how much, N/m.
    knees: [[f64; 2]; 2],
}

impl Lock {
    /// The lock of one cylinder. Nominal: linear (paper 3.2).
    #[must_use]
    pub fn new(machine: &Machine, effects: &ArmEffects) -> Self {
        let gas = &effects.gas;
        let stiffness_n_m = machine.hydraulics.lock_stiffness_n_m * effects.lock_stiffness.factor;
        let reach_m = machine.arms.force_max_n / stiffness_n_m;
        let mut lock = Self { stiffness_n_m, gas: None, reach_m: [-reach_m, reach_m] };
        if gas.share != 0.0 {
            let accumulator = Accumulator::new(machine, gas);
            lock.gas = Some(Gas::new(&accumulator, gas.share, stiffness_n_m));
            lock.reach_m[1] = lock.compression_m(machine.arms.force_max_n);
        }
        lock
    }

    /// Force, N, and its slope, N/m, at `compression_m`.
    #[must_use]
    pub fn spring(&self, compression_m: f64) -> [f64; 2] {
        let force_n = self.stiffness_n_m * compression_m;
        match &self.gas {
            // A hanging arm draws on the rod side, where no gas is.
            Some(gas) if compression_m > 0.0 => gas.spring(compression_m),
            _ => [force_n, self.stiffness_n_m],
        }
    }

    /// The same with the slope that the force has on the whole while the compression goes on by `travel_m`:
    /// a step that passes a knee of the law feels either side of it by how far it goes there. So what the
    /// step makes of it does not jump as the knee comes within its reach or leaves it.
    #[must_use]
    pub fn spring_along(&self, compression_m: f64, travel_m: f64) -> [f64; 2] {
        let [force_n, slope_n_m] = self.spring(compression_m);
        let end_m = compression_m + travel_m;
        let bend_n_m = |[at_m, by_n_m]: [f64; 2]| {
            let is_passed = (compression_m > at_m) != (end_m > at_m);
            if is_passed { by_n_m * (end_m - at_m) / travel_m.abs() } else { 0.0 }
        };
        let knees = self.gas.iter().flat_map(|gas| gas.knees);
        [force_n, knees.fold(slope_n_m, |slope_n_m, knee| slope_n_m + bend_n_m(knee))]
    }

    /// Compression that makes `force_n`, m; the relief valve is not asked.
    #[must_use]
    pub fn compression_m(&self, force_n: f64) -> f64 {
        match &self.gas {
            Some(gas) if force_n > 0.0 => gas.compression_m(force_n),
            _ => force_n / self.stiffness_n_m,
        }
    }

    /// Compressions at which the relief valve opens, drawn and pushed, m.
    #[must_use]
    pub const fn reach_m(&self) -> [f64; 2] {
        self.reach_m
    }
}

impl Gas {
    /// An accumulator that makes `share` of the force of a cylinder whose lock makes the rest.
    fn new(accumulator: &Accumulator, share: f64, lock_n_m: f64) -> Self {
        let beside_n_m = (1.0 - share) * lock_n_m;
        let knots = accumulator.pressed::<KNOTS>().map(|pressed| Knot {
            x: pressed.compression_m,
            y: share * pressed.force_n + beside_n_m * pressed.compression_m,
            slope: share * pressed.slope_n_m + beside_n_m,
            bend: share * pressed.bend_n_m2,
        });
        let empty_n_m = share * OIL_STIFFNESS_N_M + beside_n_m;
        let [Knot { x: filling_m, y: filling_n, slope, .. }, ..] = knots;
        let knees = [[0.0, empty_n_m - lock_n_m], [filling_m, slope - empty_n_m]];
        Self { empty_n_m, filling_m, filling_n, pressed: Curve::new(&knots), knees }
    }

    /// Force, N, and its slope, N/m, of a cylinder that is pressed by `compression_m`.
    fn spring(&self, compression_m: f64) -> [f64; 2] {
        if compression_m <= self.filling_m {
            return [self.empty_n_m * compression_m, self.empty_n_m];
        }
        self.pressed.at(compression_m)
    }

    /// Compression that makes `force_n`, which presses, m.
    fn compression_m(&self, force_n: f64) -> f64 {
        if force_n <= self.filling_n {
            return force_n / self.empty_n_m;
        }
        self.pressed.reaches(force_n)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::effects::{AccumulatorGas, LockStiffness};

    fn with_share(share: f64) -> Lock {
        let gas = AccumulatorGas { share, ..AccumulatorGas::default() };
        Lock::new(&Machine::xt28(), &ArmEffects { gas, ..ArmEffects::default() })
    }

    #[test]
    fn the_reach_ends_at_the_relief_force_and_compression_inverts_force() {
        for share in [0.0, 0.3, 1.0] {
            let lock = with_share(share);
            let [drawn_n, pushed_n] = lock.reach_m().map(|x| lock.spring(x)[0]);
            assert!((drawn_n + 270e3).abs() < 1e-3 && (pushed_n - 270e3).abs() < 1e-3);
            for force_n in [-300e3, -14e3, 0.0, 5e3, 17e3, 55e3, 120e3, 300e3] {
                let [made_n, _] = lock.spring(lock.compression_m(force_n));
                assert!((made_n - force_n).abs() < 1e-3, "{share}: {made_n}");
            }
        }
    }

    proptest! {
        /// Over the ranges of the catalogue, from an empty accumulator to beyond the relief valve, and with return
        /// pressures that never leave it empty.
        #[test]
        fn compression_inverts_force_whatever_the_gas(
            share in 0.0..=1.0,
            precharge_pa in 0.5e6..15.0e6,
            volume_m3 in 0.1e-3..5.0e-3,
            exponent in 1.0..1.8,
            return_pressure_pa in 0.0..6.0e6,
            force_n in -300e3..300e3,
        ) {
            let gas = AccumulatorGas { share, precharge_pa, volume_m3, exponent };
            let mut machine = Machine::xt28();
            machine.hydraulics.return_pressure_pa = return_pressure_pa;
            let lock = Lock::new(&machine, &ArmEffects { gas, ..ArmEffects::default() });
            let [made_n, slope_n_m] = lock.spring(lock.compression_m(force_n));
            prop_assert!((made_n - force_n).abs() < 1e-3, "{made_n}");
            prop_assert!(slope_n_m > 0.0);
        }

        /// Between the places at which the gas is worked out as well.
        #[test]
        fn force_and_slope_are_those_of_gas_and_lock_side_by_side(
            share in 0.01..=1.0,
            precharge_pa in 0.5e6..15.0e6,
            volume_m3 in 0.1e-3..5.0e-3,
            exponent in 1.0..1.8,
        ) {
            let gas = AccumulatorGas { share, precharge_pa, volume_m3, exponent };
            let machine = Machine::xt28();
            let lock = Lock::new(&machine, &ArmEffects { gas, ..ArmEffects::default() });
            let beside_n_m = (1.0 - share) * machine.hydraulics.lock_stiffness_n_m;
            for pressed in Accumulator::new(&machine, &gas).pressed::<1001>().into_iter().skip(1) {
                let [force_n, slope_n_m] = lock.spring(pressed.compression_m);
                let want_n = share * pressed.force_n + beside_n_m * pressed.compression_m;
                let want_n_m = share * pressed.slope_n_m + beside_n_m;
                prop_assert!((force_n - want_n).abs() < 1e-3, "{pressed:?}: {force_n}");
                prop_assert!((slope_n_m / want_n_m - 1.0).abs() < 1e-6, "{pressed:?}: {slope_n_m}");
            }
        }
    }

    /// k = n (p + 1 atm) A² / V beside the oil's: a heavy arm's gas is stiffer by the pressure ratio to
    /// 1 + 1/n.
    #[test]
    fn gas_is_stiffer_under_heavier_loads_by_the_polytropic_law() {
        let lock = with_share(1.0);
        let both = |force_n: f64| lock.spring(lock.compression_m(force_n))[1];
        let at = |force_n: f64| (1.0 / both(force_n) - 1.0 / OIL_STIFFNESS_N_M).recip();
        let absolute = |force_n: f64| (force_n + 5e5 * 0.00589) / 0.00785 + 1.013e5;
        let ratio = (absolute(83e3) / absolute(31e3)).powf(1.0 + 1.0 / 1.3);
        assert!((at(83e3) / at(31e3) / ratio - 1.0).abs() < 1e-8);
    }

    #[test]
    fn a_hanging_arm_draws_on_the_linear_lock() {
        let (linear, gas) = (with_share(0.0), with_share(1.0));
        for compression_m in [-1e-2, -1e-6, 0.0] {
            assert_eq!(gas.spring(compression_m), linear.spring(compression_m));
        }
        assert!(gas.spring(1e-6)[1] > 2.0 * linear.spring(1e-6)[1]);
    }

    #[test]
    fn the_assumed_gas_is_as_stiff_as_the_lock_under_a_sixth_of_the_weight() {
        let (linear, gas) = (with_share(0.0), with_share(1.0));
        let [_, lock_n_m] = linear.spring(linear.compression_m(55e3));
        let [_, gas_n_m] = gas.spring(gas.compression_m(55e3));
        assert!((gas_n_m / lock_n_m - 1.0).abs() < 0.1, "{gas_n_m}");
    }

    /// Over a travel through both knees the slope is the secant's but for the gas' own curvature, and it goes
    /// over into the slope on either side.
    #[test]
    fn a_step_through_the_knees_feels_either_side_by_its_share() {
        let lock = with_share(0.4);
        for (from_m, to_m) in [(-2e-4, 7e-4), (7e-4, -2e-4), (-1e-4, 1e-4), (2e-4, 5e-4)] {
            let [force_n, slope_n_m] = lock.spring_along(from_m, to_m - from_m);
            let secant_n_m = (lock.spring(to_m)[0] - force_n) / (to_m - from_m);
            assert!((slope_n_m / secant_n_m - 1.0).abs() < 0.02, "{slope_n_m}, not {secant_n_m}");
        }
        for knee_m in [0.0, lock.gas.as_ref().unwrap().knees[1][0]] {
            for travel_m in [-1e-4, 1e-4] {
                let near = [-1e-12, 1e-12, 1e-12 - travel_m, -1e-12 - travel_m];
                let [before, after, ahead, clear] =
                    near.map(|by_m| lock.spring_along(knee_m + by_m, travel_m)[1]);
                for (one, other) in [(before, after), (ahead, clear)] {
                    assert!((one / other - 1.0).abs() < 1e-6, "{knee_m}: {one}, {other}");
                }
            }
        }
    }

    #[test]
    fn a_vanishing_share_is_the_linear_lock() {
        let (nominal, little) = (with_share(0.0), with_share(1e-9));
        let (a, b) = (nominal.spring(0.03)[0], little.spring(0.03)[0]);
        assert!((a - b).abs() < 1e-3, "{a} {b}");
    }

    #[test]
    fn a_stiffer_lock_gives_way_less() {
        let lock_stiffness = LockStiffness { factor: 1.05 };
        let stiff =
            Lock::new(&Machine::xt28(), &ArmEffects { lock_stiffness, ..ArmEffects::default() });
        let ratio = with_share(0.0).compression_m(55e3) / stiff.compression_m(55e3);
        assert!((ratio - 1.05).abs() < 1e-12);
    }
}
