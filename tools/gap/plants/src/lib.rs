//! Foreign machines for examining a diagnosis: plants with known faults, and their field logs.
//!
//! A [`Case`] is one machine drawn from a seed: its tolerances, what is wrong with it, and the logs of
//! scripted test drives. Rigid bodies are the bench's; hydraulics, drive, steering, tyres, ground, ECUs
//! and sensors are written anew with other physics (chamber pressures, spools with mass, circuit
//! pressure, tyres that creep and soil that shears, another integrator), so that a diagnosis cannot find
//! its own equations in the data.
//!
//! | | |
//! |---|---|
//! | a machine and its logs | [`Case`] |
//! | what can be wrong | [`CAUSES`], a file each in `causes/` |
//! | what was driven | [`Manoeuvre`] |
//! | answers, and proof that they were not changed | [`Answer`], [`Seal`] |
#![forbid(unsafe_code)]

mod about;
mod answer;
mod body;
mod case;
mod causes;
mod database;
mod drive;
mod ecu;
mod ground;
mod history;
mod hydraulics;
mod machine;
mod manoeuvre;
mod rims;
mod run;
mod scope;
mod seal;
mod sensing;
mod steering;
mod tolerance;
mod truth;
mod tyre;
mod wire;

pub use answer::{Answer, Fact};
pub use case::{Case, CaseError, Kind, Log};
pub use causes::{Block, CAUSES, Cause, Parameter, Scopes, Span};
pub use manoeuvre::Manoeuvre;
pub use scope::Scope;
pub use seal::Seal;
