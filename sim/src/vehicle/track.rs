//! A vehicle led along what was measured.

use super::Vehicle;
use crate::bodies::{Motion, Placed};
use crate::{Actuation, Held, Track, VehicleState};

impl<B: Placed + Send + 'static> Track for Vehicle<B> {
    fn track(&mut self, measured: &VehicleState, actuation: &Actuation) {
        let motion = self.motion_of(measured);
        let mut unseen = VehicleState::default();
        for _ in 0..self.turns {
            self.actuators.step(actuation, &motion, &mut unseen, self.turn_s());
        }
        self.place(measured, actuation);
    }

    fn place(&mut self, measured: &VehicleState, actuation: &Actuation) {
        let motion = self.motion_of(measured);
        self.actuators.hold(measured, actuation, &motion, Held::ALL);
        self.bodies.place(&motion);
        let ground_force_n = self.motion.ground_force_n;
        self.motion = Motion { ground_force_n, ..self.bodies.motion() };
        self.state = *measured;
        self.observe(self.imu_velocity_m_s(&self.motion));
        self.state.front_specific_force_m_s2 = measured.front_specific_force_m_s2;
    }

    fn hold(&mut self, measured: &VehicleState, actuation: &Actuation, held: Held) {
        self.actuators.hold(measured, actuation, &self.motion, held);
    }

    fn snapshot(&self) -> Box<dyn Track + Send> {
        Box::new(self.clone())
    }
}
