//! The turning of a wheel about its axle: a number beside the engine's bodies, not a body among them.
//!
//! A wheel is a body of revolution. What turns it about its axle turns nothing else, and in all else it moves as
//! a part of its arm. So the engine has arms with wheels on them that do not turn, and the turning is kept
//! here, against the world and not against the arm: 14 freedoms for the engine instead of 20, whose step
//! costs their square for each of nine bodies instead of fifteen.

use rapier3d::prelude::{Real, Vector};

/// One wheel's turning.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spin {
    inertia_kg_m2: f64,
    /// About the axle, against the world, rad/s; forward > 0.
    rate_rad_s: f64,
}

impl Spin {
    /// A wheel at rest with this inertia about its axle.
    pub(super) const fn new(inertia_kg_m2: f64) -> Self {
        Self { inertia_kg_m2, rate_rad_s: 0.0 }
    }

    /// Its rate against an arm that turns at `arm_rad_s` about the axle, rad/s.
    pub(super) fn against(self, arm_rad_s: f64) -> f64 {
        self.rate_rad_s - arm_rad_s
    }

    /// Lets it turn at `rate_rad_s` against an arm that turns at `arm_rad_s` about the axle.
    pub(super) fn set_against(&mut self, rate_rad_s: f64, arm_rad_s: f64) {
        self.rate_rad_s = rate_rad_s + arm_rad_s;
    }

    /// Turns it over `dt_s` s by `turning_nm`, held to its arm, which turns at `arm_rad_s` about the axle, by at
    /// most `hold_nm`. Gives what held it, Nm; the arm takes the opposite.
    pub(super) fn step(&mut self, turning_nm: f64, hold_nm: f64, arm_rad_s: f64, dt_s: f64) -> f64 {
        let per_nm = dt_s / self.inertia_kg_m2;
        let free_rad_s = self.rate_rad_s + per_nm * turning_nm;
        let held_nm = ((arm_rad_s - free_rad_s) / per_nm).clamp(-hold_nm, hold_nm);
        self.rate_rad_s = free_rad_s + per_nm * held_nm;
        held_nm
    }

    /// What it takes to turn the axle of the spinning wheel along with an arm that turns at `rate`, Nm, in
    /// the world; the arm feels the opposite.
    #[allow(clippy::cast_possible_truncation)]
    pub(super) fn gyroscopic_nm(self, axle: Vector, rate: Vector) -> Vector {
        rate.cross(axle) * (self.inertia_kg_m2 * self.rate_rad_s) as Real
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_brake_holds_a_wheel_to_its_arm_up_to_its_torque() {
        let mut spin = Spin::new(100.0);
        for (rate_rad_s, turning_nm, held_nm) in
            [(0.0, 400.0, -400.0), (0.0, 900.0, -500.0), (0.001, 0.0, -20.0)]
        {
            spin.set_against(rate_rad_s, 0.0);
            let held = spin.step(turning_nm, 500.0, 0.0, 0.005);
            assert!((held - held_nm).abs() < 1e-9, "{held}");
        }
        assert!(spin.against(0.0).abs() < 1e-15);
    }

    #[test]
    fn a_wheel_that_nothing_turns_keeps_its_rate_while_its_arm_swings() {
        let mut spin = Spin::new(100.0);
        spin.set_against(2.0, 0.5);
        assert!(spin.step(0.0, 0.0, 0.5, 0.005).abs() < 1e-15);
        assert!((spin.against(-0.3) - 2.8).abs() < 1e-15);
    }

    /// A wheel that rolls forward (+y to its left) leans out of the turn: turned left, its top goes right.
    #[test]
    fn a_wheel_turned_left_leans_right() {
        let mut spin = Spin::new(100.0);
        spin.set_against(3.0, 0.0);
        let on_arm = -spin.gyroscopic_nm(Vector::Y, Vector::Z * 0.5);
        assert!((on_arm.x - 150.0).abs() < 1e-3 && on_arm.y == 0.0 && on_arm.z == 0.0, "{on_arm}");
    }
}
