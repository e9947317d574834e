//! A solver that tells what it was last loaded with: what the blocks of a whole vehicle put out.

use xt28_machine::PerWheel;
use xt28_sim::{Bodies, Loads, Motion, Parts, Placed, Terrain};

/// A solver, and its loads of the last step.
#[derive(Clone)]
pub(crate) struct Overheard<B> {
    pub(crate) bodies: B,
    pub(crate) loads: Loads,
}

impl<B: Bodies> Bodies for Overheard<B> {
    fn new(parts: &Parts, terrain: &Terrain, stroke_m: PerWheel<f64>) -> Self {
        Self { bodies: B::new(parts, terrain, stroke_m), loads: Loads::default() }
    }

    fn motion(&self) -> Motion {
        self.bodies.motion()
    }

    fn held_at_most_s(inertia_kg_m2: f64, slope_nms: f64) -> f64 {
        B::held_at_most_s(inertia_kg_m2, slope_nms)
    }

    fn advance(&mut self, loads: &Loads, dt_s: f64) {
        self.loads = *loads;
        self.bodies.advance(loads, dt_s);
    }
}

impl<B: Placed> Placed for Overheard<B> {
    fn place(&mut self, motion: &Motion) {
        self.bodies.place(motion);
    }
}
