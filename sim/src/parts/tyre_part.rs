//! A wheel's tyre against the ground: near rigid as in the paper, or springy.

use xt28_machine::{Machine, TyreModel};

use crate::effects::{SoftTyre, WheelEffects};

/// A tyre's spring and damper against the ground, and its grip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TyrePart {
    /// Stiffness, N/m.
    pub stiffness_n_m: f64,
    /// Damping, N s/m.
    pub damping_n_s_m: f64,
    /// Coefficient of dry friction on the ground.
    pub friction: f64,
    /// Share of the wheel's rolling that does not become travel: v = (1 - slip) w R.
    pub slip: f64,
    /// Give of the patch along the ground; `None` for the rigid wheel, which sticks until it slides.
    /// How near to that a solver comes is its own matter.
    pub brush: Option<Brush>,
}

/// Give of a tyre's contact patch along the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brush {
    /// Stiffness along the wheel's rolling, N/m.
    pub longitudinal_n_m: f64,
    /// Stiffness along the axle, N/m.
    pub lateral_n_m: f64,
    /// Rolled distance over which the patch's deflection renews itself, m; without end for a patch
    /// that creeps only by sliding.
    pub relaxation_m: f64,
}

impl TyrePart {
    /// The tyre of this machine, with what the effects change of it.
    pub(super) fn new(machine: &Machine, effects: &WheelEffects) -> Self {
        let v = &machine.vehicle;
        let (soft, slippery) = (&effects.soft_tyre, &effects.slippery_ground);
        let softened = *soft != SoftTyre::default();
        let nominal =
            SoftTyre { stiffness_n_m: v.tyre_stiffness_n_m, damping_n_s_m: v.tyre_damping_n_s_m };
        let SoftTyre { stiffness_n_m, damping_n_s_m } = if softened { *soft } else { nominal };
        let brush = match v.tyre_model {
            TyreModel::Rigid => None,
            TyreModel::Brush => Some(Brush {
                longitudinal_n_m: v.tyre_longitudinal_n_m,
                lateral_n_m: v.tyre_lateral_n_m,
                relaxation_m: v.tyre_relaxation_m,
            }),
        };
        Self {
            stiffness_n_m,
            damping_n_s_m,
            friction: machine.wheels.friction * slippery.friction_factor,
            slip: slippery.slip,
            brush,
        }
    }
}
