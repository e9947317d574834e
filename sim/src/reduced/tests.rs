//! The tree's dynamics against what they must equal: sums over bodies, and what is conserved.

use glam::{DMat3, DQuat, DVec3};
use proptest::prelude::*;
use xt28_machine::{Machine, PerWheel};

use super::ReducedBodies;
use super::factor::Factors;
use super::newton::Convergence;
use super::pose::{FREEDOMS, Generalized, Inertias, Pose, ROLL, State, WHEELS};
use super::spatial::{
    Spatial, Spatial6, ZERO6, angular, apply, dot, linear, velocity_at, wrench_at, write_rigid,
};
use super::tree::Tree;
use crate::bodies::{Bodies, HingeSpring, Loads, RollingDrag};
use crate::{Effects, HullBall, Parts, RollHinge, Terrain, TyrePart};

pub(super) fn parts() -> Parts {
    Parts::new(&Machine::xt28(), &Effects::default())
}

/// With a limp roll hinge.
fn rolling() -> Parts {
    let limp = RollHinge { stiffness_nm: 0.0, damping_nms: 0.0, max_rad: 10.0 };
    Parts { roll_hinge: Some(limp), ..parts() }
}

/// A state off the middle in everything.
fn bent(seed: f64) -> State {
    let wave = |i: usize, size: f64| size * (seed + 1.7 * i as f64).sin();
    State {
        position: DVec3::new(wave(1, 5.0), wave(2, 5.0), 3.0),
        turn: DQuat::from_euler(glam::EulerRot::ZYX, wave(3, 3.0), wave(4, 0.5), wave(5, 0.5)),
        joint_rad: [wave(6, 0.4), wave(7, 0.4)],
        roll_rad: wave(15, 0.2),
        bristle_m: [[0.0; 2]; 6],
        arm_rad: core::array::from_fn(|i| wave(8 + i, 0.3)),
        rate: core::array::from_fn(|i| wave(20 + i, if i < WHEELS { 0.7 } else { 3.0 })),
    }
}

pub(super) fn inertias(tree: &Tree, pose: &Pose) -> Inertias {
    let mut inertias = Inertias::default();
    inertias.renew(tree, pose);
    inertias
}

/// Twists of all bodies under generalised velocities, with each body's spatial inertia applied.
pub(super) fn momenta(tree: &Tree, state: &State, rate: &Generalized) -> Vec<(Spatial, Spatial)> {
    let pose = Pose::new(tree, state);
    let about = inertias(tree, &pose).about_com;
    let of = |mass_kg: f64, com: DVec3, about: &DMat3, twist: &Spatial| {
        let mut inertia = ZERO6;
        write_rigid(&mut inertia, mass_kg, com, about);
        (*twist, apply(&inertia, twist))
    };
    let frames = pose.frame_twists(rate);
    let mut out: Vec<(Spatial, Spatial)> = (0..3)
        .map(|i| of(tree.frames[i].mass_kg, pose.frame[i].com, &about.frame[i], &frames[i]))
        .collect();
    for i in 0..6 {
        let arm = pose.arm_twist(i, &frames[Tree::frame_of(i)], rate);
        let wheel = pose.wheel_twist(i, &arm, rate);
        let (part, at) = (&tree.arms[i], &pose.arm[i]);
        out.push(of(part.mass_kg, at.com, &about.arm[i], &arm));
        out.push(of(part.wheel_kg, at.wheel, &about.wheel[i], &wheel));
    }
    out
}

/// The mass matrix by columns: J^T I J summed over the bodies.
pub(super) fn mass_matrix(tree: &Tree, state: &State) -> Vec<Generalized> {
    let unit = |k: usize| -> Generalized { core::array::from_fn(|i| f64::from(u8::from(i == k))) };
    let bodies: Vec<_> = (0..FREEDOMS).map(|k| momenta(tree, state, &unit(k))).collect();
    let entry = |j: usize, k: usize| {
        bodies[j]
            .iter()
            .zip(&bodies[k])
            .map(|((twist, _), (_, momentum))| dot(twist, momentum))
            .sum()
    };
    (0..FREEDOMS).map(|k| core::array::from_fn(|j| entry(j, k))).collect()
}

/// Adds a 3 x 3 matrix that acts on the velocity of the point `at`: m += X^T g X.
fn add_at_point(m: &mut Spatial6, g: &DMat3, at: DVec3) {
    let x = wrench_at(g.x_axis, at);
    let y = wrench_at(g.y_axis, at);
    let z = wrench_at(g.z_axis, at);
    // A unit turn about an axis moves the point along the other two.
    for i in 0..6 {
        m[0][i] += z[i] * at.y - y[i] * at.z;
        m[1][i] += x[i] * at.z - z[i] * at.x;
        m[2][i] += y[i] * at.x - x[i] * at.y;
        m[3][i] += x[i];
        m[4][i] += y[i];
        m[5][i] += z[i];
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn the_factors_solve_the_sum_over_bodies(
        seed in 0.0..100.0_f64,
        sliding in any::<bool>(),
        rolls in any::<bool>(),
    ) {
        let tree = Tree::new(&if rolls { rolling() } else { parts() });
        let state = bent(seed);
        let (pose, inertias) = {
            let pose = Pose::new(&tree, &state);
            let inertias = inertias(&tree, &pose).spatial;
            (pose, inertias)
        };
        let (mut frame, mut both) = (inertias.frame, inertias.arm);
        let hinge: Generalized = core::array::from_fn(|k| {
            if k < 6 { 0.0 } else { 100.0 * (1.0 + (seed * k as f64).sin()) }
        });
        // A contact under one wheel and one under a frame; sliding makes it lopsided.
        let g = DMat3::from_cols_array(&[9e2, 0.0, 0.0, 0.0, 4e2, 0.0,
            if sliding { -3e2 } else { 0.0 }, 0.0, 7e2]);
        let at = pose.arm[3].wheel - DVec3::Z * 0.7;
        add_at_point(&mut both[3], &g, at);
        add_at_point(&mut frame[1], &g, pose.frame[1].com);

        let mut right: Generalized = core::array::from_fn(|k| (seed + k as f64).cos());
        if !rolls {
            right[ROLL] = 0.0;
        }
        let mut factors = Factors::new();
        for (i, both) in both.iter().enumerate() {
            let column = &inertias.arm_column[i];
            let taken = factors.take_wheel(&pose, i, |out| *out = *both, column, &hinge);
            prop_assert!(taken.is_some());
        }
        prop_assert!(factors.take_frames(&pose, frame, &hinge).is_some());
        let x = factors.solve(&pose, &right);

        let frames = pose.frame_twists(&x);
        let twist = pose.wheel_twist(3, &pose.arm_twist(3, &frames[1], &x), &x);
        let on_wheel = wrench_at(g * velocity_at(&twist, at), at);
        let com = pose.frame[1].com;
        let mut wrenches = [[0.0; 6]; 6];
        wrenches[3] = on_wheel;
        let on_frame = [[0.0; 6], wrench_at(g * velocity_at(&frames[1], com), com), [0.0; 6]];
        let contacts = super::newton::generalised(&pose, &wrenches, on_frame);
        let matrix = mass_matrix(&tree, &state);
        for k in 0..FREEDOMS {
            let inertial: f64 = (0..FREEDOMS).map(|j| matrix[j][k] * x[j]).sum();
            let left = inertial + hinge[k] * x[k] + contacts[k];
            prop_assert!((left - right[k]).abs() < 1e-9, "{k}: {left} is not {}", right[k]);
        }
    }
}

/// Kinetic energy, and momentum about the world's origin.
fn conserved(bodies: &ReducedBodies) -> (f64, DVec3, DVec3) {
    let state = &bodies.state;
    let all = momenta(&bodies.tree, state, &state.rate);
    let energy = all.iter().map(|(twist, momentum)| 0.5 * dot(twist, momentum)).sum();
    let p: DVec3 = all.iter().map(|(_, momentum)| linear(momentum)).sum();
    let l: DVec3 = all.iter().map(|(_, momentum)| angular(momentum)).sum();
    (energy, p, l + state.position.cross(p))
}

/// Energy, momentum and angular momentum lost by a tumbling, swinging machine in 1 s, as shares.
fn lost(dt_s: f64) -> [f64; 3] {
    let mut weightless = rolling();
    weightless.gravity_m_s2 = [0.0; 3];
    let mut bodies = ReducedBodies::new(&weightless, &Terrain::Flat, PerWheel::splat(0.2));
    bodies.state = bent(0.3);
    bodies.state.position.z = 100.0;
    let (e0, p0, l0) = conserved(&bodies);
    for _ in 0..(1.0 / dt_s).round() as usize {
        bodies.advance(&Loads::default(), dt_s);
    }
    let (e, p, l) = conserved(&bodies);
    [(e / e0 - 1.0).abs(), (p - p0).length() / p0.length(), (l - l0).length() / l0.length()]
}

#[test]
fn a_free_machine_keeps_its_energy_and_momentum() {
    let (coarse, fine) = (lost(1e-3), lost(1e-4));
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        assert!(fine < 2e-3, "{fine}");
        // First order: a tenth of the step, a tenth of the error.
        assert!(fine < 0.2 * coarse, "{coarse} {fine}");
    }
}

#[test]
fn a_falling_machine_falls() {
    let mut bodies = ReducedBodies::new(&parts(), &Terrain::Flat, PerWheel::splat(0.25));
    bodies.state.position.z = 100.0;
    for _ in 0..100 {
        bodies.advance(&Loads::default(), 0.01);
    }
    let motion = bodies.motion();
    assert!((motion.velocity_m_s[2] + 9.81).abs() < 1e-9, "{:?}", motion.velocity_m_s);
    assert!(motion.arm.0.iter().all(|arm| arm.angle_rad.abs() < 1e-9), "nothing else moves");
}

#[test]
fn every_step_on_rough_ground_ends_in_balance() {
    let rough = crate::terrain::Grid::from_fn(crate::terrain::Extent::default(), |x, y| {
        0.1 * (1.7 * x).sin() * (2.3 * y).cos() + 0.04 * (11.0 * x + 7.0 * y).sin()
    });
    let terrain = Terrain::Grid(std::sync::Arc::new(rough));
    for rate_hz in [60.0, 120.0, 200.0] {
        let mut bodies = ReducedBodies::new(&parts(), &terrain, PerWheel::splat(0.2));
        let motion = bodies.motion();
        let hold = |angle_rad: f64, stiffness_nm: f64| HingeSpring {
            stiffness_nm,
            damping_nms: 0.05 * stiffness_nm,
            rest_rad: angle_rad,
        };
        let (mut most, mut sum) = (0, 0);
        let steps = (10.0 * rate_hz) as usize;
        for i in 0..steps {
            let bend = (i as f64 / rate_hz).sin();
            bodies.advance(
                &Loads {
                    arm: motion.arm.map(|arm| hold(arm.angle_rad + 0.05, 5.0e5)),
                    joint: [hold(0.3 * bend, 2.5e6), hold(-0.2 * bend, 2.5e6)],
                    drive_nm: PerWheel::splat(900.0),
                    ..Loads::default()
                },
                1.0 / rate_hz,
            );
            let Convergence { iterations, residual_m_s } = bodies.convergence;
            assert!(residual_m_s < 1e-9, "{rate_hz} Hz, step {i}: {residual_m_s} m/s");
            most = most.max(iterations);
            sum += iterations;
        }
        assert!(sum < 8 * steps, "{rate_hz} Hz: {} iterations a step, at most {most}", sum / steps);
    }
}

#[test]
fn a_sprung_roll_hinge_lets_a_side_follow_the_ground_and_stops_where_it_must() {
    let spring =
        |stiffness_nm: f64, max_rad: f64| RollHinge { stiffness_nm, damping_nms: 2e4, max_rad };
    // A step of 0.2 m under the right wheels of the front frame alone.
    let step = crate::terrain::Grid::from_fn(crate::terrain::Extent::default(), |x, y| {
        if x > -1.5 && y < 0.0 { 0.2 } else { 0.0 }
    });
    let terrain = Terrain::Grid(std::sync::Arc::new(step));
    let rolled = |roll_hinge: Option<RollHinge>| {
        let parts = Parts { roll_hinge, ..parts() };
        let mut bodies = ReducedBodies::new(&parts, &terrain, PerWheel::splat(0.25));
        bodies.state.position.z += 0.2;
        let hold = |rest_rad| HingeSpring { stiffness_nm: 2e6, damping_nms: 2e5, rest_rad };
        let loads = Loads {
            arm: PerWheel::splat(hold(0.05)),
            joint: [hold(0.0); 2],
            hold_nm: PerWheel::splat(2e4),
            ..Loads::default()
        };
        for _ in 0..1200 {
            bodies.advance(&loads, 1.0 / 120.0);
        }
        assert!(bodies.state.rate.iter().all(|rate| rate.abs() < 1e-3), "it stands");
        bodies.state.roll_rad.abs()
    };
    let (limp, stiff) = (rolled(Some(spring(0.0, 1.0))), rolled(Some(spring(1e8, 1.0))));
    let (stopped, none) = (rolled(Some(spring(0.0, 0.02))), rolled(None));
    // 0.2 m over a track of 2.35 m is 0.085 rad.
    assert!((0.06..0.09).contains(&limp), "{limp}");
    assert!(stiff < 0.005 && none == 0.0, "{stiff} {none}");
    assert!((0.02..0.04).contains(&stopped), "{stopped}");
}

/// On ice a wheel has only its own inertia against the rolling resistance. Where that is steep, as in
/// slush, it stops the wheel and does not turn it around: it takes energy and gives none.
#[test]
fn rolling_resistance_on_ice_stops_a_sliding_wheel_and_does_not_turn_it_around() {
    let mut parts = parts();
    parts.tyres = parts.tyres.map(|tyre| TyrePart { friction: 0.05, ..tyre });
    for (rate_hz, share) in [(200.0, 0.02), (200.0, 0.3), (60.0, 0.05), (60.0, 0.3)] {
        let mut bodies = ReducedBodies::new(&parts, &Terrain::Flat, PerWheel::splat(0.2));
        let hold = |angle_rad: f64| HingeSpring {
            stiffness_nm: 5.0e5,
            damping_nms: 5.0e4,
            rest_rad: angle_rad,
        };
        let still = bodies.motion();
        let step = |bodies: &mut ReducedBodies, spins: bool| {
            let motion = bodies.motion();
            let drag = PerWheel::from_fn(|w| {
                let most_nm = if spins { share * motion.ground_force_n[w] * 0.74 } else { 0.0 };
                RollingDrag::tanh(most_nm, 0.05, motion.wheel_rate_rad_s[w])
            });
            let arm = still.arm.map(|arm| hold(arm.angle_rad));
            let joint = [hold(0.0); 2];
            bodies.advance(&Loads { arm, joint, drag, ..Loads::default() }, 1.0 / rate_hz);
            bodies.state.rate[WHEELS..WHEELS + 6].to_vec()
        };
        // Set down first: a falling machine has energy of its own.
        (0..600).for_each(|_| drop(step(&mut bodies, false)));
        bodies.state.rate[WHEELS..WHEELS + 6].fill(3.0);
        let mut before = vec![3.0_f64; 6];
        for i in 0..300 {
            let after = step(&mut bodies, true);
            for (wheel, (&after, &before)) in after.iter().zip(&before).enumerate() {
                // What moves on takes its wheels along.
                let rolls_rad_s = bodies.motion().velocity_m_s[0] / 0.74;
                let bounds = -0.01..before.max(rolls_rad_s + 0.05);
                assert!(
                    bounds.contains(&after),
                    "{rate_hz} Hz, {share}, step {i}, wheel {wheel}: {before} to {after} rad/s"
                );
            }
            assert!(bodies.convergence.residual_m_s < 1e-9, "{:?}", bodies.convergence);
            before = after;
        }
    }
}

/// How long the hull is not looked at follows from how far it reaches: a long nose that swings down meets
/// the ground in the step in which it gets there.
#[test]
fn a_long_hull_that_swings_down_is_seen_in_time() {
    let mut parts = parts();
    parts.hulls[0].push(HullBall { centre_m: [15.0, 0.0, 1.0], radius_m: 0.1 });
    let mut bodies = ReducedBodies::new(&parts, &Terrain::Flat, PerWheel::splat(0.2));
    bodies.state.turn = DQuat::from_rotation_y(-0.05) * bodies.state.turn;
    bodies.state.position.z = 1.2;
    bodies.state.rate[1] = 1.0;
    let mut careful = bodies.clone();
    let mut hit = false;
    for step in 0..120 {
        careful.search.look_again();
        for one in [&mut bodies, &mut careful] {
            one.advance(&Loads::default(), 0.005);
        }
        let [seen_n, wanted_n] = [&bodies, &careful].map(|one| one.motion().chassis_force_n);
        assert_eq!(seen_n, wanted_n, "step {step}");
        hit |= wanted_n > 0.0;
    }
    assert!(hit, "it never came down");
}
