//! Ground and machines on which tyres show all that they do.

use std::sync::Arc;

use xt28_machine::{Machine, TyreModel, Wheel};
use xt28_sim::effects::{SlipperyGround, SoftTyre};
use xt28_sim::terrain::{Extent, Grid};
use xt28_sim::{Effects, Terrain};

/// Slopes of some 15 degrees and bumps half a wheel long, so that wheels touch in several points.
pub(crate) fn rough() -> Terrain {
    Terrain::Grid(Arc::new(Grid::from_fn(Extent::default(), |x, y| {
        0.15 * (1.1 * x).sin() * (0.9 * y + 0.4).cos() + 0.03 * (8.0 * x - 2.0 * y).sin()
    })))
}

/// The nominal machine, and one on soft brush tyres on slippery ground, each tyre a little different.
pub(crate) fn machines() -> [(Machine, Effects); 2] {
    let mut soft = (Machine::xt28(), Effects::default());
    soft.0.vehicle.tyre_model = TyreModel::Brush;
    for wheel in Wheel::ALL {
        let more = 1.0 + 0.1 * wheel.index() as f64;
        let w = &mut soft.1.wheels[wheel];
        w.soft_tyre = SoftTyre { stiffness_n_m: 6e5 * more, damping_n_s_m: 1.5e4 };
        w.slippery_ground =
            SlipperyGround { friction_factor: 0.5 * more, slip: 0.05, creep_m_s_n: 5e-6 };
    }
    [(Machine::xt28(), Effects::default()), soft]
}
