//! How the ground under a run leans: what is known of it, and what is believed beside.

use xt28_machine::Machine;
use xt28_sim::{Effects, Terrain};

use crate::diagnosis::blend::Blend;
use crate::diagnosis::signals::{DT_S, Signals};

/// A plane that wheels roll on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Grade {
    /// Rise per metre to the east and to the north.
    rise: [f64; 2],
}

impl Grade {
    /// What is known of the ground of a run; `None` where it is no plane, or one that leans and no receiver
    /// says which way the machine heads on it.
    pub(super) fn known(s: &Signals) -> Option<Self> {
        match &s.terrain {
            Terrain::Flat => Some(Self::default()),
            Terrain::Plane(_) if s.heads_unknown_on_slope() => None,
            Terrain::Plane(plane) => Some(Self { rise: plane.rise }),
            Terrain::Grid(_) => None,
        }
    }

    /// What is known with the slope that `effects` believe in on top.
    pub(super) fn believed(s: &Signals, effects: &Effects) -> Option<Self> {
        Some(Self::known(s)?.with(effects))
    }

    /// The same with the slope that `effects` believe in on top.
    pub(super) fn with(self, effects: &Effects) -> Self {
        let ([east, north], slope) = (self.rise, &effects.slope);
        Self { rise: [east + slope.grade_x_rad.tan(), north + slope.grade_y_rad.tan()] }
    }

    /// Rise ahead and to the left over a metre of the map, for who heads along a cosine and sine.
    fn rises(&self, [cos, sin]: [f64; 2]) -> [f64; 2] {
        let [east, north] = self.rise;
        [east * cos + north * sin, north * cos - east * sin]
    }

    /// How far the nose and the left side of a machine are up, rad: turned about its left axis first, about its
    /// forward one then, as an inertial unit counts. `headings` are cosine and sine for roll and for pitch.
    pub(super) fn attitude_rad(&self, headings: [[f64; 2]; 2]) -> [f64; 2] {
        let [[_, left], [ahead, _]] = headings.map(|heading| self.rises(heading));
        [ahead.atan(), (left / 1.0_f64.hypot(ahead)).atan()]
    }

    /// Sine of the angle that it climbs along `heading_rad`.
    pub(super) fn climb(&self, heading_rad: f64) -> f64 {
        let [ahead, _] = self.rises(along(heading_rad));
        ahead / 1.0_f64.hypot(ahead)
    }

    /// Way on the map over way on the ground along `heading_rad`.
    pub(super) fn on_map(&self, heading_rad: f64) -> f64 {
        let [ahead, _] = self.rises(along(heading_rad));
        1.0 / 1.0_f64.hypot(ahead)
    }
}

impl Blend for Grade {
    fn toward(self, other: &Self, share: f64) -> Self {
        Self { rise: [0, 1].map(|k| self.rise[k].toward(&other.rise[k], share)) }
    }
}

/// Sine of the grade that the machine climbs at sample `i`: each frame climbs along its own heading, by
/// its share of the weight.
#[allow(clippy::cast_precision_loss)]
pub(super) fn climbs(
    signals: &Signals,
    machine: &Machine,
    effects: &Effects,
    ground: Grade,
    i: usize,
) -> f64 {
    let front = signals.heading_near(i as f64 * DT_S).unwrap_or_default();
    let middle = front - signals.joint_rad[0][i];
    let rear = middle - signals.joint_rad[1][i];
    let (m, payload_kg) = (&machine.masses, effects.masses.payload.mass_kg);
    let axle_kg = 2.0 * (m.arm_kg + m.wheel_kg);
    let frames = [
        (front, m.front_frame_kg + axle_kg),
        (middle, m.middle_frame_kg + axle_kg),
        (rear, m.rear_frame_kg + axle_kg + payload_kg),
    ];
    let along = |(heading, kg): (f64, f64)| kg * ground.climb(heading);
    frames.map(along).iter().sum::<f64>() / (machine.mass_kg() + payload_kg)
}

fn along(heading_rad: f64) -> [f64; 2] {
    let (sin, cos) = heading_rad.sin_cos();
    [cos, sin]
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_2;

    use xt28_sim::terrain::Plane;

    use super::super::still::still;
    use super::*;

    #[test]
    fn heading_turns_a_slope_from_nose_up_to_right_side_up() {
        let grade = Grade { rise: [0.1, 0.0] };
        let [nose_rad, left_rad] = grade.attitude_rad([along(0.0); 2]);
        assert!((nose_rad - 0.1_f64.atan()).abs() < 1e-12 && left_rad == 0.0);
        let [nose_rad, left_rad] = grade.attitude_rad([along(FRAC_PI_2); 2]);
        assert!(nose_rad.abs() < 1e-12 && (left_rad + 0.1_f64.atan()).abs() < 1e-12);
        assert!((grade.climb(FRAC_PI_2 * 2.0) + 0.1_f64.atan().sin()).abs() < 1e-12);
        assert!((grade.on_map(0.0) - 0.1_f64.atan().cos()).abs() < 1e-12);
    }

    #[test]
    fn a_slope_without_a_heading_says_nothing() {
        let mut signals = still(2);
        signals.headings.clear();
        assert!(Grade::known(&signals).is_some());
        let plane = Plane { height_m: 0.0, rise: [0.1, 0.0] };
        signals.terrain = Terrain::Plane(plane);
        assert_eq!(Grade::known(&signals), None);
        signals.headings = vec![[0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        assert_eq!(Grade::known(&signals), Some(Grade { rise: [0.1, 0.0] }));
    }

    /// Axes turned by both angles in turn stand square on the plane.
    #[test]
    fn both_angles_together_are_those_of_the_plane() {
        let grade = Grade { rise: [0.2, -0.15] };
        for heading_rad in [0.3, 1.9, -2.4_f64] {
            let [nose_rad, left_rad] = grade.attitude_rad([along(heading_rad); 2]);
            let (sin, cos) = heading_rad.sin_cos();
            // Height of the axes' ends: forward, then left after the nose is up.
            let forward = [cos * nose_rad.cos(), sin * nose_rad.cos(), nose_rad.sin()];
            let flat = [-sin, cos, 0.0];
            let up = [-cos * nose_rad.sin(), -sin * nose_rad.sin(), nose_rad.cos()];
            let left: [f64; 3] =
                core::array::from_fn(|i| flat[i] * left_rad.cos() + up[i] * left_rad.sin());
            for axis in [forward, left] {
                let rises = grade.rise[0] * axis[0] + grade.rise[1] * axis[1];
                assert!((axis[2] - rises).abs() < 1e-12, "{heading_rad}: {axis:?}");
            }
        }
    }
}
