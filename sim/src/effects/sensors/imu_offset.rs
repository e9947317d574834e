//! `imu-offset`: the inertial unit is not mounted level.

use crate::effects::{Block, Effect, Parameter, Slot};

/// How the unit is turned against the front frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImuOffset {
    /// Roll that it reads on a level machine, rad; right side high > 0.
    pub roll_rad: f64,
    /// Pitch that it reads on a level machine, rad; nose up > 0.
    pub pitch_rad: f64,
}

impl ImuOffset {
    /// A vector of the front frame as the unit's axes have it: x forward, y left, z up.
    #[must_use]
    pub fn into_unit(&self, v: [f64; 3]) -> [f64; 3] {
        if *self == Self::default() {
            return v;
        }
        let [x, y, z] = v;
        let (sin, cos) = self.pitch_rad.sin_cos();
        let (x, z) = (cos * x + sin * z, cos * z - sin * x);
        let (sin, cos) = self.roll_rad.sin_cos();
        [x, cos * y - sin * z, cos * z + sin * y]
    }
}

/// A unit screwed to a bracket: the machine then levels to the bracket.
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "imu-offset",
    block: Block::Sensor,
    meaning: "the inertial unit is not mounted level",
    source: "assumed: brackets are level to a quarter of a degree",
    parameters: &[
        Parameter {
            name: "roll_rad",
            neutral: 0.0,
            tolerance: 0.004,
            range: [-0.3, 0.3],
            acts_alone: true,
            slot: Slot::Whole(|effects| &mut effects.sensors.imu_offset.roll_rad),
        },
        Parameter {
            name: "pitch_rad",
            neutral: 0.0,
            tolerance: 0.004,
            range: [-0.3, 0.3],
            acts_alone: true,
            slot: Slot::Whole(|effects| &mut effects.sensors.imu_offset.pitch_rad),
        },
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn level_gravity_shows_as_the_angles_of_the_mount() {
        let offset = ImuOffset { roll_rad: 0.02, pitch_rad: -0.03 };
        let [x, y, z] = offset.into_unit([0.0, 0.0, 9.81]);
        // Nose up puts gravity's reaction forward; right side high puts it to the right.
        assert!((x.atan2(z.hypot(y)) - -0.03).abs() < 1e-12);
        assert!((-y.atan2(z) - 0.02).abs() < 1e-12);
    }
}
