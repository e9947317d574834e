//! Friction of a rod in its seals: an anchor that the rod drags along.
//!
//! The reset integrator of Haessig and Friedland (1991): within its reach the anchor holds the rod as
//! a spring would; beyond it slides behind. The reach is shorter when the rod is fast (Stribeck).

use crate::truth::SealTruth;

/// Stiffness of the lips, N/m (assumed).
const LIPS_N_M: f64 = 1.2e7;

/// Where the anchor is, from the rod, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Seal {
    stretch_m: f64,
}

impl Seal {
    /// The rod went `travel_m` and is at `rate_m_s`: force against outward travel, N.
    pub(crate) fn step(&mut self, truth: &SealTruth, travel_m: f64, rate_m_s: f64) -> f64 {
        let fade = (rate_m_s / truth.fade_m_s).abs();
        let most_n = truth.coulomb_n + truth.breakaway_n / (1.0 + fade * fade);
        let reach_m = most_n / LIPS_N_M;
        self.stretch_m = (self.stretch_m + travel_m).clamp(-reach_m, reach_m);
        LIPS_N_M * self.stretch_m
    }

    /// Slope of the force while the anchor holds, N/m; 0 while it slides.
    pub(crate) fn stiffness_n_m(&self, truth: &SealTruth) -> f64 {
        let reach_m = (truth.coulomb_n + truth.breakaway_n) / LIPS_N_M;
        if self.stretch_m.abs() < 0.999 * reach_m { LIPS_N_M } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DRY: SealTruth = SealTruth { coulomb_n: 6e3, breakaway_n: 3e3, fade_m_s: 0.01 };

    #[test]
    fn it_holds_breaks_away_and_slides() {
        let mut seal = Seal::default();
        let slow = |seal: &mut Seal, n| (0..n).map(|_| seal.step(&DRY, 1e-6, 5e-4)).last().unwrap();
        assert!((slow(&mut seal, 100) - 1200.0).abs() < 1e-6);
        assert!(seal.stiffness_n_m(&DRY) > 1e7);
        let peak = slow(&mut seal, 2000);
        assert!((peak - 9e3).abs() < 30.0, "{peak}");
        assert!((seal.step(&DRY, 2e-4, 0.1) - 6e3).abs() < 40.0);
    }

    #[test]
    fn a_smooth_rod_feels_nothing() {
        let none = SealTruth { coulomb_n: 0.0, breakaway_n: 0.0, fade_m_s: 0.01 };
        assert_eq!(Seal::default().step(&none, 0.01, 1.0), 0.0);
        assert_eq!(Seal::default().stiffness_n_m(&none), 0.0);
    }
}
