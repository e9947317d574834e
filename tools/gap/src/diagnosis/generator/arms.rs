//! Arm hydraulics on measured inputs: the valve's opening and the cylinder's load in, its stroke out.

use xt28_machine::{Machine, Wheel};
use xt28_sim::effects::SealStiction;

use super::arm_drive::ArmDrive;
use super::loads::KEPT;
use super::pump;
use crate::diagnosis::belief::Course;
use crate::diagnosis::signals::{Samples, Signals};

/// Stroke rate over which friction changes its sign, m/s: what 0.2 s of a reading in whole
/// millimetres tell apart from rest.
const SLIDING_M_S: f64 = 0.004;

/// Stroke that the block predicts less the stroke measured, m, for one arm over a whole run.
///
/// The block is driven with the opening that the ECU asked for, the load and the motion that were
/// measured. It says which load the oil then makes and the ECU's filter shows; where that is another
/// than the one read, the cylinder would stand elsewhere by what its lock gives way for the difference.
#[must_use]
pub(super) fn stroke_error_m(
    signals: &Signals,
    machine: &Machine,
    course: Course<'_>,
    wheel: Wheel,
) -> Samples {
    let effects = course.effects;
    let drive = ArmDrive::new(signals, machine, effects, wheel).over(course);
    // No log says what else the pump has to give. The arm does.
    let shares = pump::flow_shares(signals, machine, effects);
    let each = shares.iter().map(|share| drive.stroke_errors_m(share));
    let least = each.min_by(|(a, _), (b, _)| square(a).total_cmp(&square(b)));
    let (errors, softness) = least.unwrap_or_default();
    let stiction = &effects.arms[wheel].stiction;
    if stiction.coulomb_n + stiction.stribeck_n == 0.0 {
        return errors;
    }
    let seen_n = seen_friction_n(stiction, &signals.stroke_rate_m_s[wheel]);
    let each = errors.iter().zip(softness.iter().zip(&seen_n));
    let with: Samples = each.map(|(error_m, (m_n, n))| error_m - m_n * n).collect();
    // Where the pressures are taken, the seals are among the load or they are not; nobody knows.
    if square(&with) < square(&errors) { with } else { errors }
}

/// Sum of the squares of errors, where there are any.
fn square(errors: &Samples) -> f64 {
    errors.iter().filter(|e| e.is_finite()).map(|e| e * e).sum()
}

/// Friction of seals that slide as measured, as far as a load that has it in shows it.
///
/// By the sign of the rate and no more: what rubber remembers at rest cannot be driven with a reading
/// in whole millimetres, it would follow any error.
fn seen_friction_n(stiction: &SealStiction, rate_m_s: &Samples) -> Samples {
    let mut seen_n = 0.0;
    let step = |rate_m_s: &f64| {
        let sign = (rate_m_s / SLIDING_M_S).tanh();
        seen_n = KEPT * seen_n + (1.0 - KEPT) * sign * stiction.sliding_n(*rate_m_s);
        seen_n
    };
    rate_m_s.iter().map(step).collect()
}
