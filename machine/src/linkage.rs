//! The planar linkage of a pendulum arm: cylinder stroke to wheel position and lever ratio (facts 1.4).

/// Constants of the linkage; the same for all six arms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linkage {
    /// Pivot to the frame-side cylinder eye, m.
    pub pivot_to_cylinder_eye_m: f64,
    /// Pivot to the rod eye on the arm, m.
    pub pivot_to_rod_eye_m: f64,
    /// Pivot to the wheel centre, m.
    pub pivot_to_wheel_m: f64,
    /// Length of the fully retracted cylinder, eye to eye, m.
    pub closed_length_m: f64,
    /// Upward vertical to the cylinder eye, rad.
    pub angle_frame_rad: f64,
    /// Rod-eye line to wheel line, rad.
    pub angle_arm_rad: f64,
}

/// Where an arm is at one stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmPose {
    /// Upward vertical to the wheel line, rad; grows with the stroke.
    pub angle_rad: f64,
    /// Wheel centre below the pivot, m; grows with the stroke.
    pub drop_m: f64,
    /// Wheel centre from the pivot, horizontally, m; always positive.
    pub reach_m: f64,
    /// Cylinder length per arm angle, m/rad: the lever arm of the cylinder force about the pivot.
    pub lever_m: f64,
    /// Vertical wheel force per cylinder force (k of facts 1.4).
    pub force_ratio: f64,
}

impl Linkage {
    /// The arm at stroke `stroke_m`. Defined for any stroke whose cylinder still closes the
    /// triangle; beyond it the pose of the nearest such stroke is returned, so it never is NaN for
    /// finite input.
    #[must_use]
    pub fn at_stroke(&self, stroke_m: f64) -> ArmPose {
        let (b, r) = (self.pivot_to_cylinder_eye_m, self.pivot_to_rod_eye_m);
        let length_m = self.closed_length_m + stroke_m;
        let cos_alpha = (b * b + r * r - length_m * length_m) / (2.0 * b * r);
        let alpha = cos_alpha.clamp(-1.0, 1.0).acos();
        self.at_angle(self.angle_frame_rad + alpha + self.angle_arm_rad)
    }

    /// The arm at wheel-line angle `angle_rad` from the upward vertical.
    #[must_use]
    pub fn at_angle(&self, angle_rad: f64) -> ArmPose {
        let l = self.pivot_to_wheel_m;
        let lever_m = self.lever_m(angle_rad);
        ArmPose {
            angle_rad,
            drop_m: -l * angle_rad.cos(),
            reach_m: l * angle_rad.sin(),
            lever_m,
            force_ratio: lever_m / (l * angle_rad.sin()),
        }
    }

    /// Stroke at wheel-line angle `angle_rad`, m.
    #[must_use]
    pub fn stroke_m(&self, angle_rad: f64) -> f64 {
        self.length_m(angle_rad) - self.closed_length_m
    }

    /// d(cylinder length)/d(arm angle) at `angle_rad`, m/rad: b r sin(alpha) / c.
    #[must_use]
    pub fn lever_m(&self, angle_rad: f64) -> f64 {
        let alpha = angle_rad - self.angle_frame_rad - self.angle_arm_rad;
        self.pivot_to_cylinder_eye_m * self.pivot_to_rod_eye_m * alpha.sin()
            / self.length_m(angle_rad)
    }

    /// The same linkage with another closed length, as the firmware's force code has it (facts 1.4).
    #[must_use]
    pub const fn with_closed_length(self, closed_length_m: f64) -> Self {
        Self { closed_length_m, ..self }
    }

    fn length_m(&self, angle_rad: f64) -> f64 {
        let (b, r) = (self.pivot_to_cylinder_eye_m, self.pivot_to_rod_eye_m);
        let alpha = angle_rad - self.angle_frame_rad - self.angle_arm_rad;
        (b * b + r * r - 2.0 * b * r * alpha.cos()).max(0.0).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use crate::Machine;

    /// Rows of the table in facts 1.4: stroke mm, h m, x m, k.
    const FACTS: [[f64; 4]; 5] = [
        [0.0, -0.3255, 0.9540, 0.4249],
        [100.0, -0.1031, 1.0027, 0.4695],
        [250.0, 0.2040, 0.9871, 0.5056],
        [350.0, 0.3974, 0.9263, 0.5294],
        [500.0, 0.6676, 0.7553, 0.5905],
    ];

    #[test]
    fn matches_the_published_table() {
        let linkage = Machine::xt28().linkage();
        for [stroke_mm, drop_m, reach_m, ratio] in FACTS {
            let pose = linkage.at_stroke(stroke_mm / 1000.0);
            assert!((pose.drop_m - drop_m).abs() < 6e-5, "{stroke_mm}: {pose:?}");
            assert!((pose.reach_m - reach_m).abs() < 6e-5, "{stroke_mm}: {pose:?}");
            assert!((pose.force_ratio - ratio).abs() < 6e-5, "{stroke_mm}: {pose:?}");
        }
    }

    #[test]
    fn stroke_and_angle_are_inverse_and_virtual_work_holds() {
        let linkage = Machine::xt28().linkage();
        for step in 0..=500 {
            let stroke_m = f64::from(step) / 1000.0;
            let pose = linkage.at_stroke(stroke_m);
            assert!((linkage.stroke_m(pose.angle_rad) - stroke_m).abs() < 1e-12);
            let d = 1e-6;
            let slope = (linkage.at_stroke(stroke_m + d).drop_m
                - linkage.at_stroke(stroke_m - d).drop_m)
                / (2.0 * d);
            assert!((slope * pose.force_ratio - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn the_force_code_reads_low_with_its_shorter_cylinder() {
        let linkage = Machine::xt28().linkage();
        let firmware = linkage.with_closed_length(0.82);
        let ratio = firmware.at_stroke(0.25).force_ratio / linkage.at_stroke(0.25).force_ratio;
        assert!((ratio - 0.4991 / 0.5056).abs() < 2e-4, "{ratio}");
    }
}
