//! Our solvers against MuJoCo's recorded word on every manoeuvre.
//!
//! The recordings are MuJoCo 4.0.0 at 2000 Hz on the model of `tools/yardstick`, made by
//! `cargo xtask second-engine --only record`. They say what another engine makes of the same parts
//! and laws; what they leave apart and why is in `docs/second-engine.md`. The bounds are some half
//! above what was seen, so a slip in a sign, an inertia or a law falls out and a new time step does not.
// Half of it serves another program.
#![allow(dead_code)]

#[path = "../examples/trajectory/manoeuvre.rs"]
mod manoeuvre;

use manoeuvre::{Manoeuvre, Sample, terrain, yardstick};
use xt28_machine::{Machine, PerWheel};
use xt28_sim::{Bodies, Effects, RapierBodies, ReducedBodies, STEP, Vehicle};

/// Steps per second of the plant as the bench runs it.
const RATE_HZ: u32 = 200;

/// Largest distance allowed, by the start of a column's name; SI units and radians.
type Bounds = [(&'static str, f64); 10];

/// Falling 3 cm into the locks: the first half second is the time step's as much as the engine's.
const SETTLE: Bounds = [
    ("x_m", 2e-3),
    ("y_m", 1e-4),
    ("z_m", 5e-3),
    ("yaw", 1e-4),
    ("roll", 1e-4),
    ("pitch", 1.4e-3),
    ("joint", 1e-4),
    ("stroke", 2.5e-3),
    ("wheel_speed", 0.16),
    ("ground_force", 3500.0),
];
/// Start, roll, stop and stand.
const STRAIGHT: Bounds = [
    ("x_m", 4e-3),
    ("y_m", 1e-4),
    ("z_m", 6e-4),
    ("yaw", 1e-4),
    ("roll", 1e-4),
    ("pitch", 1e-4),
    ("joint", 1e-4),
    ("stroke", 1.5e-4),
    ("wheel_speed", 6e-3),
    ("ground_force", 120.0),
];
/// A bend; wheels that scrub turn otherwise on rapier3d.
const TURN: Bounds = [
    ("x_m", 0.035),
    ("y_m", 0.02),
    ("z_m", 6e-4),
    ("yaw", 7e-3),
    ("roll", 7e-4),
    ("pitch", 1.2e-4),
    ("joint", 4e-3),
    ("stroke", 6e-4),
    ("wheel_speed", 0.15),
    ("ground_force", 260.0),
];
/// A bend on the fast core.
const TURN_REDUCED: Bounds = [
    ("x_m", 4e-3),
    ("y_m", 4e-3),
    ("z_m", 2e-4),
    ("yaw", 2e-4),
    ("roll", 1e-4),
    ("pitch", 1.2e-4),
    ("joint", 4e-4),
    ("stroke", 2e-4),
    ("wheel_speed", 6e-3),
    ("ground_force", 150.0),
];

/// Arms lifted and lowered while the machine stands.
const ARMS: Bounds = [
    ("x_m", 9e-4),
    ("y_m", 1.3e-4),
    ("z_m", 4.5e-4),
    ("yaw", 1.7e-4),
    ("roll", 3.2e-4),
    ("pitch", 8e-5),
    ("joint", 2.1e-4),
    ("stroke", 3e-4),
    ("wheel_speed", 0.023),
    ("ground_force", 170.0),
];
/// Up with the right wheels and down again: MuJoCo's wheels touch each triangle that they cut, at the edges of
/// the ramp two or three at once.
const RAMP: Bounds = [
    ("x_m", 0.048),
    ("y_m", 9e-3),
    ("z_m", 0.013),
    ("yaw", 2.8e-3),
    ("roll", 0.012),
    ("pitch", 2.5e-3),
    ("joint", 2.4e-3),
    ("stroke", 9.7e-3),
    ("wheel_speed", 0.69),
    ("ground_force", 12_500.0),
];
/// Humps and boulders, with a bend; the same of its edges, which are everywhere.
const ROUGH: Bounds = [
    ("x_m", 0.012),
    ("y_m", 0.013),
    ("z_m", 9.5e-3),
    ("yaw", 3.8e-3),
    ("roll", 3.2e-3),
    ("pitch", 1.3e-3),
    ("joint", 3.5e-3),
    ("stroke", 5.4e-3),
    ("wheel_speed", 0.41),
    ("ground_force", 10_200.0),
];

#[test]
fn settling_agrees_with_mujoco() {
    agrees::<RapierBodies>("settle", &SETTLE);
    agrees::<ReducedBodies>("settle", &SETTLE);
}

#[test]
fn arms_that_move_agree_with_mujoco() {
    agrees::<RapierBodies>("arms", &ARMS);
    agrees::<ReducedBodies>("arms", &ARMS);
}

#[test]
fn ground_that_is_not_level_agrees_with_mujoco() {
    for (name, bounds) in [("ramp", RAMP), ("rough", ROUGH)] {
        agrees::<RapierBodies>(name, &bounds);
        agrees::<ReducedBodies>(name, &bounds);
    }
}

#[test]
fn a_straight_drive_agrees_with_mujoco() {
    agrees::<RapierBodies>("straight", &STRAIGHT);
    agrees::<ReducedBodies>("straight", &STRAIGHT);
}

#[test]
fn a_bend_agrees_with_mujoco() {
    agrees::<RapierBodies>("turn", &TURN);
    agrees::<ReducedBodies>("turn", &TURN_REDUCED);
}

#[test]
fn a_machine_with_a_rear_frame_heavier_by_a_twentieth_does_not_agree() {
    let mut heavier = Machine::xt28();
    heavier.masses.rear_frame_kg *= 1.05;
    let apart = distances::<RapierBodies>("straight", &heavier);
    let [.., (signal, bound)] = STRAIGHT;
    let rear =
        apart.iter().filter(|(column, _)| column.starts_with(signal) && column.contains('B'));
    assert!(rear.clone().count() == 2 && rear.clone().all(|(_, newtons)| *newtons > bound));
}

fn agrees<B: Bodies>(name: &str, bounds: &Bounds) {
    let apart = distances::<B>(name, &Machine::xt28());
    for (signal, bound) in bounds {
        let mut columns = apart.iter().filter(|(column, _)| column.starts_with(signal)).peekable();
        assert!(columns.peek().is_some(), "no column {signal}");
        for (column, distance) in columns {
            assert!(distance <= bound, "{name}: {column} is {distance:.4} apart, {bound} allowed");
        }
    }
}

/// Largest distance of each column from MuJoCo's.
fn distances<B: Bodies>(name: &str, machine: &Machine) -> Vec<(String, f64)> {
    let recorded = std::fs::read_to_string(yardstick().join(format!("recorded/{name}.csv")))
        .expect("recorded by `cargo xtask second-engine --only record`");
    let (header, rows) = recorded.split_once('\n').expect("a header");
    assert_eq!(header, Sample::header(), "other columns: record again");
    let manoeuvre = Manoeuvre::load(name).expect("the file of manoeuvres has it");
    let strokes = PerWheel::splat(manoeuvre.start_stroke_m);
    let effects = Effects::default();
    let ground = terrain(&manoeuvre.terrain).expect("the manoeuvre's ground");
    let mut vehicle = Vehicle::<B>::with(machine, &effects, &ground, strokes, STEP);
    manoeuvre.settle(&mut vehicle, RATE_HZ);

    let mut apart: Vec<(String, f64)> = header.split(',').map(|c| (c.to_owned(), 0.0)).collect();
    let mut rows = rows.lines();
    manoeuvre.drive(&mut vehicle, RATE_HZ, |sample| {
        let row = rows.next().expect("as many samples as were recorded");
        let theirs = row.split(',').map(|number| number.parse::<f64>().expect("a number"));
        for (((_, worst), theirs), ours) in apart.iter_mut().zip(theirs).zip(sample.numbers()) {
            *worst = worst.max((ours - theirs).abs());
        }
    });
    assert!(rows.next().is_none(), "fewer samples than were recorded");
    assert!(apart[0].1 < 1e-6, "other times than were recorded");
    apart
}
