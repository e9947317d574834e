//! An accumulator on the bore side of a cylinder: gas that the closed oil pushes against.

use xt28_machine::Machine;

use crate::effects::AccumulatorGas;

/// Stiffness of the oil without gas, N/m (assumed: some 1 GPa of oil modulus on a quarter of a metre of
/// the bore).
pub(super) const OIL_STIFFNESS_N_M: f64 = 3.0e7;
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
    /// Share of its length that is left of it at the relief valve's force, up to which the law is made.
    least: f64,
}

/// What an accumulator does where its gas has some length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pressed {
    /// How much further the valve has filled the cylinder than it is long, m.
    pub compression_m: f64,
    /// Force, N.
    pub force_n: f64,
    /// Slope of the force over the compression, N/m.
    pub slope_n_m: f64,
    /// Slope of that, N/m².
    pub bend_n_m2: f64,
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
        let least = (precharge_n / (a.force_max_n + back_n)).powf(gas.exponent.recip()).min(1.0);
        Self { filling_m, gas_m, precharge_n, back_n, exponent: gas.exponent, least }
    }

    /// Lengths of the gas that come closer in the same proportion from one to the next, from empty to pressed by the
    /// relief valve's force, and what it does at each.
    #[must_use]
    pub fn pressed<const KNOTS: usize>(&self) -> [Pressed; KNOTS] {
        let shorter = self.least.powf(((KNOTS - 1) as f64).recip());
        let heavier = shorter.powf(-self.exponent);
        let (mut left, mut gas_n) = (1.0, self.precharge_n);
        core::array::from_fn(|_| {
            let pressed = self.at(left, gas_n);
            left *= shorter;
            gas_n *= heavier;
            pressed
        })
    }

    /// What it does where `left` of its gas' length is left, which then bears `gas_n`. Force and compression are
    /// explicit in those alone.
    fn at(&self, left: f64, gas_n: f64) -> Pressed {
        let force_n = gas_n - self.back_n;
        // Gas and oil behind one another give way each by its own slope.
        let gas_n_m = self.exponent * gas_n / (left * self.gas_m);
        let oil_share = OIL_STIFFNESS_N_M / (gas_n_m + OIL_STIFFNESS_N_M);
        let gas_bend_n_m2 = (self.exponent + 1.0) * gas_n_m / (left * self.gas_m);
        Pressed {
            compression_m: force_n / OIL_STIFFNESS_N_M + self.gas_m * (1.0 - left),
            force_n,
            slope_n_m: gas_n_m * oil_share,
            bend_n_m2: gas_bend_n_m2 * oil_share.powi(3),
        }
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
        let constant = |Pressed { compression_m, force_n, .. }: Pressed| {
            let back_n = machine.hydraulics.return_pressure_pa * machine.arms.area_rod_m2;
            let pressure_pa = (force_n + back_n) / area_m2 + ATMOSPHERE_PA;
            let oil_m3 = (compression_m - force_n / OIL_STIFFNESS_N_M) * area_m2;
            pressure_pa * (gas.volume_m3 - oil_m3).powf(gas.exponent)
        };
        let precharged = (gas.precharge_pa + ATMOSPHERE_PA) * gas.volume_m3.powf(gas.exponent);
        let all = accumulator.pressed::<9>();
        for pressed in all {
            assert!((constant(pressed) / precharged - 1.0).abs() < 1e-12, "{pressed:?}");
        }
        assert!((all[8].force_n / machine.arms.force_max_n - 1.0).abs() < 1e-12);
    }

    #[test]
    fn slope_and_bend_are_the_derivatives_of_force_and_slope() {
        let (_, _, accumulator) = accumulator();
        for window in accumulator.pressed::<6001>().windows(3) {
            let [before, at, after] = window else { unreachable!() };
            let over = |of: fn(&Pressed) -> f64| {
                (of(after) - of(before)) / (after.compression_m - before.compression_m)
            };
            assert!((over(|p| p.force_n) / at.slope_n_m - 1.0).abs() < 1e-3, "{at:?}");
            assert!((over(|p| p.slope_n_m) / at.bend_n_m2 - 1.0).abs() < 1e-3, "{at:?}");
        }
    }

    /// A return pressure above the precharge has let oil in before anything pushes.
    #[test]
    fn force_begins_at_nothing_whatever_the_return_pressure() {
        for return_pressure_pa in [0.0, 0.5e6, 1.9e6, 2.1e6, 3.0e6, 20.0e6] {
            let mut machine = Machine::xt28();
            machine.hydraulics.return_pressure_pa = return_pressure_pa;
            let gas = AccumulatorGas::default();
            let [begins, pressed @ ..] = Accumulator::new(&machine, &gas).pressed::<9>();
            // Up to there the oil alone gives way.
            let made_n = OIL_STIFFNESS_N_M * begins.compression_m;
            assert!(begins.compression_m >= 0.0, "{return_pressure_pa} Pa: {begins:?}");
            assert!((made_n - begins.force_n).abs() < 1e-3, "{return_pressure_pa} Pa: {begins:?}");
            // The gas itself is the same, so that all of it is where it would be at any other return pressure.
            let back_n = return_pressure_pa * machine.arms.area_rod_m2;
            for Pressed { compression_m, force_n, .. } in pressed {
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
}
