//! A transport delay: what goes in comes out later, between two steps if need be.

/// The last inputs of a delay, one a step.
///
/// Steps have to be of one length. Between two of them the output is interpolated, so that it
/// changes smoothly with the delay. A delay of zero hands the input through, bit for bit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DelayLine {
    past: Vec<f64>,
    newest: usize,
}

impl DelayLine {
    /// A line on which `value` has come in for ever.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub fn new(delay_s: f64, dt_s: f64, value: f64) -> Self {
        if delay_s <= 0.0 {
            return Self::default();
        }
        let steps = (delay_s / dt_s).ceil() as usize;
        Self { past: vec![value; steps + 1], newest: 0 }
    }

    /// Takes `value` in; gives what came in `delay_s` s ago. `delay_s` and `dt_s` are those it was
    /// made for.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
    pub fn step(&mut self, value: f64, delay_s: f64, dt_s: f64) -> f64 {
        let length = self.past.len();
        if length == 0 {
            return value;
        }
        self.newest = (self.newest + 1) % length;
        self.past[self.newest] = value;
        let steps = (delay_s / dt_s).clamp(0.0, (length - 1) as f64);
        let whole = steps.floor() as usize;
        let ago = |n: usize| self.past[(self.newest + length - n.min(length - 1)) % length];
        let share = steps - whole as f64;
        ago(whole) + share * (ago(whole + 1) - ago(whole))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_comes_out_late_by_the_delay() {
        for delay_s in [0.0, 0.0025, 0.005, 0.0123, 0.4] {
            let mut line = DelayLine::new(delay_s, 0.005, 0.0);
            for step in 0..200 {
                let t = f64::from(step) * 0.005;
                let out = line.step(t, delay_s, 0.005);
                assert!(t < delay_s || (out - (t - delay_s)).abs() < 1e-12, "{delay_s}: {out}");
            }
        }
    }
}
