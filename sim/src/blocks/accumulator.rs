//! An accumulator on the bore side of a cylinder: gas that the closed oil pushes against.

use xt28_machine::Machine;

use crate::effects::AccumulatorGas;

/// Stiffness of the oil without gas, N/m (assumed: some 1 GPa of oil modulus on a quarter of a metre of
/// the bore).
pub(super) const OIL_STIFFNESS_N_M: f64 = 3.0e7;
/// Share of its length by which a step of Newton's rule moves the end of the gas at most where that is then known to
/// rounding, as a step leaves about the square of the one before; and steps after which it is at the latest.
const SOLVED: f64 = 1.0e-8;
const STEPS: usize = 64;
/// Least share of its length from which it is sought.
const LEAST_LEFT: f64 = 1.0e-3;
/// Share of its length by which the gas is led on by a series of few terms.
const SHORT: f64 = 0.02;
/// One over the number of each of its terms: of that share, and exponents up to 2, more are below rounding.
const SERIES: [f64; 10] = {
    let mut inverse = [0.0; 10];
    let mut k = 0;
    while k < inverse.len() {
        inverse[k] = 1.0 / (k as f64 + 1.0);
        k += 1;
    }
    inverse
};
/// Pressure of the atmosphere, Pa: gas laws take absolute pressures.
const ATMOSPHERE_PA: f64 = 1.013e5;

/// Force against compression of a cylinder with its accumulator.
///
/// Up to the precharge the accumulator is empty and the oil alone gives way; beyond it the gas gives way
/// as well, by p V^n = constant, and the force rises ever more steeply. Under a return pressure that alone presses
/// harder than the precharge it is never empty: the same gas is then shorter and stiffer from the beginning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accumulator {
    /// Compression at which oil begins to come in, m, from 0 on.
    filling_m: f64,
    /// Length of the gas there if it stood on the bore area, m.
    gas_m: f64,
    /// Its absolute pressure there on the bore area, N: the precharge, or the return's where that is more.
    precharge_n: f64,
    /// What atmosphere and return pressure hold against it, N.
    back_n: f64,
    exponent: f64,
    /// Compression beyond which the law goes on straight, m: at the relief valve's force.
    top_m: f64,
}

impl Accumulator {
    /// The accumulator of one cylinder of this machine.
    #[must_use]
    pub fn new(machine: &Machine, gas: &AccumulatorGas) -> Self {
        let a = &machine.arms;
        let back_n =
            ATMOSPHERE_PA * a.area_bore_m2 + machine.hydraulics.return_pressure_pa * a.area_rod_m2;
        let empty_n = (gas.precharge_pa + ATMOSPHERE_PA) * a.area_bore_m2;
        // A return pressure that presses harder has let oil in already: the gas begins shorter, at that pressure.
        let precharge_n = empty_n.max(back_n);
        let filling_m = (precharge_n - back_n) / OIL_STIFFNESS_N_M;
        let filled = (empty_n / precharge_n).powf(gas.exponent.recip());
        let gas_m = gas.volume_m3 / a.area_bore_m2 * filled;
        let left = (precharge_n / (a.force_max_n + back_n)).powf(1.0 / gas.exponent);
        let top_m = filling_m.max(a.force_max_n / OIL_STIFFNESS_N_M + gas_m * (1.0 - left));
        Self { filling_m, gas_m, precharge_n, back_n, exponent: gas.exponent, top_m }
    }

    /// Force, N, and its slope, N/m, at `compression_m`: how much further the valve has filled the
    /// cylinder than it is long.
    #[must_use]
    pub fn spring(&self, compression_m: f64) -> [f64; 2] {
        if compression_m <= self.filling_m {
            return [OIL_STIFFNESS_N_M * compression_m, OIL_STIFFNESS_N_M];
        }
        let beyond_m = (compression_m - self.top_m).max(0.0);
        let [gas_n, gas_n_m] = self.gas(compression_m - beyond_m);
        let slope_n_m = gas_n_m * OIL_STIFFNESS_N_M / (gas_n_m + OIL_STIFFNESS_N_M);
        [gas_n - self.back_n + slope_n_m * beyond_m, slope_n_m]
    }

    /// Compression at which oil begins to come in, m, and by how much the slope changes there, N/m: from the
    /// oil's alone to that of oil and gas behind one another.
    #[must_use]
    pub(super) fn knee(&self) -> [f64; 2] {
        let gas_n_m = self.exponent * self.precharge_n / self.gas_m;
        let both_n_m = gas_n_m * OIL_STIFFNESS_N_M / (gas_n_m + OIL_STIFFNESS_N_M);
        [self.filling_m, both_n_m - OIL_STIFFNESS_N_M]
    }

    /// What the gas bears, N, and its own slope, N/m, while it and the oil give way by `compression_m`.
    ///
    /// By Newton's rule from where the gas would be without the oil: the misfit is convex in the length
    /// of the gas and that start too short, so every step goes towards the root and none beyond.
    fn gas(&self, compression_m: f64) -> [f64; 2] {
        let slope_n_m = |gas_n: f64, left: f64| self.exponent * gas_n / (left * self.gas_m);
        let mut left = (1.0 - (compression_m - self.filling_m) / self.gas_m).max(LEAST_LEFT);
        let mut gas_n = self.precharge_n * left.powf(-self.exponent);
        for _ in 0..STEPS {
            let gas_n_m = slope_n_m(gas_n, left);
            let oil_m = (gas_n - self.back_n) / OIL_STIFFNESS_N_M;
            let misfit_m = oil_m + self.gas_m * (1.0 - left) - compression_m;
            let by = misfit_m / (self.gas_m * (1.0 + gas_n_m / OIL_STIFFNESS_N_M));
            gas_n *= self.bears_more(by / left);
            left += by;
            if by.abs() < SOLVED {
                break;
            }
        }
        [gas_n, slope_n_m(gas_n, left)]
    }

    /// How many times what it bears the gas bears once it is longer by `share` of its length: (1 + share)^-n, by its
    /// series where that is short. Newton's steps are, and a power is most of what they cost.
    fn bears_more(&self, share: f64) -> f64 {
        if share.abs() > SHORT {
            return (1.0 + share).powf(-self.exponent);
        }
        let (mut sum, mut term) = (1.0, 1.0);
        for (k, inverse) in (0_u32..).zip(SERIES) {
            term *= share * (-self.exponent - f64::from(k)) * inverse;
            sum += term;
            if f64::abs(term) < f64::EPSILON / 4.0 {
                break;
            }
        }
        sum
    }

    /// Compression at which `share` of this force and a linear spring of `beside_n_m` make `force_n`,
    /// which is positive, m.
    ///
    /// By Newton's rule in the length of the gas, of which force and compression are explicit: the force
    /// is convex in it, so that from the second step on every step goes towards the root.
    #[must_use]
    pub(super) fn compression_m(&self, share: f64, beside_n_m: f64, force_n: f64) -> f64 {
        let oil_n_m = share * OIL_STIFFNESS_N_M + beside_n_m;
        if force_n <= oil_n_m * self.filling_m {
            return force_n / oil_n_m;
        }
        let mut left = (self.precharge_n / (force_n + self.back_n)).powf(self.exponent.recip());
        // By the choice of that length.
        let mut gas_n = force_n + self.back_n;
        let gives_m = |gas_n: f64, left: f64| {
            (gas_n - self.back_n) / OIL_STIFFNESS_N_M + self.gas_m * (1.0 - left)
        };
        for _ in 0..STEPS {
            let gas_n_by_left = -self.exponent * gas_n / left;
            let compression_m = gives_m(gas_n, left);
            let by_left = gas_n_by_left / OIL_STIFFNESS_N_M - self.gas_m;
            let misfit_n = share * (gas_n - self.back_n) + beside_n_m * compression_m - force_n;
            let next = left - misfit_n / (share * gas_n_by_left + beside_n_m * by_left);
            let by = next.max(LEAST_LEFT) - left;
            gas_n *= self.bears_more(by / left);
            left += by;
            if by.abs() < SOLVED {
                break;
            }
        }
        let compression_m = gives_m(gas_n, left);
        if compression_m <= self.top_m {
            return compression_m;
        }
        let [top_n, top_n_m] = self.spring(self.top_m);
        let short_n = force_n - share * top_n - beside_n_m * self.top_m;
        self.top_m + short_n / (share * top_n_m + beside_n_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn accumulator() -> (Machine, AccumulatorGas, Accumulator) {
        let (machine, gas) = (Machine::xt28(), AccumulatorGas::default());
        (machine.clone(), gas, Accumulator::new(&machine, &gas))
    }

    #[test]
    fn pressure_times_volume_to_the_exponent_is_constant() {
        let (machine, gas, accumulator) = accumulator();
        let area_m2 = machine.arms.area_bore_m2;
        let constant = |compression_m: f64| {
            let [force_n, _] = accumulator.spring(compression_m);
            let back_n = machine.hydraulics.return_pressure_pa * machine.arms.area_rod_m2;
            let pressure_pa = (force_n + back_n) / area_m2 + ATMOSPHERE_PA;
            let oil_m3 = (compression_m - force_n / OIL_STIFFNESS_N_M) * area_m2;
            pressure_pa * (gas.volume_m3 - oil_m3).powf(gas.exponent)
        };
        let precharged = (gas.precharge_pa + ATMOSPHERE_PA) * gas.volume_m3.powf(gas.exponent);
        for compression_m in [0.003, 0.01, 0.03, 0.06, 0.08] {
            assert!(compression_m < accumulator.top_m);
            assert!((constant(compression_m) / precharged - 1.0).abs() < 1e-9, "{compression_m}");
        }
    }

    #[test]
    fn force_is_continuous_and_the_slope_is_its_derivative() {
        let (_, _, accumulator) = accumulator();
        for knee_m in [accumulator.filling_m, accumulator.top_m] {
            let [below, above] = [-1e-12, 1e-12].map(|d| accumulator.spring(knee_m + d)[0]);
            assert!((above - below).abs() < 1e-3, "{knee_m}: {below} {above}");
        }
        for compression_m in [-0.01, 0.001, 0.02, 0.08, 0.09] {
            let d = 1e-7;
            let [below, above] = [-d, d].map(|d| accumulator.spring(compression_m + d)[0]);
            let slope_n_m = (above - below) / (2.0 * d);
            let [_, said_n_m] = accumulator.spring(compression_m);
            assert!((slope_n_m / said_n_m - 1.0).abs() < 1e-4, "{compression_m}: {slope_n_m}");
        }
    }

    /// A return pressure above the precharge has let oil in before anything pushes.
    #[test]
    fn force_begins_at_nothing_whatever_the_return_pressure() {
        for return_pressure_pa in [0.0, 0.5e6, 1.9e6, 2.1e6, 3.0e6, 20.0e6] {
            let mut machine = Machine::xt28();
            machine.hydraulics.return_pressure_pa = return_pressure_pa;
            let gas = AccumulatorGas::default();
            let accumulator = Accumulator::new(&machine, &gas);
            let [begins_n, _] = accumulator.spring(1e-12);
            assert!(begins_n.abs() < 1e-3, "{return_pressure_pa} Pa: {begins_n} N");
            assert!(accumulator.filling_m >= 0.0, "{return_pressure_pa} Pa");
            // The gas itself is the same, so that all of it is where it would be at any other return pressure.
            let back_n = return_pressure_pa * machine.arms.area_rod_m2;
            for compression_m in [0.01, 0.02] {
                let [force_n, _] = accumulator.spring(compression_m);
                let pressure_pa = (force_n + back_n) / machine.arms.area_bore_m2 + ATMOSPHERE_PA;
                let begun_pa = back_n / machine.arms.area_bore_m2 + ATMOSPHERE_PA;
                let volume_m3 = |pressure_pa: f64| {
                    let precharge_pa = gas.precharge_pa + ATMOSPHERE_PA;
                    gas.volume_m3
                        * (precharge_pa / pressure_pa.max(precharge_pa)).powf(1.0 / gas.exponent)
                };
                let oil_m3 = volume_m3(begun_pa) - volume_m3(pressure_pa);
                let made_m = force_n / OIL_STIFFNESS_N_M + oil_m3 / machine.arms.area_bore_m2;
                assert!(
                    (made_m / compression_m - 1.0).abs() < 1e-9,
                    "{return_pressure_pa} Pa: {made_m}"
                );
            }
        }
    }

    #[test]
    fn what_the_gas_bears_more_is_its_power_near_and_far() {
        let (_, gas, accumulator) = accumulator();
        for share in [0.0, 1e-12, -1e-7, 3e-4, -0.0199, 0.0199, 0.0201, -0.6, 4.0] {
            let want = (1.0_f64 + share).powf(-gas.exponent);
            let made = accumulator.bears_more(share);
            assert!((made / want - 1.0).abs() < 1e-15, "{share}: {made}, not {want}");
        }
    }
}
