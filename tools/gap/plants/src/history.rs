//! A short memory of a signal, to be read some time back.

/// How far back it reaches, s.
const SPAN_S: f64 = 1.0;

/// The newest second of a signal that is noted at a fixed rate.
#[derive(Clone, Debug)]
pub(crate) struct History {
    ring: Vec<f64>,
    next: usize,
    step_s: f64,
}

impl History {
    /// A memory of nothing but `value`, to be written every `step_s` s.
    pub(crate) fn new(step_s: f64, value: f64) -> Self {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // some hundreds
        let length = (SPAN_S / step_s).ceil() as usize + 2;
        Self { ring: vec![value; length], next: 0, step_s }
    }

    /// Notes the value of now.
    pub(crate) fn note(&mut self, value: f64) {
        self.ring[self.next] = value;
        self.next = (self.next + 1) % self.ring.len();
    }

    /// What was noted `ago_s` s before the newest value, between two notes on the line joining them.
    pub(crate) fn back(&self, ago_s: f64) -> f64 {
        let steps = (ago_s / self.step_s).clamp(0.0, SPAN_S / self.step_s);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped above
        let whole = steps.floor() as usize;
        let length = self.ring.len();
        let at = |back: usize| self.ring[(self.next + 2 * length - 1 - back) % length];
        let share = steps - steps.floor();
        at(whole) + share * (at(whole + 1) - at(whole))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_is_read_back_exactly() {
        let mut history = History::new(0.002, 0.0);
        for step in 0..2000 {
            history.note(0.002 * f64::from(step));
        }
        for ago_s in [0.0, 0.002, 0.0131, 0.25, 1.0] {
            assert!((history.back(ago_s) - (0.002 * 1999.0 - ago_s)).abs() < 1e-12, "{ago_s}");
        }
    }
}
