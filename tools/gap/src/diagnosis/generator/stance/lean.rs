//! Where the receiver's antenna is for the leaning of the frame that its mast stands on.
//!
//! Strokes and loads say the plane that the wheels stand on. The inertial unit would say it as well, but
//! takes what a machine that gains speed feels for a lean.

use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::{Effects, Parts};

use super::layout::{Layout, Reach};
use super::plane::{Foot, Plane};
use crate::diagnosis::generator::press::{normal_n, own_n};
use crate::diagnosis::signals::Signals;

/// How far the antenna is ahead and to the left of where it would be over level wheels, m, sample by
/// sample; as just before where fewer than three wheels stand.
#[must_use]
pub(in crate::diagnosis::generator) fn antenna_leans_m(
    s: &Signals,
    machine: &Machine,
) -> Vec<[f64; 2]> {
    let lean_m = |plane: Plane| {
        // Nose up takes it back, right side high to the left, by its height over the ground.
        let high_m = machine.sensors.gnss_antenna_m[2] - plane.z_m;
        [high_m * plane.slope_x, high_m * plane.slope_y]
    };
    planes(s, machine).into_iter().map(lean_m).collect()
}

/// The plane that the wheels stand on, sample by sample, as a machine without effects would say it; as
/// just before where fewer than three wheels stand.
#[must_use]
pub(super) fn planes(s: &Signals, machine: &Machine) -> Vec<Plane> {
    let parts = Parts::new(machine, &Effects::default());
    let own_n = PerWheel::from_fn(|w| own_n(machine, &parts, w));
    let mut plane = Plane::default();
    let step = |i: usize| {
        plane = plane_at(s, machine, &parts, &own_n, i).unwrap_or(plane);
        plane
    };
    (0..s.len).map(step).collect()
}

/// The plane that the wheels stand on at sample `i`, seen from the front frame.
fn plane_at(
    s: &Signals,
    machine: &Machine,
    parts: &Parts,
    own_n: &PerWheel<f64>,
    i: usize,
) -> Option<Plane> {
    let pose = PerWheel::from_fn(|w| parts.linkage.at_stroke(s.smooth_stroke_m[w][i]));
    let reaches = PerWheel::from_fn(|w| Reach { reach_m: pose[w].reach_m, drop_m: pose[w].drop_m });
    let layout = Layout::new(parts, machine, [0, 1].map(|j| s.joint_rad[j][i]), &reaches);
    let foot = |w: Wheel| {
        let [x, y, z] = layout.contact_m[w];
        let normal_n = normal_n(own_n[w], s.cylinder_load_n[w][i], &pose[w]);
        Foot { at_m: [x, y], ground_m: z + normal_n / parts.tyres[w].stiffness_n_m, normal_n }
    };
    Plane::through(&PerWheel::from_fn(foot))
}
