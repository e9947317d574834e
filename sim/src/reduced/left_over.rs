//! What a step leaves out of balance, against what the solver says that it leaves.

use xt28_machine::PerWheel;

use super::ReducedBodies;
use super::contact::Body;
use super::pose::{FREEDOMS, Generalized, Pose, State, WHEELS};
use super::spatial::add;
use super::tests::{inertias, mass_matrix, parts};
use super::touch::patches;
use super::tree::Tree;
use crate::Terrain;
use crate::bodies::{Bodies, HingeSpring, Loads, RollingDrag};

/// What is out of balance at the velocities that a step ended with, worked out anew from the bodies' masses, as a
/// velocity of the whole machine, m/s.
fn out_of_balance_m_s(before: &ReducedBodies, after: &State, loads: &Loads, dt_s: f64) -> f64 {
    let (tree, state) = (&before.tree, &before.state);
    let pose = Pose::new(tree, state);
    let inertias = inertias(tree, &pose);
    let mut balance = super::balance((tree, state), (&pose, &inertias), loads, dt_s);
    let rate = super::alone::ended(after, dt_s);
    let gained: Generalized = core::array::from_fn(|k| rate[k] - state.rate[k]);

    let mut contacts = Vec::new();
    let patches = patches(tree, (&pose, state), dt_s);
    before.search.clone().contacts((tree, &pose, state), &patches, dt_s, &mut contacts);
    let (mut on_wheel, mut on_frame) = ([[0.0; 6]; 6], [[0.0; 6]; 3]);
    let frames = pose.frame_twists(&rate);
    for mut contact in contacts {
        contact.held = false;
        let (twist, on) = match contact.body {
            Body::Wheel(i) => {
                let arm = pose.arm_twist(i, &frames[Tree::frame_of(i)], &rate);
                (pose.wheel_twist(i, &arm, &rate), &mut on_wheel[i])
            }
            Body::Frame(i) => (frames[i], &mut on_frame[i]),
        };
        contact.guess(&twist);
        add(on, &contact.wrench_of(&contact.now.impulse));
    }
    let mut made = super::newton::generalised(&pose, &on_wheel, on_frame);
    for (i, axle) in balance.axles.iter_mut().enumerate() {
        axle.set_step(gained[WHEELS + i]);
        axle.try_share(1.0);
        axle.take();
        made[WHEELS + i] += axle.impulse();
    }
    let matrix = mass_matrix(tree, state);
    let left: Generalized = core::array::from_fn(|k| {
        let inertial: f64 = (0..FREEDOMS).map(|j| matrix[j][k] * gained[j]).sum();
        inertial + balance.hinge[k] * gained[k] + balance.lack[k] - made[k]
    });
    balance.size_m_s(&left)
}

/// Rolling resistance is steepest where a wheel comes to rest, and that is where what the solver believes to be left
/// and what is left could part: steps with factors of an iteration ago foresee what those were made of.
#[test]
fn what_the_solver_says_is_left_is_left() {
    let dt_s = 1.0 / 120.0;
    let mut bodies = ReducedBodies::new(&parts(), &Terrain::Flat, PerWheel::splat(0.2));
    let still = bodies.motion();
    let hold = |rest_rad: f64| HingeSpring { stiffness_nm: 5e5, damping_nms: 5e4, rest_rad };
    let (mut worst_m_s, mut slow) = (0.0_f64, 0);
    for step in 0..900 {
        let motion = bodies.motion();
        let loads = Loads {
            arm: still.arm.map(|arm| hold(arm.angle_rad)),
            joint: [hold(0.0); 2],
            drive_nm: PerWheel::splat(if step % 300 < 150 { 4000.0 } else { 0.0 }),
            drag: motion
                .wheel_rate_rad_s
                .map(|rate_rad_s| RollingDrag::tanh(3000.0, 0.05, rate_rad_s)),
            ..Loads::default()
        };
        let before = bodies.clone();
        bodies.advance(&loads, dt_s);
        let left_m_s = out_of_balance_m_s(&before, &bodies.state, &loads, dt_s);
        worst_m_s = worst_m_s.max(left_m_s);
        let rates_rad_s = motion.wheel_rate_rad_s.0;
        slow += usize::from(rates_rad_s.iter().any(|rate| (0.01..0.2).contains(&rate.abs())));
    }
    assert!(slow > 20, "{slow} steps near rest");
    assert!(worst_m_s < 2e-9, "{worst_m_s} m/s");
}
