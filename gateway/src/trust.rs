//! Which readings are gone by: those of sensors that no ECU calls broken.
//!
//! A frame goes on coming when its sensor is broken, and reads as one of a machine that stands level. Of six wheel
//! speeds one that is broken is no reason to stop, and the ECU does not say which: the machine's speed is then the
//! median.

use xt28_machine::PerWheel;
use xt28_safety::Measured;

use crate::peer::{
    ATTITUDE_SENSOR, JOINT_SENSOR, POSITION_SENSOR, PRESSURE_SENSOR, Peer, WHEEL_SPEED_SENSOR,
};

/// What is measured, less what an ECU says is none of it: NaN, which the safety kernel lets nothing pass with.
pub(crate) fn trusted(said: Measured, arm_ecu: &Peer, drive_ecu: &Peer) -> Measured {
    let mut measured = said;
    if arm_ecu.finds_broken(POSITION_SENSOR) {
        measured.stroke_m = Measured::UNKNOWN.stroke_m;
    }
    if arm_ecu.finds_broken(ATTITUDE_SENSOR) {
        (measured.roll_rad, measured.pitch_rad) = (f64::NAN, f64::NAN);
    }
    if drive_ecu.finds_broken(JOINT_SENSOR) {
        measured.front_angle_rad = f64::NAN;
    }
    measured
}

/// How fast the wheels turn together, rad/s.
pub(crate) fn turning_rad_s(wheel_rad_s: &PerWheel<f64>, drive_ecu: &Peer) -> f64 {
    if !drive_ecu.finds_broken(WHEEL_SPEED_SENSOR) {
        return wheel_rad_s.mean();
    }
    let mut sorted = wheel_rad_s.0;
    sorted.sort_by(f64::total_cmp);
    0.5 * (sorted[2] + sorted[3])
}

/// Whether loads may be gone by. They are in an observation alone, so that the kernel does not miss them.
pub(crate) const fn trusts_loads(arm_ecu: &Peer) -> bool {
    !arm_ecu.finds_broken(PRESSURE_SENSOR)
}

#[cfg(test)]
mod tests {
    use xt28_dbc::messages::{DriveStatus, DriveStatusReason, DriveStatusState};
    use xt28_machine::SimTime;

    use super::*;

    #[test]
    fn a_wheel_speed_sensor_that_is_called_broken_slows_no_machine() {
        let wheels = PerWheel([0.0, 1.0, 1.1, 1.0, 0.9, 1.0]);
        let mut peer = Peer::default();
        assert!((turning_rad_s(&wheels, &peer) - 5.0 / 6.0).abs() < 1e-12);
        let status = DriveStatus {
            state: DriveStatusState::Active,
            faults: 1 << WHEEL_SPEED_SENSOR,
            accepted: 0,
            reason: DriveStatusReason::None,
            brake: false,
            speed_m_s: 0.0,
            counter: 0,
        };
        peer.on_status(SimTime::ZERO, Ok(status));
        assert_eq!(turning_rad_s(&wheels, &peer), 1.0);
    }
}
