//! What a machine's stroke and joint sensors span, as fitted to it and as its ECUs are told.
//!
//! A sensor reaches a little less far than its cylinder in the nominal machine (facts 3.2), and just as far
//! as its joint (facts 4.6). Assumed of any other machine: sensors in the same proportion.

use xt28_machine::Machine;

use super::sensor::{SPAN_MV, joint_mv, joint_rad, linear, linear_mv};

/// Stroke over the span of a position input, m (facts 3.2), and the stroke of that machine.
const STROKE_SPAN_M: f64 = 0.485;
const STROKE_MAX_M: f64 = 0.50;
/// Front joint at its largest angle to the right, straight, to the left, mV (facts 4.6).
const JOINT_FRONT_MV: [f64; 3] = [1727.0, 3296.0, 4509.0];
/// Rear joint, likewise.
const JOINT_REAR_MV: [f64; 3] = [867.0, 2244.0, 3464.0];
/// Where the joint sensors saturate, deg (facts 4.6).
const JOINT_MAX_DEG: f64 = 25.0;

/// Spans of the sensors of strokes and joints. The default is the firmware's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibration {
    stroke_span_m: f64,
    joint_max_deg: f64,
}

impl Default for Calibration {
    fn default() -> Self {
        Self { stroke_span_m: STROKE_SPAN_M, joint_max_deg: JOINT_MAX_DEG }
    }
}

impl Calibration {
    /// That of sensors that fit this machine.
    #[must_use]
    pub fn of(machine: &Machine) -> Self {
        Self {
            stroke_span_m: STROKE_SPAN_M * (machine.arms.stroke_max_m / STROKE_MAX_M),
            joint_max_deg: machine.articulation.angle_max_deg,
        }
    }

    /// Voltage of a cylinder's position sensor at `stroke_m`, mV.
    #[must_use]
    pub fn stroke_mv(&self, stroke_m: f64) -> f64 {
        linear_mv(stroke_m, self.stroke_span_m)
    }

    /// Stroke at `mv`, m, at least 0. The firmware would wrap a negative one to 65 m; ours stops at 0.
    #[must_use]
    pub fn stroke_m(&self, mv: f64) -> f64 {
        linear(mv, self.stroke_span_m)
    }

    /// Voltage of a position sensor per stroke, mV/m.
    pub(crate) fn stroke_mv_per_m(&self) -> f64 {
        SPAN_MV / self.stroke_span_m
    }

    /// Voltage of the front joint's sensor at `rad`, left > 0, mV.
    #[must_use]
    pub fn joint_front_mv(&self, rad: f64) -> f64 {
        joint_mv(rad, self.joint_max_deg, JOINT_FRONT_MV)
    }

    /// Front joint at `mv`, rad, left > 0, clamped to the joint's largest angle.
    #[must_use]
    pub fn joint_front_rad(&self, mv: f64) -> f64 {
        joint_rad(mv, self.joint_max_deg, JOINT_FRONT_MV)
    }

    /// Voltage of the rear joint's sensor at `rad`, left > 0, mV.
    #[must_use]
    pub fn joint_rear_mv(&self, rad: f64) -> f64 {
        joint_mv(rad, self.joint_max_deg, JOINT_REAR_MV)
    }

    /// Rear joint at `mv`, rad, left > 0, clamped to the joint's largest angle.
    #[must_use]
    pub fn joint_rear_rad(&self, mv: f64) -> f64 {
        joint_rad(mv, self.joint_max_deg, JOINT_REAR_MV)
    }

    /// Steepest of the joint sensors: front, to the right, mV a degree.
    pub(crate) fn joint_mv_per_deg(&self) -> f64 {
        let [right, straight, _] = JOINT_FRONT_MV;
        (straight - right) / self.joint_max_deg
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nominal_machine_has_the_firmwares_sensors() {
        assert_eq!(Calibration::of(&Machine::xt28()), Calibration::default());
    }

    #[test]
    fn a_longer_cylinder_and_a_wider_joint_read_to_their_ends() {
        let mut machine = Machine::xt28();
        (machine.arms.stroke_max_m, machine.articulation.angle_max_deg) = (0.8, 40.0);
        let sensors = Calibration::of(&machine);
        for share in [0.0, 0.3, 0.7, 1.0] {
            let stroke_m = share * machine.arms.stroke_max_m;
            assert!((sensors.stroke_m(sensors.stroke_mv(stroke_m)) - stroke_m).abs() < 1e-9);
            for side in [-1.0, 1.0] {
                let rad = side * share * machine.articulation.angle_max_deg.to_radians();
                assert!((sensors.joint_front_rad(sensors.joint_front_mv(rad)) - rad).abs() < 1e-9);
                assert!((sensors.joint_rear_rad(sensors.joint_rear_mv(rad)) - rad).abs() < 1e-9);
            }
        }
    }
}
