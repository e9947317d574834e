//! `unsupported-sag`: an unloaded arm drifts out.

use crate::effects::{Block, Effect, Parameter, Slot};

/// How one arm gives way to the wheel that hangs on it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UnsupportedSag {
    /// Speed of the drift while arm and wheel hang free, m/s.
    pub rate_m_s: f64,
    /// Load of the cylinder below which the drift sets in, N.
    pub below_n: f64,
}

impl UnsupportedSag {
    /// Extending speed of the drift. It grows over as much load as the hanging wheel makes, and no
    /// further: the valve that lets the oil by is then open.
    #[must_use]
    pub fn speed_m_s(&self, load_n: f64, hanging_load_n: f64) -> f64 {
        self.rate_m_s * ((self.below_n - load_n) / hanging_load_n).clamp(0.0, 1.0)
    }
}

/// The rod side leaks to the tank while the bore side draws oil through its anti-cavitation valve.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "unsupported-sag",
    block: Block::Arms,
    meaning: "an unloaded arm drifts out, drawn by its own weight",
    source: "paper 3: unsupported arms do not stay; force thresholds and drift speed; size assumed",
    parameters: &[
        Parameter {
            name: "rate_m_s",
            neutral: 0.0,
            tolerance: 0.003,
            range: [0.0, 0.1],
            acts_alone: true,
            slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].sag.rate_m_s),
        },
        Parameter {
            name: "below_n",
            neutral: 0.0,
            tolerance: 5e3,
            range: [-10e3, 40e3],
            acts_alone: false,
            slot: Slot::PerWheel(|effects, wheel| &mut effects.arms[wheel].sag.below_n),
        },
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_hanging_wheel_draws_the_arm_out() {
        let sag = UnsupportedSag { rate_m_s: 0.01, below_n: 0.0 };
        assert_eq!(sag.speed_m_s(1.0, 12.6e3), 0.0);
        assert!((sag.speed_m_s(-6.3e3, 12.6e3) - 0.005).abs() < 1e-15);
        assert_eq!(sag.speed_m_s(-50e3, 12.6e3), 0.01);
        assert_eq!(UnsupportedSag::default().speed_m_s(-6.3e3, 12.6e3), 0.0);
    }

    #[test]
    fn a_threshold_lets_it_set_in_under_a_little_load() {
        let sag = UnsupportedSag { rate_m_s: 0.01, below_n: 12.6e3 };
        assert_eq!(sag.speed_m_s(0.0, 12.6e3), 0.01);
        assert!((sag.speed_m_s(6.3e3, 12.6e3) - 0.005).abs() < 1e-15);
        assert_eq!(sag.speed_m_s(13e3, 12.6e3), 0.0);
    }
}
