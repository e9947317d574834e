//! What stores oil under pressure beside a cylinder: a spring or nitrogen, and the oil itself.

use crate::truth::Gas;

/// Bulk modulus of oil with a little air in it, Pa (assumed).
const BULK_PA: f64 = 1.4e9;
/// Oil in hoses and ports of a chamber when the rod is at its end, m³ (assumed).
const DEAD_M3: f64 = 1.0e-3;
/// Oil that an accumulator's neck takes while the gas still presses the bladder shut, m³/Pa.
const NECK_M3_PA: f64 = 2.0e-13;
/// Pressures are counted from the atmosphere's, gas laws are not, Pa.
const ATMOSPHERE_PA: f64 = 1.0e5;

/// An accumulator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Reservoir {
    /// A piston on a spring: as much oil for every pascal.
    Spring { compliance_m3_pa: f64 },
    /// Nitrogen that is compressed along a polytrope.
    Gas(Gas),
}

impl Reservoir {
    /// Oil taken in per pressure, m³/Pa, at `pressure_pa` above the atmosphere.
    pub(crate) fn compliance_m3_pa(&self, pressure_pa: f64) -> f64 {
        match self {
            Self::Spring { compliance_m3_pa } => *compliance_m3_pa,
            Self::Gas(gas) => {
                let [p, p0] = [pressure_pa, gas.precharge_pa].map(|p| p + ATMOSPHERE_PA);
                if p <= p0 {
                    return NECK_M3_PA;
                }
                // V = V0 (p0 / p)^(1/n), so -dV/dp = V / (n p).
                gas.volume_m3 * (p0 / p).powf(1.0 / gas.exponent) / (gas.exponent * p)
            }
        }
    }
}

/// Compliance of the oil in a chamber of `volume_m3` beside hoses and ports, m³/Pa.
pub(crate) fn oil_compliance_m3_pa(volume_m3: f64) -> f64 {
    (DEAD_M3 + volume_m3.max(0.0)) / BULK_PA
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compliance_is_the_slope_of_the_polytrope() {
        let gas = Gas { precharge_pa: 1.5e6, volume_m3: 1e-3, exponent: 1.3 };
        let volume = |p: f64| 1e-3 * (1.6e6 / (p + 1e5)).powf(1.0 / 1.3);
        let p = 7.0e6;
        let slope = (volume(p - 1.0) - volume(p + 1.0)) / 2.0;
        let compliance = Reservoir::Gas(gas).compliance_m3_pa(p);
        assert!((compliance / slope - 1.0).abs() < 1e-6, "{compliance} {slope}");
    }

    #[test]
    fn below_precharge_the_gas_takes_no_oil() {
        let gas = Gas { precharge_pa: 5.0e6, volume_m3: 1e-3, exponent: 1.3 };
        assert!(Reservoir::Gas(gas).compliance_m3_pa(4.9e6) < 1e-12);
        assert!(Reservoir::Gas(gas).compliance_m3_pa(5.1e6) > 1e-10);
    }
}
