//! Rows of the masses and of the ground's lie, by the moments of the wheels' loads on a slope.

use xt28_machine::{GRAVITY_M_S2, Machine, Wheel};
use xt28_sim::{Effects, Parts, VehicleState};

use crate::row::{MACHINE, Row, Seen, Signal, Size, Stay, Values, joints_rad};
use crate::scene::Scene;

/// The ground rises forward by so much, rad, where height counts.
const GRADE_RAD: f64 = 0.05;
const ON_A_SLOPE: &[(&str, Values)] = &[("terrain-slope", &[("grade_x_rad", GRADE_RAD)])];
/// At rest, s.
const RESTS_S: [f64; 2] = [9.0, 10.0];

/// Strokes are where the oil has them, but for what it gives under another load; joints where they were.
const OF_MASSES: &[Stay] =
    &[Stay::Within("oil", OIL, RESTS_S, 5e-6), Stay::Within("joints", joints_rad, RESTS_S, 1e-3)];
const OIL: Signal = |s| {
    let h = &MACHINE.hydraulics;
    let oil_m = |w: Wheel| s.stroke_m[w] + s.cylinder_force_n[w] / h.lock_stiffness_n_m;
    Wheel::ALL.map(oil_m).to_vec()
};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            both: ON_A_SLOPE,
            shows: Some(|seen| {
                let rear_x_m = seen.machine.frames.rear_com_m[0];
                carries(seen, 4000.0, [rear_x_m - 0.5, 0.2, 2.4].map(|m| 4000.0 * m))
            }),
            stays: OF_MASSES,
            ..Row::new("payload", LOAD, Scene::Stands)
        },
        Row {
            both: ON_A_SLOPE,
            shows: Some(|seen| {
                let kg = seen.machine.masses.front_frame_kg;
                carries(seen, 0.0, [0.3, 0.1, 0.5].map(|m| kg * m))
            }),
            stays: OF_MASSES,
            ..Row::new("com-shift", &[("x_m", 0.3), ("y_m", 0.1), ("z_m", 0.5)], Scene::Stands)
        },
        Row {
            shows: Some(leans),
            stays: OF_MASSES,
            ..Row::new(
                "terrain-slope",
                &[("grade_x_rad", GRADE_RAD), ("grade_y_rad", -0.03)],
                Scene::Stands,
            )
        },
    ]
}

const LOAD: Values =
    &[("mass_kg", 4000.0), ("longitudinal_m", -0.5), ("lateral_m", 0.2), ("height_m", 2.4)];

/// Mass of the empty machine, kg, and its first moments along the front frame's axes, kg m, by the machine file.
fn empty(machine: &Machine, parts: &Parts, s: &VehicleState) -> (f64, [f64; 3]) {
    let (m, f) = (&machine.masses, &machine.frames);
    let mut bodies = vec![
        (m.front_frame_kg, f.front_com_m),
        (m.middle_frame_kg, f.middle_com_m),
        (m.rear_frame_kg, f.rear_com_m),
    ];
    for (w, centre_m) in parts.wheel_centres_m(s.stroke_m).iter() {
        let pivot_m = parts.arms[w].pivot_m;
        let share = machine.vehicle.arm_com_share;
        let com_m = core::array::from_fn(|k| pivot_m[k] + share * (centre_m[k] - pivot_m[k]));
        bodies.extend([(m.wheel_kg, *centre_m), (m.arm_kg, com_m)]);
    }
    let first = |k: usize| bodies.iter().map(|(kg, com_m)| kg * com_m[k]).sum();
    (bodies.iter().map(|(kg, _)| kg).sum(), [first(0), first(1), first(2)])
}

/// Along the ground's axes what lies so in the front frame, which leans against it by pitch and roll.
fn on_ground(s: &VehicleState, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let [(sp, cp), (sr, cr)] = [s.pitch_rad - GRADE_RAD, s.roll_rad].map(f64::sin_cos);
    // Nose up, then right side high.
    let (y, z) = (y * cr + z * sr, z * cr - y * sr);
    [x * cp - z * sp, y, z * cp + x * sp]
}

/// The ground carries the machine's weight, and the moments of the wheels' loads are those of the masses, with these
/// more, kg and kg m: square to the ground its part of the weight, down the slope the other at the masses' height.
fn carries(seen: &Seen, more_kg: f64, more_kg_m: [f64; 3]) -> Vec<Size> {
    let parts = Parts::new(seen.machine, &Effects::default());
    let s = &seen.with[seen.with.len() - 1];
    let (mass_kg, first_kg_m) = empty(seen.machine, &parts, s);
    let mass_kg = mass_kg + more_kg;
    let [x, y, z] = on_ground(s, core::array::from_fn(|k| first_kg_m[k] + more_kg_m[k]));
    let (sin, cos) = GRADE_RAD.sin_cos();
    // The ground turns about the world's origin.
    let above_m = s.position_m[2] * cos - s.position_m[0] * sin;
    let centres_m = parts.wheel_centres_m(s.stroke_m).map(|centre_m| on_ground(s, centre_m));
    let moment_nm =
        |k: usize| -> f64 { s.ground_force_n.iter().map(|(w, n)| n * centres_m[w][k]).sum() };
    let along_nm = GRAVITY_M_S2 * (cos * x - sin * (z + mass_kg * above_m));
    let [within_along, within_across, _] = more_kg_m.map(|kg_m| 0.01 * GRAVITY_M_S2 * kg_m.abs());
    let weight_n = GRAVITY_M_S2 * cos * mass_kg;
    vec![
        Size::new("moment along, Nm", moment_nm(0), along_nm, within_along),
        Size::new("moment across, Nm", moment_nm(1), GRAVITY_M_S2 * cos * y, within_across),
        Size::new("weight, N", s.ground_force_n.sum(), weight_n, 1e-4 * weight_n),
    ]
}

/// The frame leans with the ground, the inertial unit feels it, the ground carries the part of the weight square to it.
fn leans(seen: &Seen) -> Vec<Size> {
    let [without, with] = seen.means(RESTS_S, |s| s.pitch_rad);
    let mut sizes = vec![Size::new("pitch, rad", with - without, GRADE_RAD, 2e-3)];
    let [without, with] = seen.means(RESTS_S, |s| s.roll_rad);
    // Ground that falls to the left lifts the right side.
    sizes.push(Size::new("roll, rad", with - without, 0.03, 2e-3));
    let [_, felt_m_s2] = seen.means(RESTS_S, |s| s.front_specific_force_m_s2[0]);
    let [_, pitch_rad] = seen.means(RESTS_S, |s| s.pitch_rad);
    sizes.push(Size::new("felt, m/s2", felt_m_s2, GRAVITY_M_S2 * pitch_rad.sin(), 2e-3));
    let [_, carried_n] = seen.means(RESTS_S, |s| s.ground_force_n.sum());
    let steep = GRADE_RAD.tan().hypot(0.03_f64.tan());
    let wanted_n = seen.machine.mass_kg() * GRAVITY_M_S2 * steep.atan().cos();
    sizes.push(Size::new("carried, N", carried_n, wanted_n, 1e-3 * wanted_n));
    sizes
}
