//! The steering controllers on measured inputs: command and reading in, the opening they ask for out.

use xt28_machine::Machine;
use xt28_sim::Effects;

use super::signals::{DT_S, Samples, Signals};

/// Limit of the steering integral, deg s (the machine's conventions).
const STEER_WINDUP_DEG_S: f64 = 40.0;

/// Opening that the steering PI would ask of the front (0) or rear (1) joint less the one asked for.
#[must_use]
pub(super) fn steer_opening_error(
    signals: &Signals,
    machine: &Machine,
    effects: &Effects,
    joint: usize,
) -> Samples {
    let (a, gain) = (&machine.articulation, effects.steering.gain);
    let follower = effects.steering.rear_follower;
    let (kp, ki) = (a.kp_per_deg * gain.kp_factor, a.ki_per_s * gain.ki_factor);
    let deg = |rad: f64| rad.to_degrees();
    let mut integral_deg_s = 0.0;
    let mut followed_deg = deg(signals.joint_rad[0][0]);
    let step = |i: usize| {
        let front_deg = deg(signals.joint_rad[0][i]);
        followed_deg = if follower.time_constant_s > 0.0 {
            front_deg + (followed_deg - front_deg) * (-DT_S / follower.time_constant_s).exp()
        } else {
            front_deg
        };
        let speed_m_s = signals.mean_wheel_speed_rad_s(i) * machine.wheels.radius_m;
        if speed_m_s.abs() < a.speed_threshold_m_s {
            integral_deg_s = 0.0;
            return 0.0;
        }
        let target_deg = match joint {
            0 => deg(signals.target_joint_rad[i]),
            _ => a.rear_ratio * follower.ratio_factor * followed_deg,
        };
        let error_deg = target_deg - deg(signals.joint_rad[joint][i]);
        integral_deg_s =
            (integral_deg_s + error_deg * DT_S).clamp(-STEER_WINDUP_DEG_S, STEER_WINDUP_DEG_S);
        let asked = (kp * (error_deg + ki * integral_deg_s)).clamp(-1.0, 1.0);
        asked - signals.steer_opening[joint][i]
    };
    (0..signals.len).map(step).collect()
}
