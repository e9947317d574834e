//! Where the machine is: the pose of the front axle, from antenna position, heading and attitude.

use core::f64::consts::{PI, TAU};

use xt28_ubx::Enu;

/// A planar pose in the local frame: x east, y north, heading counter-clockwise from east.
///
/// The reference point of the machine is the middle of the front axle, projected to the ground
/// plane: x = 0 of the machine file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// East, m.
    pub east_m: f64,
    /// North, m.
    pub north_m: f64,
    /// Counter-clockwise from east, rad, -π to π.
    pub heading_rad: f64,
}

/// Roll and pitch of the front frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Attitude {
    /// Right side high > 0, rad (facts 1.1).
    pub roll_rad: f64,
    /// Nose up > 0, rad (facts 1.1).
    pub pitch_rad: f64,
}

impl Pose {
    /// The front axle under an antenna at `antenna`, mounted at `mount_m` (x forward, y left, z up
    /// from the reference point).
    ///
    /// The antenna sits 3 m up, so a roll of 5 degrees alone moves it by 0.27 m: the lever arm is
    /// turned by attitude and heading, not by heading alone.
    #[must_use]
    pub fn under_antenna(
        antenna: Enu,
        mount_m: [f64; 3],
        heading_rad: f64,
        attitude: Attitude,
    ) -> Self {
        let [ahead_m, left_m] = lean(mount_m, attitude);
        let (sin, cos) = heading_rad.sin_cos();
        Self {
            east_m: antenna.east_m - (cos * ahead_m - sin * left_m),
            north_m: antenna.north_m - (sin * ahead_m + cos * left_m),
            heading_rad,
        }
    }

    /// `other` seen from here: metres ahead, metres to the left, and the turn to its heading, rad.
    #[must_use]
    pub fn to_local(&self, other: &Self) -> [f64; 3] {
        let (sin, cos) = self.heading_rad.sin_cos();
        let (de, dn) = (other.east_m - self.east_m, other.north_m - self.north_m);
        [cos * de + sin * dn, cos * dn - sin * de, wrap(other.heading_rad - self.heading_rad)]
    }
}

/// A mount on a leaning frame, seen from above: metres ahead and metres to the left.
/// Turned about x by minus roll (right side high leans the top to the left), then about y by minus
/// pitch (nose up leans the top back).
fn lean([x, y, z]: [f64; 3], attitude: Attitude) -> [f64; 2] {
    let (sin_roll, cos_roll) = attitude.roll_rad.sin_cos();
    let (sin_pitch, cos_pitch) = attitude.pitch_rad.sin_cos();
    let left = y * cos_roll + z * sin_roll;
    let up = z * cos_roll - y * sin_roll;
    [x * cos_pitch - up * sin_pitch, left]
}

/// An angle brought to -π..π, rad.
#[must_use]
pub(crate) fn wrap(angle_rad: f64) -> f64 {
    (angle_rad + PI).rem_euclid(TAU) - PI
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOUNT_M: [f64; 3] = [-0.30, 0.0, 3.1];

    #[test]
    fn a_level_machine_has_its_axle_ahead_of_the_antenna() {
        let antenna = Enu { east_m: -0.30, north_m: 0.0, up_m: 3.1 };
        let pose = Pose::under_antenna(antenna, MOUNT_M, 0.0, Attitude::default());
        assert!(pose.east_m.abs() < 1e-12 && pose.north_m.abs() < 1e-12);
        let antenna = Enu { east_m: 0.0, north_m: 9.7, up_m: 3.1 };
        let pose = Pose::under_antenna(antenna, MOUNT_M, PI / 2.0, Attitude::default());
        assert!((pose.north_m - 10.0).abs() < 1e-12 && pose.east_m.abs() < 1e-12);
    }

    #[test]
    fn lean_is_taken_out() {
        // Right side high by 5 degrees: the antenna leans 0.27 m to the left (north when heading east).
        let attitude = Attitude { roll_rad: 5_f64.to_radians(), pitch_rad: 0.0 };
        let north_m = 3.1 * attitude.roll_rad.sin();
        let antenna = Enu { east_m: -0.30, north_m, up_m: 3.1 };
        let pose = Pose::under_antenna(antenna, MOUNT_M, 0.0, attitude);
        assert!(pose.north_m.abs() < 1e-12, "{pose:?}");
        // Nose up leans it back.
        let attitude = Attitude { roll_rad: 0.0, pitch_rad: 0.1 };
        let antenna = Enu { east_m: -0.30 * 0.1_f64.cos() - 3.1 * 0.1_f64.sin(), ..Enu::default() };
        let pose = Pose::under_antenna(antenna, MOUNT_M, 0.0, attitude);
        assert!(pose.east_m.abs() < 1e-12, "{pose:?}");
    }

    #[test]
    fn another_pose_seen_from_here() {
        let here = Pose { east_m: 1.0, north_m: 2.0, heading_rad: PI / 2.0 };
        let there = Pose { east_m: 0.0, north_m: 5.0, heading_rad: -PI };
        let [ahead, left, turn] = here.to_local(&there);
        assert!((ahead - 3.0).abs() < 1e-12 && (left - 1.0).abs() < 1e-12);
        assert!((turn - PI / 2.0).abs() < 1e-12);
    }
}
