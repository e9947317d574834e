//! Faults of reading that are in no catalogue: a diagnosis has to say that it does not know them.

use xt28_gap::Channel;
use xt28_sim::effects::Scope;

use super::fault::{Fault, On, Readings, Size, change, filter};

/// All of them.
pub(super) const FAULTS: &[Fault] = &[
    Fault {
        name: "receiver-scale",
        on: On::Machine,
        parameters: &[Size { name: "factor", within: &[[0.88, 0.92], [1.08, 1.12]] }],
        lay: receiver_scale,
    },
    Fault {
        name: "receiver-stalls",
        on: On::Machine,
        parameters: &[Size { name: "stall_s", within: &[[1.0, 2.0]] }],
        lay: receiver_stalls,
    },
    Fault {
        name: "joint-bias",
        on: On::Machine,
        parameters: &[Size { name: "rear_rad", within: &[[-0.07, -0.04], [0.04, 0.07]] }],
        lay: joint_bias,
    },
    Fault {
        name: "joint-scale",
        on: On::Machine,
        parameters: &[Size { name: "rear_factor", within: &[[0.8, 0.88], [1.12, 1.2]] }],
        lay: joint_scale,
    },
    Fault {
        name: "wheel-speed-filter",
        on: On::SomeWheels,
        parameters: &[Size { name: "time_constant_s", within: &[[0.3, 0.6]] }],
        lay: wheel_speed_filter,
    },
    Fault {
        name: "pressure-filter",
        on: On::Wheels,
        parameters: &[Size { name: "time_constant_s", within: &[[0.4, 0.8]] }],
        lay: pressure_filter,
    },
];

/// Time from one stall to the next, s.
const STALLS_S: f64 = 5.0;

/// Its metres are of another length.
fn receiver_scale(readings: &mut Readings, _: Scope, values: &[f64]) {
    for channel in [Channel::East, Channel::North] {
        change(readings, channel, |_, metres| values[0] * metres);
    }
}

/// Again and again it repeats its last fix for a while.
fn receiver_stalls(readings: &mut Readings, _: Scope, values: &[f64]) {
    for channel in [Channel::East, Channel::North] {
        let mut last = None;
        change(readings, channel, |at_s, now| {
            let stalls = at_s.rem_euclid(STALLS_S) < values[0];
            let said = last.filter(|_| stalls).unwrap_or(now);
            last = Some(said);
            said
        });
    }
}

fn joint_bias(readings: &mut Readings, _: Scope, values: &[f64]) {
    change(readings, Channel::RearJoint, |_, rad| rad + values[0]);
}

fn joint_scale(readings: &mut Readings, _: Scope, values: &[f64]) {
    change(readings, Channel::RearJoint, |_, rad| values[0] * rad);
}

fn wheel_speed_filter(readings: &mut Readings, scope: Scope, values: &[f64]) {
    for wheel in scope.wheels() {
        filter(readings, Channel::WheelSpeed(wheel), values[0]);
    }
}

fn pressure_filter(readings: &mut Readings, scope: Scope, values: &[f64]) {
    for wheel in scope.wheels() {
        let of = [Channel::BorePressure, Channel::RodPressure, Channel::CylinderLoad];
        of.iter().for_each(|channel| filter(readings, channel(wheel), values[0]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_receiver_that_stalls_says_its_last_fix_and_goes_on_from_where_it_is() {
        let east = (0..200).map(|k| (0.1 * f64::from(k), 0.1 * f64::from(k)));
        let mut readings: Readings = [(Channel::East, east.collect())].into();
        receiver_stalls(&mut readings, Scope::All, &[1.5]);
        let at = |at_s| readings[&Channel::East].at(at_s).unwrap();
        assert!((at(6.0) - 4.9).abs() < 0.11 && (at(7.0) - 6.9).abs() < 0.11);
    }
}
