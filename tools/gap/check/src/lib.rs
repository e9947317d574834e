//! The diagnosis examined on machines whose faults are known and withheld.
//!
//! | Step | Where |
//! |---|---|
//! | cases, drawn or in a folder, or made of those | [`Source`], [`Graft`] |
//! | answers sealed, every case diagnosed, the seal opened | [`Examination`] |
//! | what is so, and what was said | [`Truth`], [`Reply`] |
//! | plain rules on the same logs | [`BASELINES`] |
//! | each effect withheld from the catalogue in turn | [`sweep`] |
//! | scores with their intervals, the reliability curve | [`scores`], [`Report`] |
//! | which scales would have made better probabilities | [`suited`] |
#![forbid(unsafe_code)]

mod baselines;
mod coverage;
mod crew;
mod error;
mod examination;
mod graft;
mod oracle;
mod reply;
mod report;
mod score;
mod source;
mod sweep;
mod truth;
mod wilson;

pub use baselines::{BASELINES, Baseline};
pub use error::CheckError;
pub use examination::{Clock, Examination, Examined, Judged, Options, Refused};
pub use graft::Graft;
pub use reply::{Named, Reply};
pub use report::Report;
pub use score::{
    Bin, Outcome, Score, Scores, Statement, Suited, calibration_error, curve, error_by_chance,
    reliability, scores, statements, suited,
};
pub use source::{MIX, Source};
pub use sweep::{Withheld, one_of_each, sweep, sweep_scores};
pub use truth::{Fact, Kind, Truth};
pub use wilson::wilson;
