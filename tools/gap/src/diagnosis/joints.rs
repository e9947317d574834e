//! The articulation joints on measured inputs: the valve's opening in, the joint's angle out.

use xt28_machine::Machine;
use xt28_sim::{Effects, Steering, SteeringInput};

use super::signals::{DT_S, Samples, Signals};

/// Angle that the block predicts for the front (0) or rear (1) joint less the angle measured, rad.
#[must_use]
pub(super) fn joint_error_rad(
    signals: &Signals,
    machine: &Machine,
    effects: &Effects,
    joint: usize,
) -> Samples {
    let steering = Steering::new(machine, &effects.steering);
    let mut state = steering.straight(DT_S);
    let angle = &signals.joint_rad[joint];
    let step = |i: usize| {
        let before = angle[i.saturating_sub(5)];
        let rate_rad_s = if i < 5 { 0.0 } else { (angle[i] - before) / (5.0 * DT_S) };
        let opening = signals.steer_opening[joint][i];
        let input = SteeringInput { opening, angle_rad: angle[i], rate_rad_s };
        steering.step(&mut state, &input, DT_S);
        // The damper acts on the joint's own rate: while it turns, the oil is ahead of it.
        let ahead = steering.damping_nms() / steering.stiffness_nm() * rate_rad_s;
        state.rest_rad - ahead - angle[i]
    };
    (0..signals.len).map(step).collect()
}
