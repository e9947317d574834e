//! Whether what the logs tell twice, by two sensors of one thing, has one scale and one sense. Where it has not, a
//! database or a mapping is wrong, and no effect explains it.

mod along;
mod attitude_scale;
mod chamber_order;
mod heading_sense;
mod joint_scale;
mod load_scale;
mod side_order;
mod speed_scale;
mod stroke_scale;
mod valve_sense;
mod wheel_order;
mod wheel_scale;

use xt28_machine::Machine;

use super::signals::Signals;
use crate::Disagreement;
pub use attitude_scale::AttitudeScale;
use attitude_scale::attitude_scale;
pub use chamber_order::SwappedChambers;
use chamber_order::swapped_chambers;
pub use heading_sense::OddHeading;
use heading_sense::odd_heading;
pub use joint_scale::JointScale;
use joint_scale::joint_scale;
pub use load_scale::LoadScale;
use load_scale::load_scale;
pub use side_order::SideOrder;
use side_order::side_order;
pub use speed_scale::SpeedScale;
use speed_scale::speed_scale;
pub use stroke_scale::StrokeScale;
use stroke_scale::stroke_scale;
pub use valve_sense::TurnedValves;
use valve_sense::turned_valves;
pub(super) use wheel_order::axles_alike;
pub use wheel_order::{Swap, swapped_wheels};
pub use wheel_scale::WheelScale;
use wheel_scale::wheel_scale;

/// Samples of a log from one that is compared to the next: ten are compared a second. What has a scale or an order
/// here moves over tenths of a second and more, so that samples in between would say the same again.
const COMPARED_EVERY: usize = 10;

/// Refuses `runs` of a machine of `machine`'s make that contradict themselves.
///
/// # Errors
/// [`Disagreement`].
pub fn ensure_agreeing(runs: &[Signals], machine: &Machine) -> Result<(), Disagreement> {
    ensure_pressures_agreeing(runs, machine)?;
    ensure_motions_agreeing(runs, machine)
}

/// The same of the valves' solenoids, where those of all arms are in each other's place: wheels look swapped then.
pub(crate) fn ensure_valves_agreeing(runs: &[Signals]) -> Result<(), Disagreement> {
    let turned = turned_valves(runs).filter(|turned| turned.are_all);
    turned.map_or(Ok(()), |turned| Err(Disagreement::ValveSense { turned }))
}

/// The same of what the chambers' pressures say, which take no heed of which wheel's stroke is whose.
pub(crate) fn ensure_pressures_agreeing(
    runs: &[Signals],
    machine: &Machine,
) -> Result<(), Disagreement> {
    if let Some(swapped) = swapped_chambers(runs, machine) {
        return Err(Disagreement::ChamberOrder { swapped });
    }
    load_scale(runs, machine).map_or(Ok(()), |scale| Err(Disagreement::LoadScale { scale }))
}

/// The same of valves, wheels, joints, strokes and attitude.
pub(crate) fn ensure_motions_agreeing(
    runs: &[Signals],
    machine: &Machine,
) -> Result<(), Disagreement> {
    if let Some(turned) = turned_valves(runs) {
        return Err(Disagreement::ValveSense { turned });
    }
    if let Some(scale) = wheel_scale(runs, machine) {
        return Err(Disagreement::WheelScale { scale });
    }
    if let Some(scale) = speed_scale(runs, machine) {
        return Err(Disagreement::SpeedScale { scale });
    }
    if let Some(odd) = odd_heading(runs, machine) {
        return Err(Disagreement::HeadingSense { odd });
    }
    if let Some(scale) = joint_scale(runs, machine) {
        return Err(Disagreement::JointScale { scale });
    }
    if let Some(order) = side_order(runs) {
        return Err(Disagreement::SideOrder { order });
    }
    if let Some(scale) = stroke_scale(runs) {
        return Err(Disagreement::StrokeScale { scale });
    }
    attitude_scale(runs, machine).map_or(Ok(()), |scale| Err(Disagreement::AttitudeScale { scale }))
}
