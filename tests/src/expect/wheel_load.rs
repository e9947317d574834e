//! What each wheel carries, from the cylinders: what the bus can say of the ground's force.

use xt28_machine::{GRAVITY_M_S2, Linkage, Machine, PerWheel, Wheel};

use crate::Trace;
use crate::series::Sample;

/// Vertical ground force on each wheel, N, from one sample of cylinder loads and the strokes then;
/// `None` before the first stroke.
pub(super) fn wheel_loads_n(
    machine: &Machine,
    trace: &Trace,
    load_n: &Sample<PerWheel<f64>>,
) -> Option<PerWheel<f64>> {
    let stroke_m = trace.stroke_m.known_at(load_n.at_s)?.value;
    let linkage = machine.linkage();
    let one = |wheel: Wheel| wheel_load_n(machine, &linkage, stroke_m[wheel], load_n.value[wheel]);
    Some(PerWheel::from_fn(one))
}

/// Vertical ground force on one wheel at rest, N. Moments about the arm's pivot: the ground lifts
/// wheel and arm and presses the cylinder, so F = k F_cylinder + (m_wheel + share m_arm) g, with k
/// of the true linkage (facts 1.4) and `share` the way from pivot to wheel to the arm's centre of
/// mass. A horizontal ground force, as when arms pinch the ground, is not seen.
fn wheel_load_n(machine: &Machine, linkage: &Linkage, stroke_m: f64, load_n: f64) -> f64 {
    let unsprung_kg =
        machine.masses.wheel_kg + machine.vehicle.arm_com_share * machine.masses.arm_kg;
    linkage.at_stroke(stroke_m).force_ratio * load_n + unsprung_kg * GRAVITY_M_S2
}
