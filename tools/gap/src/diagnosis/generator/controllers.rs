//! The steering controllers on measured inputs: command and reading in, the opening they ask for out.

use xt28_machine::Machine;
use xt28_sim::Effects;

use crate::diagnosis::signals::{DT_S, Samples, Signals};

/// Limit of the steering integral, deg s (the machine's conventions).
const STEER_WINDUP_DEG_S: f64 = 40.0;

/// Opening that the steering PI would ask of the front (0) or rear (1) joint less the one asked for.
///
/// Which of two neighbouring samples the ECU saw is not known: where what it would ask jumps between
/// them, anything in between is right. `NaN` where the machine is about to start or to stop.
#[must_use]
pub(super) fn steer_opening_error(
    signals: &Signals,
    machine: &Machine,
    effects: &Effects,
    joint: usize,
) -> Samples {
    let asked = steer_opening_asked(signals, machine, effects, joint);
    let (logged, end) = (&signals.steer_opening[joint], signals.len.saturating_sub(1));
    let threshold_m_s = machine.articulation.speed_threshold_m_s;
    let mut error = 0.0;
    (0..signals.len)
        .map(|i| {
            if signals.is_fresh_drive_current[i] {
                let near = &asked[i.saturating_sub(1)..=(i + 1).min(end)];
                let least = near.iter().copied().fold(f64::INFINITY, f64::min);
                let most = near.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                error = logged[i].clamp(least, most) - logged[i];
            }
            let speed_m_s = signals.mean_wheel_speed_rad_s(i) * machine.wheels.radius_m;
            let starts =
                speed_m_s.abs() > 0.5 * threshold_m_s && speed_m_s.abs() < 2.0 * threshold_m_s;
            if starts { f64::NAN } else { error }
        })
        .collect()
}

/// Opening that the steering PI would ask of the front (0) or rear (1) joint at every sample.
#[must_use]
pub(super) fn steer_opening_asked(
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
    let mut followed_deg = signals.joint_rad[0].first().map_or(0.0, |rad| deg(*rad));
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
        (kp * (error_deg + ki * integral_deg_s)).clamp(-1.0, 1.0)
    };
    (0..signals.len).map(step).collect()
}
