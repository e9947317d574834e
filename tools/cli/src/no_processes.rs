//! A real CAN interface where the system has none: refused with the bus's own message.

use xt28_bus::SocketCan;
use xt28_scenarios::{Cost, Recording, Setup};

use crate::Failure;
use crate::artefacts::Artefacts;

/// Refuses.
pub(crate) fn run(_: &Setup, bus: &str, _: &Artefacts) -> Result<(Recording, Cost), Failure> {
    SocketCan::open(bus)?;
    Err(format!("{bus}: programs run on a real bus under Linux only; use --bus virtual").into())
}
