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
        // Each number by itself: who says how stiff a tyre is has not said how it is damped.
        let neutral = SoftTyre::default();
        let or = |said: f64, neutral: f64, own: f64| if said == neutral { own } else { said };
        let brush = match v.tyre_model {
            TyreModel::Rigid => None,
            TyreModel::Brush => Some(Brush {
                longitudinal_n_m: v.tyre_longitudinal_n_m,
                lateral_n_m: v.tyre_lateral_n_m,
                relaxation_m: v.tyre_relaxation_m,
            }),
        };
        Self {
            stiffness_n_m: or(soft.stiffness_n_m, neutral.stiffness_n_m, v.tyre_stiffness_n_m),
            damping_n_s_m: or(soft.damping_n_s_m, neutral.damping_n_s_m, v.tyre_damping_n_s_m),
            friction: machine.wheels.friction * slippery.friction_factor,
            slip: slippery.slip,
            brush,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_an_effect_does_not_say_is_the_machine_files() {
        let mut machine = Machine::xt28();
        (machine.vehicle.tyre_stiffness_n_m, machine.vehicle.tyre_damping_n_s_m) = (6.0e5, 9.0e3);
        let mut effects = WheelEffects::default();
        let numbers = |effects: &WheelEffects| {
            let tyre = TyrePart::new(&machine, effects);
            [tyre.stiffness_n_m, tyre.damping_n_s_m]
        };
        assert_eq!(numbers(&effects), [6.0e5, 9.0e3]);
        effects.soft_tyre.stiffness_n_m = 4.0e5;
        assert_eq!(numbers(&effects), [4.0e5, 9.0e3]);
        effects.soft_tyre.damping_n_s_m = 5.0e3;
        assert_eq!(numbers(&effects), [4.0e5, 5.0e3]);
    }
}
