//! A recorded run as quantities over time, in SI units: what all expectations and pictures read.

use xt28_machine::{Machine, PerWheel};

use crate::{Series, Trouble};

/// What the bus said during one run. Times are seconds from the start of the run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// GNSS antenna, m east and north.
    pub antenna_m: Series<[f64; 2]>,
    /// Velocity and heading of the GNSS receiver.
    pub motion: Series<Motion>,
    /// Strokes, m.
    pub stroke_m: Series<PerWheel<f64>>,
    /// Stroke targets of the gateway, m; `None` holds the arm.
    pub stroke_target_m: Series<PerWheel<Option<f64>>>,
    /// Cylinder loads, N; positive under weight.
    pub cylinder_load_n: Series<PerWheel<f64>>,
    /// Roll and pitch.
    pub attitude: Series<Attitude>,
    /// Front and rear articulation, rad; left > 0.
    pub joint_rad: Series<[f64; 2]>,
    /// Throttle and front joint target of the gateway.
    pub drive_target: Series<DriveCommand>,
    /// Wheel speeds, rad/s; forward > 0. A machine that never says which way its wheels turn has them
    /// without sign.
    pub wheel_speed_rad_s: Series<PerWheel<f64>>,
    /// State of the pendulum-arm ECU.
    pub arm_state: Series<EcuState>,
    /// State of the transmission ECU.
    pub drive_state: Series<EcuState>,
    /// What the pendulum-arm ECU said is wrong.
    pub arm_trouble: Series<Trouble>,
    /// What the transmission ECU said is wrong.
    pub drive_trouble: Series<Trouble>,
    /// Frames of any kind.
    pub frames: u64,
    /// Frames of our database that do not fit it.
    pub faults: Vec<Fault>,
    /// When the last frame was on the bus, s.
    pub end_s: f64,
}

/// Velocity and heading as the GNSS receiver gives them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// East, north, up, m/s.
    pub velocity_m_s: [f64; 3],
    /// Counter-clockwise from east, rad, -pi to pi.
    pub heading_rad: f64,
}

/// Attitude of the front frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Attitude {
    /// Right side high > 0, rad.
    pub roll_rad: f64,
    /// Nose up > 0, rad.
    pub pitch_rad: f64,
}

/// What the gateway asks of the transmission ECU.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DriveCommand {
    /// -1 full reverse to 1 full ahead.
    pub throttle: f64,
    /// Front joint target, rad; left > 0.
    pub front_joint_rad: f64,
    /// The ECU may act on it.
    pub enable: bool,
}

/// State machine of an ECU, as its status frame says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EcuState {
    /// Starting.
    Init,
    /// Waiting for commands.
    Standby,
    /// Acting on commands.
    Active,
    /// Commands failed to come; outputs safe.
    SafeStop,
    /// Refusing to act.
    Fault,
}

/// A frame that does not fit our database.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// When, s.
    pub at_s: f64,
    /// The frame and what is wrong with it.
    pub what: String,
}

/// The machine's place: middle of the front axle, and heading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// East, m.
    pub x_m: f64,
    /// North, m.
    pub y_m: f64,
    /// Counter-clockwise from east, rad.
    pub heading_rad: f64,
}

impl Pose {
    /// The pose of the front axle when the antenna is at `antenna_m`. The antenna leans with the
    /// frame it stands on: right side high takes it to the left, nose up takes it back (facts 1.1).
    #[must_use]
    pub fn from_antenna(
        machine: &Machine,
        antenna_m: [f64; 2],
        heading_rad: f64,
        lean: Attitude,
    ) -> Self {
        let [ahead_m, left_m, up_m] = machine.sensors.gnss_antenna_m;
        let ahead_m = ahead_m - up_m * lean.pitch_rad.sin();
        let left_m = left_m + up_m * lean.roll_rad.sin();
        let (sin, cos) = heading_rad.sin_cos();
        Self {
            x_m: antenna_m[0] - (cos * ahead_m - sin * left_m),
            y_m: antenna_m[1] - (sin * ahead_m + cos * left_m),
            heading_rad,
        }
    }
}

/// An angle brought to -pi..=pi.
#[must_use]
pub fn wrapped_rad(angle_rad: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    angle_rad - turn * (angle_rad / turn).round()
}

impl Trace {
    /// Where the machine was at `at_s`, from the newest fix then; `None` before the first.
    #[must_use]
    pub fn pose_at(&self, machine: &Machine, at_s: f64) -> Option<Pose> {
        let antenna = self.antenna_m.known_at(at_s)?;
        let motion = self.motion.known_at(at_s)?;
        let lean = self.attitude.known_at(at_s).map_or_else(Attitude::default, |a| a.value);
        Some(Pose::from_antenna(machine, antenna.value, motion.value.heading_rad, lean))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn the_antenna_stands_behind_the_axle_and_leans_with_the_frame() {
        let pose = |lean| Pose::from_antenna(&Machine::xt28(), [10.0, 4.7], FRAC_PI_2, lean);
        let level = pose(Attitude::default());
        assert!((level.x_m - 10.0).abs() < 1e-12 && (level.y_m - 5.0).abs() < 1e-12, "{level:?}");
        // 3.1 m up, heading north: the left is west.
        let right_high = pose(Attitude { roll_rad: 0.1, pitch_rad: 0.0 });
        assert!((right_high.x_m - 10.3095).abs() < 1e-4, "{right_high:?}");
        let nose_up = pose(Attitude { roll_rad: 0.0, pitch_rad: 0.1 });
        assert!((nose_up.y_m - 5.3095).abs() < 1e-4, "{nose_up:?}");
    }

    #[test]
    fn angles_wrap_into_half_a_turn_each_way() {
        for (angle, wrapped) in
            [(0.1, 0.1), (PI + 0.1, 0.1 - PI), (-PI - 0.1, PI - 0.1), (7.0 * PI, PI)]
        {
            assert!((wrapped_rad(angle).abs() - wrapped.abs()).abs() < 1e-9, "{angle}");
        }
    }
}
