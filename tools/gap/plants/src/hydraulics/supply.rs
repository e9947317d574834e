//! The load-sensing pump of arms and steering: a margin over the highest load that it holds if it can.

use crate::truth::SupplyTruth;

/// Oil between pump and valves under the whole margin, m³ (assumed): it drains when too much is drawn.
const BUFFER_M3: f64 = 4.0e-5;
/// Steps of the margin within a step of the machine: the buffer is small.
const SUBSTEPS: u32 = 4;

/// The margin, share of what is set: 1 while the pump keeps up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Supply {
    margin: f64,
    phase_rad: f64,
}

impl Default for Supply {
    fn default() -> Self {
        Self { margin: 1.0, phase_rad: 0.0 }
    }
}

impl Supply {
    /// Goes on by `dt_s` s with valves open for `asked_m3_s` at the full margin; the share of it that
    /// flows, alike for every valve: all sense the highest load.
    pub(crate) fn step(&mut self, truth: &SupplyTruth, asked_m3_s: f64, dt_s: f64) -> f64 {
        let h_s = dt_s / f64::from(SUBSTEPS);
        for _ in 0..SUBSTEPS {
            let drawn = asked_m3_s * self.margin.sqrt();
            self.margin += h_s * (truth.flow_m3_s - drawn) / BUFFER_M3;
            self.margin = self.margin.clamp(1e-4, 1.0);
        }
        self.phase_rad += truth.hunting_rad_s * dt_s;
        let hunted = self.margin * (1.0 + truth.hunting * self.phase_rad.sin());
        hunted.max(1e-4).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AMPLE: SupplyTruth = SupplyTruth { flow_m3_s: 0.02, hunting: 0.0, hunting_rad_s: 0.0 };

    fn settled(truth: &SupplyTruth, asked_m3_s: f64) -> f64 {
        let mut supply = Supply::default();
        (0..500).map(|_| supply.step(truth, asked_m3_s, 0.002)).last().unwrap()
    }

    #[test]
    fn a_short_pump_gives_what_it_has() {
        assert_eq!(settled(&AMPLE, 0.004), 1.0);
        let short = SupplyTruth { flow_m3_s: 0.001, ..AMPLE };
        assert!((settled(&short, 0.004) - 0.25).abs() < 1e-3);
        assert_eq!(settled(&short, 0.0009), 1.0);
    }

    #[test]
    fn a_hunting_regulator_swings_the_flow() {
        let truth = SupplyTruth { hunting: 0.5, hunting_rad_s: 10.0, ..AMPLE };
        let mut supply = Supply::default();
        let shares: Vec<f64> = (0..500).map(|_| supply.step(&truth, 0.001, 0.002)).collect();
        let most = shares.iter().fold(0.0_f64, |a, &b| a.max(b));
        let least = shares.iter().fold(2.0_f64, |a, &b| a.min(b));
        assert!((most - 1.5_f64.sqrt()).abs() < 1e-3 && (least - 0.5_f64.sqrt()).abs() < 1e-3);
    }
}
