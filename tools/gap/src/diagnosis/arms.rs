//! Arm hydraulics on measured inputs: the valve's opening and the cylinder's load in, its stroke out.

use xt28_machine::{Machine, Wheel};
use xt28_sim::effects::Lag;
use xt28_sim::{Arm, ArmInput, CylinderMotion, Effects};

use super::signals::{DT_S, Samples, Signals};

/// Time constant of the filter through which the ECU sees pressures, s: 0.94088 a tick (facts 3.2).
const PRESSURE_FILTER_S: f64 = 0.164;
/// Samples after which the oil is set to what is measured again: an error that grows for longer would
/// run into the relief valve, which gives way to what is measured.
const SEGMENT: usize = 500;

/// Stroke that the block predicts less the stroke measured, m, for one arm over a whole run.
///
/// The block is driven with the opening that the ECU asked for and with the load that was measured;
/// where its lock would make another force than that load, it would stand elsewhere.
#[must_use]
pub(super) fn stroke_error_m(
    signals: &Signals,
    machine: &Machine,
    effects: &Effects,
    wheel: Wheel,
) -> Samples {
    let arm = Arm::new(machine, &effects.arms[wheel]);
    let (stroke, load) = (&signals.stroke_m[wheel], &signals.cylinder_load_n[wheel]);
    let (bias, scale) =
        (effects.wheels[wheel].stroke_bias.bias_m, effects.wheels[wheel].stroke_scale.factor);
    let truth = |reading_m: f64| (reading_m - bias) / scale;
    let mut state = arm.settled(truth(stroke[0]), load[0], DT_S);
    let mut seen = Lag::new(load[0]);
    (0..signals.len)
        .map(|i| {
            let motion = CylinderMotion {
                stroke_m: truth(stroke[i]),
                stroke_rate_m_s: signals.stroke_rate_m_s[wheel][i] / scale,
            };
            let input = ArmInput { command: signals.opening[wheel][i], load_n: load[i], motion };
            if i % SEGMENT == 0 && i > 0 {
                // The valve remembers; only the oil is taken up anew.
                state.cylinder = arm.resumed(&input, DT_S).cylinder;
            }
            arm.step(&mut state, &input, 1.0, DT_S);
            // Pressures tell the force of the oil: what the seals hold is not among it.
            let oil_n = arm.oil_force_n(&state, &motion);
            let seen_n = seen.step(oil_n, PRESSURE_FILTER_S, DT_S);
            scale * (seen_n - load[i]) / machine.hydraulics.lock_stiffness_n_m
        })
        .collect()
}
