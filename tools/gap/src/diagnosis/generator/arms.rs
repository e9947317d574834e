//! Arm hydraulics on measured inputs: the valve's opening and the cylinder's load in, its stroke out.

use xt28_machine::{Machine, Wheel};
use xt28_sim::effects::SealStiction;

use super::arm_drive::ArmDrive;
use super::loads::KEPT;
use super::spool::square;
use super::{pump, spool};
use crate::diagnosis::belief::EffectSchedule;
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
    schedule: EffectSchedule<'_>,
    wheel: Wheel,
) -> Samples {
    let effects = schedule.effects;
    let drive = ArmDrive::new(signals, machine, effects, wheel).over(schedule);
    // No log says what else the pump has to give. The arm does.
    let shares = pump::flow_shares(signals, machine, effects);
    let hysteresis = effects.arms[wheel].hysteresis;
    let each = shares.iter().map(|share| spool::stroke_errors_m(&drive, hysteresis, share));
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

#[cfg(test)]
mod tests {
    use xt28_sim::Effects;

    use super::super::still::still;
    use super::*;
    use crate::diagnosis::signals::DT_S;

    /// A machine whose valves open for 4 s while its joints turn, on a pump that runs short by the law number `law`.
    fn short_of_oil(law: usize, effects: &Effects) -> Signals {
        let (machine, mut s) = (Machine::xt28(), still(15));
        for w in Wheel::ALL {
            s.chamber_pa[w] = [Vec::new(), Vec::new()];
            s.cylinder_load_n[w].fill(6.0e4);
            s.opening[w][500..900].fill(if w == Wheel::Fl { 0.4 } else { -0.4 });
        }
        s.steer_opening[0][500..900].fill(0.8);
        let share = pump::flow_shares(&s, &machine, effects).swap_remove(law);
        for w in Wheel::ALL {
            let asked = ArmDrive::new(&s, &machine, effects, w).speeds_asked_m_s(None);
            let mut stroke_m = 0.25;
            for i in 1..s.len {
                s.stroke_m[w][i - 1] = stroke_m;
                stroke_m += share[i - 1] * asked[i - 1] * DT_S;
            }
            s.stroke_m[w][s.len - 1] = stroke_m;
        }
        s
    }

    #[test]
    fn an_arm_says_what_else_its_pump_has_to_give() {
        let machine = Machine::xt28();
        let mut effects = Effects::default();
        effects.pump_flow.flow_m3_s = 1.0e-3;
        let largest_m = |errors: &Samples| errors.iter().fold(0.0_f64, |most, m| most.max(m.abs()));
        for law in 0..4 {
            let s = short_of_oil(law, &effects);
            let error_m = largest_m(&stroke_error_m(&s, &machine, (&effects).into(), Wheel::Fl));
            // The damper's share of a load that is held is not in it.
            assert!(error_m < 1.0e-3, "law {law}: {error_m} m");
            let shares = pump::flow_shares(&s, &machine, &effects);
            let drive = ArmDrive::new(&s, &machine, &effects, Wheel::Fl);
            let other_m = largest_m(&drive.stroke_errors_m(&shares[3 - law], None).0);
            assert!(other_m > 5.0 * error_m, "law {law}: {other_m} m");
        }
    }
}
