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
    /// Speed at which the ground shears under the patch for every newton along it, m/s/N.
    pub creep_m_s_n: f64,
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
            creep_m_s_n: slippery.creep_m_s_n,
            brush,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use xt28_machine::Wheel;

    use super::*;
    use crate::effects::Overlay;

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

    /// A severity goes from the tyre that the machine file has to the one that the overlay has, whatever
    /// either is: nothing on the way, the near rigid number included, is another tyre.
    #[test]
    fn severity_leads_from_the_machine_files_tyre_to_the_overlays() {
        let mut machine = Machine::xt28();
        for own in [5.0e6, 6.0e5, 8.0e6] {
            machine.vehicle.tyre_stiffness_n_m = own;
            for said in [4.0e5, 8.0e6, 2.0e7] {
                for severity in [0.0, 1e-9, 0.25, 0.5, 1.0] {
                    let text = format!(
                        "[[effect]]\nname = \"soft-tyres\"\nseverity = {severity}\nstiffness_n_m = {said}"
                    );
                    let overlay = Overlay::parse(&text, Path::new("o.toml")).unwrap();
                    let tyre = TyrePart::new(
                        &machine,
                        &overlay.effects(&machine).unwrap().wheels[Wheel::Ml],
                    );
                    let wanted = own + severity * (said - own);
                    let apart = (tyre.stiffness_n_m / wanted - 1.0).abs();
                    let is_bound = if severity == 0.0 { apart == 0.0 } else { apart < 1e-15 };
                    assert!(is_bound, "{own} to {said} by {severity}: {}", tyre.stiffness_n_m);
                    assert_eq!(tyre.damping_n_s_m, machine.vehicle.tyre_damping_n_s_m);
                }
            }
        }
    }
}
