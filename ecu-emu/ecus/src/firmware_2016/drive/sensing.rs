//! Joint angles and pump pressures (facts 4.6, 4.9).

use crate::DrivePins;
use crate::firmware_2016::Quirks;
use crate::firmware_2016::whole::{cut, input_mv};

/// Front and rear joint at their right limit, straight, and at their left limit, mV.
const JOINT_MV: [[i32; 3]; 2] = [[1727, 3296, 4509], [867, 2244, 3464]];
/// Limit of either, 0.01 deg.
const JOINT_MAX: i32 = 2500;
/// Pump pressure, 0.01 bar for each mV above 500; its end.
const PUMP_PER_MV: i32 = 15;
const PUMP_MAX: i32 = 60_000;

/// Front and rear joint, 0.01 deg, left > 0.
pub(super) fn joints(pins: &DrivePins) -> [i32; 2] {
    let joint = |mv: f64, [right, straight, left]: [i32; 3]| {
        let above = input_mv(mv) - straight;
        let span = if above < 0 { straight - right } else { left - straight };
        (above * JOINT_MAX / span).clamp(-JOINT_MAX, JOINT_MAX)
    };
    [joint(pins.joint_front_mv, JOINT_MV[0]), joint(pins.joint_rear_mv, JOINT_MV[1])]
}

/// Pumps 1A 1B 2A 2B, 0.01 bar.
pub(super) fn pumps(pins: &DrivePins) -> [i32; 4] {
    pins.pump_mv.map(|mv| ((input_mv(mv) - 500) * PUMP_PER_MV).clamp(0, PUMP_MAX))
}

/// The chair switch is an input of its own: above 6 V the chair is to the front.
pub(super) fn chair_front(chair_mv: f64) -> bool {
    chair_mv > 6000.0
}

/// Fuel sender: the byte of ohms, and the level in % that they mean.
pub(super) fn fuel(ohm: f64) -> [i32; 2] {
    let ohm = cut(ohm.clamp(0.0, 1000.0));
    [ohm, (187 - ohm) * 100 / (187 - 11)]
}

/// Speeds for the frame of wheels 1 to 4: the firmware sends wheel 1 in all four places.
pub(super) const fn sent_speeds(counts: [i32; 6], quirks: Quirks) -> [i32; 4] {
    let [first, second, third, fourth, ..] = counts;
    if quirks.wheel_1_sent_four_times { [first; 4] } else { [first, second, third, fourth] }
}

#[cfg(test)]
mod tests {
    use xt28_machine::PerWheel;

    use super::*;

    fn pins(joint_mv: f64, pump_mv: f64) -> DrivePins {
        DrivePins {
            joint_front_mv: joint_mv,
            joint_rear_mv: joint_mv,
            wheel_hz: PerWheel::splat(0.0),
            wheel_forward: PerWheel::splat(true),
            pump_mv: [pump_mv; 4],
            supply_mv: 24_000.0,
        }
    }

    #[test]
    fn joints_and_pressures_meet_the_published_points() {
        let at = |mv| joints(&pins(mv, 500.0));
        assert_eq!([at(1727.0)[0], at(3296.0)[0], at(4509.0)[0]], [-2500, 0, 2500]);
        assert_eq!([at(867.0)[1], at(2244.0)[1], at(3464.0)[1]], [-2500, 0, 2500]);
        assert_eq!(at(2512.0)[0], -1249, "784 of 1569 mV, cut off");
        let bar = |mv| pumps(&pins(3000.0, mv))[2];
        assert_eq!([bar(400.0), bar(500.0), bar(2500.0), bar(5000.0)], [0, 0, 30_000, 60_000]);
    }

    #[test]
    fn fuel_is_full_at_11_ohm_and_not_clipped() {
        assert_eq!(
            [fuel(187.0)[1], fuel(11.0)[1], fuel(200.0)[1], fuel(0.0)[1]],
            [0, 100, -7, 106]
        );
    }

    #[test]
    fn wheels_2_to_4_reach_the_bus_without_the_quirk_only() {
        let counts = [1, 2, 3, 4, 5, 6];
        assert_eq!(sent_speeds(counts, Quirks::firmware()), [1; 4]);
        assert_eq!(sent_speeds(counts, Quirks::none()), [1, 2, 3, 4]);
    }
}
