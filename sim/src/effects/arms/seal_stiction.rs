//! `seal-stiction`: Coulomb and Stribeck friction of the cylinder.

use crate::effects::{Block, Effect, Parameter, Slot};

/// Travel over which the seals yield before they slip, m (assumed: rubber lips give some tenths of a
/// millimetre).
const PRESLIDING_M: f64 = 3.0e-4;

/// The friction of one cylinder's seals and of its arm's bearings, brought to the rod.
///
/// The bristle law of Canudas de Wit, Olsson, Åström and Lischinsky (1995): below breakaway the
/// seals are a spring, so that the rod can be held; sliding, they drag with the force of
/// [`SealStiction::sliding_n`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SealStiction {
    /// Friction of a fast sliding rod, N.
    pub coulomb_n: f64,
    /// What it takes more to break away from rest, N.
    pub stribeck_n: f64,
    /// Speed over which that fades, m/s.
    pub stribeck_speed_m_s: f64,
}

impl Default for SealStiction {
    fn default() -> Self {
        Self { coulomb_n: 0.0, stribeck_n: 0.0, stribeck_speed_m_s: 0.01 }
    }
}

impl SealStiction {
    /// Friction of a rod that slides at `rate_m_s`, N.
    #[must_use]
    pub fn sliding_n(&self, rate_m_s: f64) -> f64 {
        let fade = rate_m_s / self.stribeck_speed_m_s;
        self.coulomb_n + self.stribeck_n * (-fade * fade).exp()
    }

    /// Friction after `dt_s` s more at `rate_m_s`, N; it acts against a positive rate where positive.
    /// Implicit in the friction, so it never passes what sliding gives.
    #[must_use]
    pub fn step(&self, friction_n: f64, rate_m_s: f64, dt_s: f64) -> f64 {
        if self.none() {
            return 0.0;
        }
        let stretch_n = self.stiffness_n_m() * rate_m_s * dt_s;
        (friction_n + stretch_n) / (1.0 + self.slip(rate_m_s, dt_s))
    }

    /// The same law over the coming step, about `rate_m_s`: friction if the rod stays, N, and its
    /// growth per travel, N/m.
    #[must_use]
    pub fn ahead(&self, friction_n: f64, rate_m_s: f64, dt_s: f64) -> [f64; 2] {
        if self.none() {
            return [0.0; 2];
        }
        let held = 1.0 / (1.0 + self.slip(rate_m_s, dt_s));
        [friction_n * held, self.stiffness_n_m() * held]
    }

    fn none(&self) -> bool {
        self.coulomb_n + self.stribeck_n == 0.0
    }

    fn stiffness_n_m(&self) -> f64 {
        (self.coulomb_n + self.stribeck_n) / PRESLIDING_M
    }

    /// Travel of the step in lengths over which the friction at this rate builds up.
    fn slip(&self, rate_m_s: f64, dt_s: f64) -> f64 {
        self.stiffness_n_m() * rate_m_s.abs() * dt_s / self.sliding_n(rate_m_s)
    }
}

/// Friction moves the rod, not the oil: the pressures show another load than the wheel carries.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "seal-stiction",
    block: Block::Arms,
    meaning: "Coulomb and Stribeck friction of the cylinder",
    source: "law: Canudas de Wit et al. (1995); assumed: 1 to 5 % of the largest force, 2.7 to 13 kN",
    parameters: &[
        Parameter {
            name: "coulomb_n",
            neutral: 0.0,
            tolerance: 1500.0,
            range: [0.0, 30_000.0],
            acts_alone: true,
            slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].stiction.coulomb_n),
        },
        Parameter {
            name: "stribeck_n",
            neutral: 0.0,
            tolerance: 1000.0,
            range: [0.0, 30_000.0],
            acts_alone: true,
            slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].stiction.stribeck_n),
        },
        Parameter {
            name: "stribeck_speed_m_s",
            neutral: 0.01,
            tolerance: 0.005,
            range: [0.001, 0.1],
            acts_alone: false,
            slot: Slot::PerWheel(|effects, wheel| {
                &mut effects.arms[wheel].stiction.stribeck_speed_m_s
            }),
        },
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    const SEAL: SealStiction =
        SealStiction { coulomb_n: 3000.0, stribeck_n: 2000.0, stribeck_speed_m_s: 0.01 };

    #[test]
    fn sliding_friction_is_coulombs_when_fast_and_more_when_slow() {
        for (rate_m_s, wanted_n) in [(0.1, 3000.0), (-0.1, -3000.0), (1e-4, 4999.8)] {
            let friction_n = (0..20_000).fold(0.0, |f, _| SEAL.step(f, rate_m_s, 0.005));
            assert!((friction_n - wanted_n).abs() < 0.01, "{rate_m_s}: {friction_n}");
        }
    }

    #[test]
    fn a_rod_at_rest_keeps_its_friction_for_ever() {
        let held_n = SEAL.step(0.0, 0.01, 0.005);
        let later_n = (0..100_000).fold(held_n, |f, _| SEAL.step(f, 0.0, 0.005));
        assert!(held_n > 0.0 && later_n == held_n);
    }

    #[test]
    fn ahead_is_the_step_for_the_same_rate() {
        let [force_n, stiffness_n_m] = SEAL.ahead(1200.0, 0.004, 0.005);
        let stepped_n = SEAL.step(1200.0, 0.004, 0.005);
        assert!((force_n + stiffness_n_m * 0.004 * 0.005 - stepped_n).abs() < 1e-9);
    }
}
