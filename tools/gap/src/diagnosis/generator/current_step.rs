//! What a current on the wire leaves open of the opening that was meant: a wire tells currents in steps.

/// A step of an arm valve's current, 1 mA, as an opening (facts 1.1: 400 mA from start to full).
pub(super) const ARM_STEP: f64 = 1.0 / 400.0;
/// A step of a steering valve's current, 3 mA, as an opening (facts 4.6: 315 mA from start to full).
pub(super) const STEER_STEP: f64 = 3.0 / 315.0;

/// The opening nearest to `asked` that shows as the current of `opening`, whether a controller rounds to
/// whole steps of `step` or cuts off: half a step below to a whole step above in size, or anything less
/// than a step where there is no current.
pub(super) fn within_step(asked: f64, opening: f64, step: f64) -> f64 {
    let [below, above] = match opening {
        0.0 => [step, step],
        o if o > 0.0 => [0.5 * step, step],
        _ => [step, 0.5 * step],
    };
    asked.clamp(opening - below, opening + above)
}

/// The middle of what shows as the current of `opening` where a controller cuts off.
pub(super) fn middle_of_cut(opening: f64, step: f64) -> f64 {
    if opening == 0.0 { 0.0 } else { opening + 0.5 * step * opening.signum() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_cut_off_or_rounded_shows_as_what_is_logged() {
        for asked in (-100..=100).map(|i| 0.003_7 * f64::from(i)) {
            for step in [ARM_STEP, STEER_STEP] {
                let steps = asked / step;
                for logged in [steps.trunc() * step, steps.round() * step] {
                    let kept = within_step(asked, logged, step);
                    assert!((kept - asked).abs() < 1e-12, "{asked} as {logged}: {kept}");
                }
            }
        }
    }

    #[test]
    fn the_middle_of_what_was_cut_off_is_half_a_step_from_either_end() {
        for asked in (-100..=100).map(|i| 0.003_7 * f64::from(i)) {
            let logged = (asked / STEER_STEP).trunc() * STEER_STEP;
            let off = (middle_of_cut(logged, STEER_STEP) - asked).abs();
            assert!(off <= 0.5 * STEER_STEP + 1e-12 || logged == 0.0, "{asked} as {logged}");
        }
    }

    #[test]
    fn what_is_further_off_is_moved_to_the_edge() {
        for (asked, logged, kept) in [(0.9, 0.5, 0.6), (0.1, 0.5, 0.45), (-0.9, -0.5, -0.6)] {
            assert!((within_step(asked, logged, 0.1) - kept).abs() < 1e-12);
        }
    }
}
