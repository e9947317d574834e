//! An accumulator on the bore side of a cylinder: gas that the closed oil pushes against.

use xt28_machine::Machine;

use crate::effects::AccumulatorGas;

/// Stiffness of the oil without gas, N/m (assumed: column, hoses and eyes, some 1 GPa of oil modulus
/// on the mean chamber).
const OIL_STIFFNESS_N_M: f64 = 1.0e7;
/// Pressure of the atmosphere, Pa: gas laws take absolute pressures.
const ATMOSPHERE_PA: f64 = 1.013e5;

/// Force against compression of a cylinder with its accumulator.
///
/// Up to the precharge the accumulator is empty and the oil alone gives way; beyond it the gas
/// follows p V^n = constant, and its force rises ever more steeply.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accumulator {
    /// Compression at which oil begins to come in, m.
    filling_m: f64,
    /// Length of the gas if it stood on the bore area, m.
    gas_m: f64,
    /// Absolute precharge on the bore area, N.
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
        let precharge_n = (gas.precharge_pa + ATMOSPHERE_PA) * a.area_bore_m2;
        let filling_m = (precharge_n - back_n) / OIL_STIFFNESS_N_M;
        let gas_m = gas.volume_m3 / a.area_bore_m2;
        let left = (precharge_n / (a.force_max_n + back_n)).powf(1.0 / gas.exponent);
        let top_m = filling_m + gas_m * (1.0 - left).max(0.0);
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
        let left = 1.0 - (compression_m - beyond_m - self.filling_m) / self.gas_m;
        let gas_n = self.precharge_n * left.powf(-self.exponent);
        let slope_n_m = self.exponent * gas_n / (left * self.gas_m);
        [gas_n - self.back_n + slope_n_m * beyond_m, slope_n_m]
    }

    /// Compression at which the force is the relief valve's, m.
    #[must_use]
    pub const fn top_m(&self) -> f64 {
        self.top_m
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
            let oil_m3 = (compression_m - accumulator.filling_m) * area_m2;
            pressure_pa * (gas.volume_m3 - oil_m3).powf(gas.exponent)
        };
        let precharged = (gas.precharge_pa + ATMOSPHERE_PA) * gas.volume_m3.powf(gas.exponent);
        for compression_m in [0.003, 0.01, 0.03, 0.06, 0.08] {
            assert!(compression_m < accumulator.top_m());
            assert!((constant(compression_m) / precharged - 1.0).abs() < 1e-9, "{compression_m}");
        }
    }

    #[test]
    fn force_is_continuous_and_the_slope_is_its_derivative() {
        let (_, _, accumulator) = accumulator();
        for knee_m in [accumulator.filling_m, accumulator.top_m()] {
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
}
