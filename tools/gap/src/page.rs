//! A diagnosis for people: in words for a terminal.

mod text;
mod words;

pub use text::text;
pub use words::headline;
