//! Which readings are gone by: those of sensors that no ECU calls broken.
//!
//! A frame goes on coming when its sensor is broken, and reads as one of a machine that stands level. The speed is the
//! mean of six wheels', and says only when the brake may close: one of them is no reason to stop.

use xt28_safety::Measured;

use crate::peer::{ATTITUDE_SENSOR, JOINT_SENSOR, POSITION_SENSOR, PRESSURE_SENSOR, Peer};

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

/// Whether loads may be gone by. They are in an observation alone, so that the kernel does not miss them.
pub(crate) const fn trusts_loads(arm_ecu: &Peer) -> bool {
    !arm_ecu.finds_broken(PRESSURE_SENSOR)
}
