//! The joints as the controller would have them from the command alone.

use xt28_machine::Machine;

use crate::diagnosis::generator::STEER_WINDUP_DEG_S;
use crate::diagnosis::signals::{DT_S, Samples, Signals};

/// The angles of both joints as the controller would have them from the command alone, rad, on a machine without
/// a fault. A machine that drives as its log begins has turned by then as it was told.
pub(super) fn commanded_rad(s: &Signals, machine: &Machine) -> [Samples; 2] {
    let a = &machine.articulation;
    let begins_deg = s.target_joint_rad.first().filter(|_| drives(s, machine, 0));
    let front_deg = begins_deg.map_or(0.0, |rad| rad.to_degrees());
    let mut angles_deg = [front_deg, a.rear_ratio * front_deg];
    let mut sums_deg_s = [0.0; 2];
    let mut all = [const { Samples::new() }; 2];
    for i in 0..s.len {
        let targets_deg = [s.target_joint_rad[i].to_degrees(), a.rear_ratio * angles_deg[0]];
        for k in 0..2 {
            if drives(s, machine, i) {
                let error_deg = targets_deg[k] - angles_deg[k];
                let sum_deg_s = sums_deg_s[k] + error_deg * DT_S;
                sums_deg_s[k] = sum_deg_s.clamp(-STEER_WINDUP_DEG_S, STEER_WINDUP_DEG_S);
                let opening = a.kp_per_deg * (error_deg + a.ki_per_s * sums_deg_s[k]);
                angles_deg[k] += a.rate_max_deg_s * opening.clamp(-1.0, 1.0) * DT_S;
            } else {
                sums_deg_s[k] = 0.0;
            }
            all[k].push(angles_deg[k].to_radians());
        }
    }
    all
}

/// Whether the machine is fast enough at sample `i` to be steered.
fn drives(s: &Signals, machine: &Machine, i: usize) -> bool {
    let speed_m_s = s.mean_wheel_speed_rad_s(i) * machine.wheels.radius_m;
    i < s.len && speed_m_s.abs() >= machine.articulation.speed_threshold_m_s
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Channel, Series, Terrain};

    /// A machine that is told to turn left by 0.1 rad and drives for the first ten of twenty seconds.
    fn turned() -> Signals {
        let of = |value: &dyn Fn(f64) -> f64| -> Series {
            (0..2000).map(|i| f64::from(i) * 0.01).map(|at_s| (at_s, value(at_s))).collect()
        };
        let reads = |channel: Channel| match channel {
            Channel::WheelSpeed(_) => of(&|at_s| if at_s < 10.0 { 1.0 } else { 0.0 }),
            Channel::TargetJoint => of(&|at_s| if (2.0..12.0).contains(&at_s) { 0.1 } else { 0.0 }),
            _ => of(&|_| 0.0),
        };
        let all = Channel::all().into_iter().map(|channel| (channel, reads(channel)));
        Signals::of_series("made up", &all.collect(), 20.0, Terrain::Flat).unwrap()
    }

    #[test]
    fn joints_turn_as_told_while_the_machine_drives_and_stay_where_they_are_while_it_stands() {
        let [front, rear] = commanded_rad(&turned(), &Machine::xt28());
        assert_eq!(front[150], 0.0);
        assert!((0.08..0.15).contains(&front[990]), "{}", front[990]);
        assert!((0.4..0.8).contains(&(rear[990] / front[990])), "{}", rear[990]);
        assert_eq!((front[1010], rear[1010]), (front[1900], rear[1900]));
    }
}
