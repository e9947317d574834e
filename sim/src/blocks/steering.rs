//! The two articulation joints: a valve turns the rest angle, the closed oil holds it.
//!
//! The same soft lock as a cylinder's: torque = k (rest - angle) - c d(angle)/dt, with the rest no
//! further from the joint than the largest torque twists it. The damper acts on the joint's own
//! rate, so against the scrub of the tyres the torque also bounds how fast the joint turns.

use xt28_machine::Machine;

/// Parameters of one articulation joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Steering {
    rate_max_rad_s: f64,
    angle_max_rad: f64,
    torque_max_nm: f64,
    stiffness_nm: f64,
    damping_nms: f64,
}

/// What a joint remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SteeringState {
    /// Angle at which the oil makes no torque, rad; left > 0.
    pub rest_rad: f64,
}

/// What acts on a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteeringInput {
    /// Valve opening, -1 (right) to 1 (left).
    pub opening: f64,
    /// Joint angle, rad; left > 0.
    pub angle_rad: f64,
    /// Joint rate, rad/s.
    pub rate_rad_s: f64,
}

impl Steering {
    /// A joint of this machine; front and rear are alike.
    #[must_use]
    pub const fn new(machine: &Machine) -> Self {
        let (a, v) = (&machine.articulation, &machine.vehicle);
        Self {
            rate_max_rad_s: a.rate_max_deg_s.to_radians(),
            angle_max_rad: a.angle_max_deg.to_radians(),
            torque_max_nm: a.torque_max_nm,
            stiffness_nm: v.joint_stiffness_nm,
            damping_nms: v.joint_damping_nms,
        }
    }

    /// Turns the rest angle over `dt_s` s. The relief valve lets the rest go no further from the
    /// joint than the largest torque twists it.
    #[must_use]
    pub fn step(&self, state: SteeringState, input: &SteeringInput, dt_s: f64) -> SteeringState {
        let opening = input.opening.clamp(-1.0, 1.0);
        let rest = state.rest_rad + opening * self.rate_max_rad_s * dt_s;
        let twist = self.torque_max_nm / self.stiffness_nm;
        // Where the joint will be: a limit around where it was would give way to its own motion.
        let angle = input.angle_rad + input.rate_rad_s * dt_s;
        SteeringState {
            rest_rad: rest
                .clamp(-self.angle_max_rad, self.angle_max_rad)
                .clamp(angle - twist, angle + twist),
        }
    }

    /// Stiffness of the held joint, Nm/rad.
    #[must_use]
    pub const fn stiffness_nm(&self) -> f64 {
        self.stiffness_nm
    }

    /// Damping of the held joint, Nm s/rad.
    #[must_use]
    pub const fn damping_nms(&self) -> f64 {
        self.damping_nms
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_valve_turns_ten_degrees_a_second_up_to_the_stop() {
        let steering = Steering::new(&Machine::xt28());
        let mut state = SteeringState::default();
        for _ in 0..200 {
            let input = SteeringInput { opening: 1.0, angle_rad: state.rest_rad, rate_rad_s: 0.0 };
            state = steering.step(state, &input, 0.005);
        }
        assert!((state.rest_rad.to_degrees() - 10.0).abs() < 1e-9);
        for _ in 0..1000 {
            let input = SteeringInput { opening: 1.0, angle_rad: state.rest_rad, rate_rad_s: 0.0 };
            state = steering.step(state, &input, 0.005);
        }
        assert!((state.rest_rad.to_degrees() - 25.0).abs() < 1e-9);
    }

    #[test]
    fn a_blocked_joint_takes_no_more_than_its_torque() {
        let machine = Machine::xt28();
        let steering = Steering::new(&machine);
        let mut state = SteeringState::default();
        for _ in 0..1000 {
            state = steering.step(
                state,
                &SteeringInput { opening: 1.0, angle_rad: 0.0, rate_rad_s: 0.0 },
                0.005,
            );
        }
        let torque_nm = state.rest_rad * steering.stiffness_nm();
        assert!((torque_nm - machine.articulation.torque_max_nm).abs() < 1e-6);
    }
}
