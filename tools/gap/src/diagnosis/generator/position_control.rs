//! The arm ECU's position PI on measured inputs: commanded and read strokes in, the opening out.

use xt28_machine::{Machine, Wheel};
use xt28_sim::Effects;

use super::current_step::{ARM_STEP as STEP, within_step};
use super::summed::best_sum;
use crate::diagnosis::signals::{DT_S, MANUAL_POSITION, Samples, Signals};

/// Halvings in the search for what was summed up: to a hundredth of the most.
const HALVINGS: usize = 3;

/// Opening that the position PI would ask for less the one that was asked for; `NaN` in other modes, and where
/// the arm is to be held.
///
/// A current in whole milliamperes leaves open which opening was meant: what would show as the same
/// current, cut off or rounded, is no error. Nor does the log say what the PI had summed up before
/// it began: the sum that fits best is taken. Nor, where a target moves, which of two the PI had in a tick.
/// Nor whether the ECU keeps a valve shut that would push its arm further into the end of its stroke.
#[must_use]
pub(super) fn arm_opening_error(
    signals: &Signals,
    machine: &Machine,
    effects: &Effects,
    wheel: Wheel,
) -> Samples {
    let pi = Pi::new(machine, effects, wheel);
    let mut errors = Samples::with_capacity(signals.len);
    while errors.len() < signals.len {
        let from = errors.len();
        let at_work =
            |i: &usize| signals.arm_mode[*i] == MANUAL_POSITION && !signals.is_arm_held[wheel][*i];
        let to = (from..signals.len).find(|i| !at_work(i)).unwrap_or(signals.len);
        let target_m = &signals.target_stroke_m[wheel];
        let mm = |m: f64| (m * 1e3).round();
        let span = ControlledSpan {
            error_mm: (from..to)
                .map(|i| mm(target_m[i] - signals.stroke_reading_m[wheel][i]))
                .collect(),
            end: (from..to).map(|i| end_of(machine, signals.stroke_reading_m[wheel][i])).collect(),
            moved_mm: (from..to).map(|i| mm(target_m[i] - target_m[i.max(from + 1) - 1])).collect(),
            opening: &signals.opening[wheel][from..to],
        };
        errors.extend(pi.best_errors(&span));
        let idle = (to..signals.len).find(at_work).unwrap_or(signals.len) - to;
        errors.extend(core::iter::repeat_n(f64::NAN, idle));
    }
    errors
}

/// A span of a run in which the PI is at work.
struct ControlledSpan<'a> {
    /// Target less reading, both whole millimetres.
    error_mm: Vec<f64>,
    /// Which way the end of the stroke lies that the arm stands at, + out, or 0.
    end: Vec<f64>,
    /// How far the target has moved since the tick before.
    moved_mm: Vec<f64>,
    opening: &'a [f64],
}

/// The law (paper 3.2; limits as in the machine file).
struct Pi {
    kp_per_mm: f64,
    ki_per_mm_s: f64,
    windup_mm_s: f64,
    most: f64,
}

impl Pi {
    fn new(machine: &Machine, effects: &Effects, wheel: Wheel) -> Self {
        let (h, gain) = (&machine.hydraulics, effects.arms[wheel].gain);
        Self {
            kp_per_mm: h.manual_kp_per_mm * gain.kp_factor,
            ki_per_mm_s: h.manual_ki_per_mm_s * gain.ki_factor,
            windup_mm_s: h.manual_windup,
            most: h.manual_opening_max,
        }
    }

    /// Errors from the sum at the beginning that makes the fewest.
    fn best_errors(&self, span: &ControlledSpan<'_>) -> Samples {
        let square = |sum: f64| self.errors(span, sum).map(|e| e * e).sum::<f64>();
        self.errors(span, best_sum(self.windup_mm_s, HALVINGS, square)).collect()
    }

    fn errors(&self, span: &ControlledSpan<'_>, sum_mm_s: f64) -> impl Iterator<Item = f64> {
        let asked = self.asked(&span.error_mm, sum_mm_s);
        let known = span.moved_mm.iter().zip(&span.end).zip(span.opening);
        asked.zip(known).map(|(asked, ((moved_mm, end), opening))| {
            let before = (asked - self.kp_per_mm * moved_mm).clamp(-self.most, self.most);
            let shut = if asked * end > 0.0 { 0.0 } else { asked };
            let [least, most] = [before.min(asked).min(shut), before.max(asked).max(shut)];
            let asked = opening.clamp(least, most);
            asked - within_step(asked, *opening, STEP)
        })
    }

    /// The openings asked for, with `sum_mm_s` summed up before.
    fn asked(&self, error_mm: &[f64], mut sum_mm_s: f64) -> impl Iterator<Item = f64> {
        error_mm.iter().map(move |error_mm| {
            sum_mm_s = (sum_mm_s + error_mm * DT_S).clamp(-self.windup_mm_s, self.windup_mm_s);
            let asked = self.kp_per_mm * error_mm + self.ki_per_mm_s * sum_mm_s;
            asked.clamp(-self.most, self.most)
        })
    }
}

/// Which way the end of the stroke lies that a reading is at, + out; 0 between the ends.
pub(super) fn end_of(machine: &Machine, reading_m: f64) -> f64 {
    if reading_m <= 0.0 {
        -1.0
    } else if reading_m >= machine.arms.stroke_max_m {
        1.0
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pi() -> Pi {
        Pi::new(&Machine::xt28(), &Effects::default(), Wheel::Fr)
    }

    /// What an ECU with `sum` on its mind sends, in whole milliamperes cut off.
    fn sent(pi: &Pi, error_mm: &[f64], sum: f64) -> Vec<f64> {
        pi.asked(error_mm, sum).map(|asked| (asked / STEP).trunc() * STEP).collect()
    }

    /// A span whose target stands.
    fn standing(error_mm: Vec<f64>, opening: &[f64]) -> ControlledSpan<'_> {
        let still = vec![0.0; error_mm.len()];
        ControlledSpan { end: still.clone(), moved_mm: still, error_mm, opening }
    }

    #[test]
    fn which_of_two_targets_it_had_in_a_tick_is_no_error_and_another_is() {
        let (pi, moved_mm) = (pi(), vec![2.0; 200]);
        // The arm lags a target that moves by 2 mm a tick.
        let now: Vec<f64> = (0..200).map(|i| f64::from(i.min(20)) * 2.0).collect();
        let of = |behind_mm: f64| -> Vec<f64> { now.iter().map(|mm| mm - behind_mm).collect() };
        let worst = |behind_mm: f64| {
            let opening = sent(&pi, &of(behind_mm), 0.0);
            let span =
                ControlledSpan { moved_mm: moved_mm.clone(), ..standing(now.clone(), &opening) };
            pi.best_errors(&span).into_iter().fold(0.0, |w: f64, e| w.max(e.abs()))
        };
        assert!(worst(0.0) < 0.2 * STEP && worst(2.0) < STEP, "{} {}", worst(0.0), worst(2.0));
        assert!(worst(6.0) > 2.0 * STEP, "{}", worst(6.0));
    }

    #[test]
    fn a_valve_kept_shut_at_the_end_of_the_stroke_is_no_error_and_one_kept_shut_before_it_is() {
        // Target 0 after a way out: the PI still asks to go in.
        let pi = pi();
        let worst = |end: f64| {
            let span =
                ControlledSpan { end: vec![end; 200], ..standing(vec![-3.0; 200], &[0.0; 200]) };
            pi.errors(&span, -100.0).fold(0.0, |w: f64, e| w.max(e.abs()))
        };
        assert_eq!(worst(-1.0), 0.0);
        assert!(
            worst(0.0) > 2.0 * STEP && worst(1.0) > 2.0 * STEP,
            "{} {}",
            worst(0.0),
            worst(1.0)
        );
        let machine = Machine::xt28();
        assert_eq!([0.0, 0.001, 0.25, 0.5].map(|m| end_of(&machine, m)), [-1.0, 0.0, 0.0, 1.0]);
    }

    fn errors_mm() -> Vec<f64> {
        (0..1500).map(|i| (f64::from(i) * 0.01).sin() * 12.0).map(f64::round).collect()
    }

    #[test]
    fn its_own_currents_leave_nothing_whatever_it_had_summed_up() {
        for sum in [-100.0, -13.0, 0.0, 61.0] {
            let error_mm = errors_mm();
            let opening = sent(&pi(), &error_mm, sum);
            let span = standing(error_mm, &opening);
            let worst = pi().best_errors(&span).into_iter().fold(0.0, |w: f64, e| w.max(e.abs()));
            assert!(worst < 0.2 * STEP, "{sum}: {worst}");
        }
    }

    #[test]
    fn another_gain_shows() {
        let error_mm = errors_mm();
        let opening = sent(&pi(), &error_mm, 0.0);
        let span = standing(error_mm, &opening);
        let louder = Pi { kp_per_mm: 1.5 * pi().kp_per_mm, ..pi() };
        let errors = louder.best_errors(&span);
        let rms = (errors.iter().map(|e| e * e).sum::<f64>() / 1500.0).sqrt();
        assert!(rms > 4.0 * STEP, "{rms}");
    }
}
