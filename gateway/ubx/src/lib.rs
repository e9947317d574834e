//! u-blox UBX: the three navigation messages the machine uses, both ways, and the local frame they
//! are turned into.
//!
//! The emulated receiver encodes with this crate and the gateway decodes with it, so a fix means
//! the same on both sides. Layouts: u-blox ZED-F9P interface description (HPG 1.32), sections
//! UBX-NAV-PVT, UBX-NAV-HPPOSLLH and UBX-NAV-RELPOSNED. Public fields are SI (metres, metres a
//! second, radians, seconds); the resolution each has on the wire is said at the field.
#![forbid(unsafe_code)]

mod encode;
mod frame;
mod geodetic;
mod nav_hpposllh;
mod nav_pvt;
mod nav_relposned;
mod parser;
mod payload;

pub use encode::EncodeError;
pub use frame::{Message, checksum};
pub use geodetic::{Enu, Geodetic, LocalFrame};
pub use nav_hpposllh::NavHpPosLlh;
pub use nav_pvt::{CarrierSolution, FixType, NavPvt, Utc};
pub use nav_relposned::NavRelPosNed;
pub use parser::{Counts, Messages, Parser};
