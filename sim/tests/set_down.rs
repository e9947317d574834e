//! A vehicle set down on ground that is not level: it lies on it from the first step on.

use std::path::Path;

use xt28_machine::{Machine, PerWheel};
use xt28_sim::{
    Actuation, Bodies, Effects, Parts, Plant, RapierBodies, ReducedBodies, STEP, Terrain, Vehicle,
};

fn parts() -> Parts {
    Parts::new(&Machine::xt28(), &Effects::default())
}

fn grounds() -> Vec<Terrain> {
    let texts = [
        "kind = \"flat\"",
        "kind = \"slope\"\ngrade = 0.15",
        "kind = \"slope\"\ngrade = 0.2\nuphill_deg = 240",
        "kind = \"perlin\"\namplitude_m = 1.0\nwavelength_m = 10\nseed = 3",
    ];
    texts.iter().map(|text| Terrain::parse(text, Path::new("t.toml")).unwrap()).collect()
}

fn lies_where_it_should<B: Bodies>() {
    let (parts, stroke_m) = (parts(), PerWheel::splat(0.17));
    for terrain in grounds() {
        let (stance, motion) =
            (parts.stance(&terrain, stroke_m), B::new(&parts, &terrain, stroke_m).motion());
        for axis in 0..3 {
            assert!((motion.position_m[axis] - stance.position_m[axis]).abs() < 1e-5);
            for i in 0..3 {
                assert!((motion.axes[axis][i] - stance.axes[axis][i]).abs() < 1e-5, "{motion:?}");
            }
        }
    }
}

#[test]
fn rapier_lies_where_it_should() {
    lies_where_it_should::<RapierBodies>();
}

#[test]
fn the_fast_core_lies_where_it_should() {
    lies_where_it_should::<ReducedBodies>();
}

fn settles_without_a_fall<B: Bodies>() {
    for terrain in &grounds()[..3] {
        let mut vehicle = Vehicle::<B>::with(
            &Machine::xt28(),
            &Effects::default(),
            terrain,
            PerWheel::splat(0.17),
            STEP,
        );
        let mut fastest_m_s = 0.0_f64;
        for _ in 0..200 {
            vehicle.step(&Actuation::idle(1200.0));
            let velocity = vehicle.state().antenna_velocity_m_s;
            fastest_m_s = fastest_m_s.max(velocity.iter().map(|v| v * v).sum::<f64>().sqrt());
        }
        // It sinks onto its accumulators; a fall of 5 cm would end at 1 m/s.
        assert!(fastest_m_s < 0.6, "{fastest_m_s} m/s");
    }
}

#[test]
fn rapier_settles_without_a_fall() {
    settles_without_a_fall::<RapierBodies>();
}

#[test]
fn the_fast_core_settles_without_a_fall() {
    settles_without_a_fall::<ReducedBodies>();
}
