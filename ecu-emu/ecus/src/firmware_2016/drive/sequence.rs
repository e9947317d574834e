//! Demand to displacements, displacements to currents (facts 4.4).

use xt28_machine::PerWheel;

use crate::firmware_2016::Quirks;
use crate::firmware_2016::whole::{cut, u16};

/// Up to this demand pumps grow, beyond it motors shrink, per mille.
const PUMPS_FULL_AT: f64 = 333.3;
/// Full displacement, per mille.
pub(super) const FULL: i32 = 1000;
/// Pump current: span and start, mA; less than the least is none, and none is above the most.
const PUMP_MA: [i32; 2] = [410, 195];
const PUMP_LEAST_MA: i32 = 197;
const PUMP_MOST_MA: i32 = 605;
/// Motor current at displacement 0, and the least that is not none, mA.
const MOTOR_EMPTY_MA: i32 = 650;
const MOTOR_LEAST_MA: i32 = 155;

/// Drive states, as the display's byte has them (facts 2.5).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum DriveState {
    /// Front pair alone.
    Overdrive = 0,
    #[default]
    Neutral = 1,
    Forward = 4,
    Reverse = 16,
}

/// Displacements `[pump, motors]` of a circuit for a demand of 0 to 1000 per mille: the speed it
/// asks for is three times the demand, in shares of that at full pumps and full motors.
pub(super) fn displacements(demand: i32) -> [i32; 2] {
    if f64::from(demand) > PUMPS_FULL_AT {
        [FULL, cut(333_333.0 / f64::from(demand))]
    } else {
        [3 * demand, FULL]
    }
}

/// Currents of pumps 1A 1B 2A 2B, mA: B drives forward.
pub(super) fn pumps_ma(state: DriveState, pump: [i32; 2]) -> [i32; 4] {
    let [first, second] = pump.map(pump_ma);
    match state {
        DriveState::Neutral => [0; 4],
        DriveState::Reverse => [first, 0, second, 0],
        DriveState::Forward | DriveState::Overdrive => [0, first, 0, second],
    }
}

fn pump_ma(displacement: i32) -> i32 {
    let [span, start] = PUMP_MA;
    let ma = (displacement * span / 1000 + start).min(PUMP_MOST_MA);
    if ma < PUMP_LEAST_MA { 0 } else { ma }
}

/// Displacements of motors 1 to 6 in a drive state, with what the slip controller takes off.
pub(super) fn motors(
    state: DriveState,
    motor: PerWheel<i32>,
    slip: PerWheel<i32>,
) -> PerWheel<i32> {
    let mut displacement = PerWheel::from_fn(|w| motor[w] - slip[w]);
    match state {
        DriveState::Neutral => displacement = PerWheel::splat(FULL),
        DriveState::Overdrive => displacement.0[2..].fill(0),
        DriveState::Forward | DriveState::Reverse => {}
    }
    displacement
}

/// Current of a motor, mA. Full displacement takes none.
pub(super) fn motor_ma(displacement: i32, quirks: Quirks) -> i32 {
    let ma = MOTOR_EMPTY_MA - displacement / 2;
    let ma = if quirks.motor_current_wraps { cut(u16(ma)) } else { ma };
    let ma = ma.min(MOTOR_EMPTY_MA);
    if ma < MOTOR_LEAST_MA { 0 } else { ma }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wheel_speed_is_linear_in_the_demand() {
        for demand in 1..=1000 {
            let [pump, motor] = displacements(demand).map(f64::from);
            let (got, want) = (pump / motor, 3.0 * f64::from(demand) / 1000.0);
            assert!((got / want - 1.0).abs() < 4e-3, "{demand}: {got}");
        }
        assert_eq!(displacements(333), [999, 1000]);
        assert_eq!(displacements(334), [1000, 998]);
    }

    #[test]
    fn currents_meet_the_published_ends() {
        let pumps = [(0, 0), (4, 0), (5, 197), (500, 400), (1000, 605), (1100, 605)];
        for (displacement, ma) in pumps {
            assert_eq!(pump_ma(displacement), ma, "{displacement}");
        }
        let quirks = Quirks::firmware();
        let motors = [(1000, 0), (992, 0), (991, 155), (500, 400), (0, 650), (-40, 650)];
        for (displacement, ma) in motors {
            assert_eq!(motor_ma(displacement, quirks), ma, "{displacement}");
        }
    }

    /// Facts 4.4: from 1302 on the current wraps, and the motor goes to least displacement.
    #[test]
    fn a_motor_asked_for_too_much_gives_least() {
        assert_eq!([1301, 1302].map(|d| motor_ma(d, Quirks::firmware())), [0, 650]);
        assert_eq!([1301, 1302].map(|d| motor_ma(d, Quirks::none())), [0, 0]);
    }

    #[test]
    fn each_state_drives_its_sides_and_motors() {
        assert_eq!(pumps_ma(DriveState::Forward, [1000, 500]), [0, 605, 0, 400]);
        assert_eq!(pumps_ma(DriveState::Reverse, [1000, 500]), [605, 0, 400, 0]);
        assert_eq!(pumps_ma(DriveState::Neutral, [1000, 500]), [0; 4]);
        let (motor, slip) = (PerWheel::splat(800), PerWheel([1, 2, 3, 4, 5, 6]));
        assert_eq!(motors(DriveState::Forward, motor, slip).0, [799, 798, 797, 796, 795, 794]);
        assert_eq!(motors(DriveState::Overdrive, motor, slip).0, [799, 798, 0, 0, 0, 0]);
        assert_eq!(motors(DriveState::Neutral, motor, slip), PerWheel::splat(FULL));
    }
}
