//! Rows of what is between wheel and ground: how deep wheels sink, what grip they have, how they slip.

use xt28_machine::{GRAVITY_M_S2, Side, Wheel};
use xt28_sim::{Effects, Parts, STEP, VehicleState};

use crate::row::{MACHINE, Row, Seen, Signal, Size, Stay, joints_rad, mean_speed_rad_s, strokes_m};
use crate::scene::{Scene, step_at};

/// A machine that stands does not slip, and one that rolls rolls as fast as it is asked to.
const OF_GRIP: &[Stay] = &[
    Stay::Within("strokes at rest", strokes_m, [1.9, 2.0], 1e-4),
    Stay::Within("attitude at rest", ATTITUDE, [1.9, 2.0], 1e-4),
    Stay::Within("speed in the end", mean_speed_rad_s, [9.8, 10.0], 5e-3),
];
const ATTITUDE: Signal = |s| vec![s.roll_rad, s.pitch_rad];

/// Slope that a machine climbs so that its wheels push.
const CLIMB_RAD: f64 = 0.06;
/// Slope on which ice does not hold a braked machine and a road does, rad.
const BANK_RAD: f64 = 0.1;
/// Friction on ice over that on the road.
const ICE: f64 = 0.05;
/// While the light rear wheels spin at full pumps, s.
const SPINS_S: [f64; 2] = [2.4, 2.9];
const CREEP_M_S_N: f64 = 2e-5;

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            scope: "right",
            shows: Some(|seen| [sinks(seen), bounces(seen)].concat()),
            stays: &[Stay::Within(
                "load of the machine",
                |s| vec![s.ground_force_n.sum()],
                [9.0, 10.0],
                50.0,
            )],
            ..Row::new(
                "soft-tyres",
                &[("stiffness_n_m", 4e5), ("damping_n_s_m", 2e4)],
                Scene::Stands,
            )
        },
        Row {
            shows: Some(|seen| slips(seen, 0.1, 0.0)),
            stays: OF_GRIP,
            ..Row::new("slippery-ground", &[("slip", 0.1)], Scene::Drives(0.5))
        },
        Row {
            both: &[("terrain-slope", &[("grade_x_rad", BANK_RAD)])],
            shows: Some(slides),
            stays: &[Stay::Within("joints", joints_rad, [0.0, 4.0], 1e-3)],
            ..Row::new("slippery-ground", &[("friction_factor", ICE)], Scene::Brakes)
        },
        Row {
            shows: Some(spins),
            stays: OF_GRIP,
            ..Row::new("slippery-ground", &[("friction_factor", ICE)], Scene::Drives(1.0))
        },
        Row {
            both: &[("terrain-slope", &[("grade_x_rad", CLIMB_RAD)])],
            shows: Some(|seen| {
                let push_n = seen.machine.mass_kg() * GRAVITY_M_S2 * CLIMB_RAD.sin() / 6.0;
                slips(seen, 0.0, CREEP_M_S_N * push_n)
            }),
            stays: &[Stay::Within("speed in the end", mean_speed_rad_s, [9.8, 10.0], 5e-3)],
            ..Row::new("slippery-ground", &[("creep_m_s_n", CREEP_M_S_N)], Scene::Drives(1.0))
        },
    ]
}

/// How much lower than its radius a wheel's centre is, m, by the front frame's place, the strokes and straight joints.
fn sag_m(parts: &Parts, s: &VehicleState, wheel: Wheel) -> f64 {
    let [(sp, cp), (sr, cr)] = [s.pitch_rad, s.roll_rad].map(f64::sin_cos);
    let [x, y, z] = parts.wheel_centres_m(s.stroke_m)[wheel];
    parts.radius_m - (s.position_m[2] + x * sp - y * sr * cp + z * cr * cp)
}

/// Every wheel sinks by its load over its tyre's stiffness: the right ones on soft tyres, the left ones on those that the
/// machine file has.
fn sinks(seen: &Seen) -> Vec<Size> {
    let parts = Parts::new(&MACHINE, &Effects::default());
    let size = |w: Wheel| {
        let [_, sag_m] = seen.means([9.0, 10.0], |s| sag_m(&parts, s, w));
        let [_, load_n] = seen.means([9.0, 10.0], |s| s.ground_force_n[w]);
        let own_n_m = seen.machine.vehicle.tyre_stiffness_n_m;
        let stiffness_n_m = if w.side() == Side::Right { 4e5 } else { own_n_m };
        Size::new(format!("sag of {w}, m"), sag_m, load_n / stiffness_n_m, 5e-5)
    };
    Wheel::ALL.into_iter().map(size).collect()
}

/// While the machine, just set down, bounces on them, soft tyres push with what their springs do not explain by how fast
/// they are pressed in: damping by least squares.
fn bounces(seen: &Seen) -> Vec<Size> {
    let parts = Parts::new(&MACHINE, &Effects::default());
    let size = |w: Wheel| {
        let (mut product, mut square) = (0.0, 0.0);
        for pair in seen.with[..step_at(1.5)].windows(2) {
            let [before_m, sag_m] = [&pair[0], &pair[1]].map(|s| sag_m(&parts, s, w));
            let rate_m_s = (sag_m - before_m) / STEP.as_secs_f64();
            product += (pair[1].ground_force_n[w] - 4e5 * sag_m) * rate_m_s;
            square += rate_m_s * rate_m_s;
        }
        Size::new(format!("damping of {w}, N s/m"), product / square, 2e4, 2e3)
    };
    Wheel::ALL.into_iter().filter(|w| w.side() == Side::Right).map(size).collect()
}

/// Rims are faster than the machine by this share of their speed and by this much besides, m/s, than nominal ones.
fn slips(seen: &Seen, share: f64, besides_m_s: f64) -> Vec<Size> {
    let [from_s, to_s] = [7.0, 10.0];
    let way_m = |states: &[VehicleState]| {
        let [a, b] = [from_s, to_s].map(|t| states[step_at(t)].position_m);
        (b[0] - a[0]).hypot(b[2] - a[2])
    };
    let ways_m = [way_m(&seen.without), way_m(&seen.with)];
    let [start_m, end_m] = [seen.rolled_m(from_s), seen.rolled_m(to_s)];
    let slip_m_s = |i: usize| (end_m[i] - start_m[i] - ways_m[i]) / (to_s - from_s);
    let rim_m_s = (end_m[1] - start_m[1]) / (to_s - from_s);
    let wanted_m_s = share * rim_m_s + besides_m_s;
    vec![Size::new("slip, m/s", slip_m_s(1) - slip_m_s(0), wanted_m_s, 0.03 * wanted_m_s)]
}

/// A braked machine slides down with what friction leaves of its weight.
fn slides(seen: &Seen) -> Vec<Size> {
    let speed_m_s = |t_s: f64| -seen.with[step_at(t_s)].antenna_velocity_m_s[0] / BANK_RAD.cos();
    let gain_m_s2 = (speed_m_s(4.0) - speed_m_s(2.0)) / 2.0;
    let friction = ICE * seen.machine.wheels.friction;
    let wanted_m_s2 = GRAVITY_M_S2 * (BANK_RAD.sin() - friction * BANK_RAD.cos());
    let stood_m =
        seen.without[step_at(4.0)].position_m[0] - seen.without[step_at(2.0)].position_m[0];
    vec![
        Size::new("acceleration, m/s2", gain_m_s2, wanted_m_s2, 0.01 * wanted_m_s2),
        Size::new("on the road, m", stood_m, 0.0, 1e-3),
    ]
}

/// A wheel that spins evenly takes what friction and rolling resistance brake it with.
fn spins(seen: &Seen) -> Vec<Size> {
    let w = &seen.machine.wheels;
    let braked = (ICE * w.friction + w.rolling_resistance) * w.radius_m;
    let size = |wheel: Wheel| {
        let [_, torque_nm] = seen.means(SPINS_S, |s| s.wheel_torque_nm[wheel]);
        let [_, load_n] = seen.means(SPINS_S, |s| s.ground_force_n[wheel]);
        let [start, end] = SPINS_S.map(|t| seen.with[step_at(t)].wheel_speed_rad_s[wheel]);
        let turned_nm = seen.machine.masses.wheel_kg
            * seen.machine.vehicle.wheel_gyration_m.powi(2)
            * (end - start)
            / (SPINS_S[1] - SPINS_S[0]);
        let wanted_nm = braked * load_n + turned_nm;
        Size::new(format!("torque of {wheel}, Nm"), torque_nm, wanted_nm, 0.03 * wanted_nm)
    };
    [Wheel::Br, Wheel::Bl].into_iter().map(size).collect()
}
