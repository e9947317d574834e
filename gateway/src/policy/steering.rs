//! From a wanted path curvature to a front joint target.

use xt28_machine::Machine;

/// How fast the joint is to follow, 1/s (assumed: slow enough that the longest delay of the paper,
/// 0.5 s, causes no swing).
const FOLLOW_RATE_S: f64 = 0.7;

/// The articulated steering, inverted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steering {
    /// Front axle to front joint, m.
    ahead_m: f64,
    /// Front joint to middle axle, m.
    behind_m: f64,
    angle_max_rad: f64,
    /// Target beyond the wanted angle, per angle missing.
    lead: f64,
}

impl Steering {
    pub(super) fn new(machine: &Machine) -> Self {
        let a = &machine.articulation;
        // Joint rate per angle error under the ECU's own proportional law, 1/s.
        let own_rate_s = a.kp_per_deg * a.rate_max_deg_s;
        Self {
            ahead_m: machine.wheels.axle_x_m[0] - a.front_joint_x_m,
            behind_m: a.front_joint_x_m - machine.wheels.axle_x_m[1],
            angle_max_rad: a.angle_max_deg.to_radians(),
            // The ECU closes its loop in some 4 s, 3 m of road at cruise. Leading the target makes
            // the joint follow in half of that; the ECU's own law and limits stay in force.
            lead: (FOLLOW_RATE_S / own_rate_s).clamp(1.0, 6.0),
        }
    }

    /// The joint angle at which the front axle runs on a circle of `curvature_per_m`, rad.
    ///
    /// Without sideslip of front and middle axle, the front frame turns at
    /// v sin θ / (a cos θ + b) when θ stands still (a, b from joint to axles); solved for θ.
    pub(super) fn angle_rad(&self, curvature_per_m: f64) -> f64 {
        let (ka, kb) = (curvature_per_m * self.ahead_m, curvature_per_m * self.behind_m);
        let angle = (kb / ka.hypot(1.0)).clamp(-1.0, 1.0).asin() + ka.atan();
        angle.clamp(-self.angle_max_rad, self.angle_max_rad)
    }

    /// The tightest curvature the joint allows, 1/m.
    pub(super) fn curvature_max_per_m(&self) -> f64 {
        let (sin, cos) = self.angle_max_rad.sin_cos();
        sin / (self.ahead_m * cos + self.behind_m)
    }

    /// The joint target that brings the joint from `measured_rad` to `wanted_rad` in good time.
    pub(super) fn target_rad(&self, wanted_rad: f64, measured_rad: f64) -> f64 {
        let target = measured_rad + self.lead * (wanted_rad - measured_rad);
        target.clamp(-self.angle_max_rad, self.angle_max_rad)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angle_and_curvature_are_each_others_inverse() {
        let steering = Steering::new(&Machine::xt28());
        assert!((steering.curvature_max_per_m() - 0.1198).abs() < 1e-4);
        for angle_deg in [-24.0_f64, -3.0, 0.0, 10.0, 24.0] {
            let angle = angle_deg.to_radians();
            let curvature = angle.sin() / (steering.ahead_m * angle.cos() + steering.behind_m);
            assert!((steering.angle_rad(curvature) - angle).abs() < 1e-12, "{angle_deg}");
        }
        assert!((steering.angle_rad(5.0) - 25_f64.to_radians()).abs() < 1e-12);
    }
}
