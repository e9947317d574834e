//! Which solver of the rigid bodies a plant runs on, by name.

use core::fmt;
use core::str::FromStr;
use core::time::Duration;

use xt28_machine::{Machine, PerWheel};

use crate::{Effects, RapierBodies, ReducedBodies, Terrain, Track, Vehicle};

/// A solver of the vehicle's rigid bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Solver {
    /// The reference, on rapier3d.
    #[default]
    Rapier,
    /// The fast core, in reduced coordinates.
    Reduced,
}

/// A name that is no solver's.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("\"{0}\" is no solver; write rapier or reduced")]
pub struct UnknownSolver(String);

impl Solver {
    /// A vehicle on this solver; see [`Vehicle::with`].
    #[must_use]
    pub fn vehicle(
        self,
        machine: &Machine,
        effects: &Effects,
        terrain: &Terrain,
        stroke_m: PerWheel<f64>,
        step: Duration,
    ) -> Box<dyn Track + Send> {
        match self {
            Self::Rapier => {
                let vehicle =
                    Vehicle::<RapierBodies>::with(machine, effects, terrain, stroke_m, step);
                Box::new(vehicle)
            }
            Self::Reduced => {
                let vehicle =
                    Vehicle::<ReducedBodies>::with(machine, effects, terrain, stroke_m, step);
                Box::new(vehicle)
            }
        }
    }
}

impl fmt::Display for Solver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Rapier => "rapier",
            Self::Reduced => "reduced",
        })
    }
}

impl FromStr for Solver {
    type Err = UnknownSolver;

    fn from_str(name: &str) -> Result<Self, UnknownSolver> {
        let both = [Self::Rapier, Self::Reduced];
        let known = both.into_iter().find(|solver| solver.to_string() == name);
        known.ok_or_else(|| UnknownSolver(name.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Actuation, STEP};

    #[test]
    fn names_lead_to_solvers_and_solvers_to_vehicles() {
        for name in ["rapier", "reduced"] {
            let solver: Solver = name.parse().unwrap();
            assert_eq!(solver.to_string(), name);
            let machine = Machine::xt28();
            let stroke_m = PerWheel::splat(0.17);
            let (effects, ground) = (Effects::default(), Terrain::Flat);
            let mut plant = solver.vehicle(&machine, &effects, &ground, stroke_m, STEP);
            plant.step(&Actuation::idle(1200.0));
            assert!((plant.state().stroke_m.mean() - 0.17).abs() < 0.01);
        }
        assert!("bullet".parse::<Solver>().unwrap_err().to_string().contains("rapier or reduced"));
    }
}
