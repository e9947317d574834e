//! The database model behind generated and run-time codecs: parse, check, encode, decode, generate.
//!
//! One conversion serves both: a [`Field`] says where a number's bits are and turns raw into
//! physical and back, rounding half away from zero and refusing what does not fit.
#![forbid(unsafe_code)]

mod check;
mod database;
mod declared;
mod field;
mod generate;
mod generate_error;
mod message;
mod names;
mod stray;
mod text;

pub use check::{Harm, Problem};
pub use database::{Database, ReadError, Unusable};
pub use field::{Field, Kind, ValueError};
pub use generate::generate;
pub use generate_error::GenerateError;
pub use message::{CodecError, Message, Presence, Signal};
pub use text::text;
