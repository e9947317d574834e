//! A first-order lag: what goes in comes out smoothed over a time constant.

/// The output of a first-order lag.
///
/// Exact for an input that is held over each step, whatever the step. A time constant of zero hands
/// the input through, bit for bit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lag {
    output: f64,
}

impl Lag {
    /// A lag into which `value` has come for ever.
    #[must_use]
    pub const fn new(value: f64) -> Self {
        Self { output: value }
    }

    /// Output now.
    #[must_use]
    pub const fn value(self) -> f64 {
        self.output
    }

    /// Output after `dt_s` s more of `input`.
    pub fn step(&mut self, input: f64, time_constant_s: f64, dt_s: f64) -> f64 {
        self.output = if time_constant_s <= 0.0 {
            input
        } else {
            input + (self.output - input) * (-dt_s / time_constant_s).exp()
        };
        self.output
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_followed_exponentially_at_any_step_length() {
        for dt_s in [0.001, 0.005, 0.05] {
            let mut lag = Lag::new(0.0);
            let mut t = 0.0;
            for _ in 0..20 {
                t += dt_s;
                let out = lag.step(1.0, 0.1, dt_s);
                assert!((out - (1.0 - (-t / 0.1_f64).exp())).abs() < 1e-12, "{t}: {out}");
            }
        }
    }

    #[test]
    fn without_a_time_constant_it_is_a_wire() {
        let mut lag = Lag::new(0.3);
        assert_eq!(lag.step(0.123, 0.0, 0.005).to_bits(), 0.123_f64.to_bits());
    }
}
