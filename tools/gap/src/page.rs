//! A diagnosis for people: in words for a terminal, and as two pages to print, one for who decides
//! and one for who mends.
//!
//! The pages are one HTML file with its drawings inline: no script, nothing fetched, and every text
//! that comes from a log is escaped.

mod ahead;
mod assumptions;
mod brief;
mod caption;
mod chart;
mod colour;
mod engineer;
mod headline;
mod heat;
mod horizon;
mod html;
mod machine_view;
mod named;
mod overlay;
mod rows;
mod size;
mod strip;
mod sureness;
mod svg;
mod table;
mod text;
mod trace;
mod unit;
mod words;

pub use headline::headline;
pub use html::{Subject, html};
pub use overlay::overlay;
pub use text::text;
