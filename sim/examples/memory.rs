//! What one more environment takes of memory, beyond the terrain that all of them share.
//!
//! ```sh
//! cargo run --release -p xt28-sim --example memory
//! ```
// A program: it prints.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)]

use std::alloc::System;

use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use xt28_machine::{Machine, PerWheel};
use xt28_sim::{
    Actuation, Bodies, Effects, Plant, RapierBodies, ReducedBodies, STEP, Terrain, Vehicle,
};

#[global_allocator]
static COUNTED: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Environments over which the figure is a mean.
const ENVIRONMENTS: usize = 16;
/// Steps before it is read: buffers have grown by then.
const STEPS: usize = 600;

fn main() -> Result<(), String> {
    let rough = concat!(env!("CARGO_MANIFEST_DIR"), "/../tools/yardstick/rough.toml");
    let ground = Terrain::load(rough.as_ref()).map_err(|error| error.to_string())?;
    println!("\n| engine | KiB an environment | allocations a step |");
    println!("|---|---|---|");
    measure::<RapierBodies>("rapier", &ground);
    measure::<ReducedBodies>("reduced", &ground);
    Ok(())
}

#[allow(clippy::cast_precision_loss)]
fn measure<B: Bodies>(name: &str, ground: &Terrain) {
    let drive = Actuation { pump_displacement: [0.8; 2], ..Actuation::idle(1200.0) };
    let (machine, effects) = (Machine::xt28(), Effects::default());
    let mut vehicles = Vec::with_capacity(ENVIRONMENTS);
    let region = Region::new(COUNTED);
    for _ in 0..ENVIRONMENTS {
        let strokes = PerWheel::splat(0.17);
        let mut vehicle = Vehicle::<B>::with(&machine, &effects, ground, strokes, STEP);
        (0..STEPS).for_each(|_| vehicle.step(&drive));
        vehicles.push(vehicle);
    }
    let built = region.change();
    let held = built.bytes_allocated.saturating_sub(built.bytes_deallocated) / ENVIRONMENTS;
    let kib = (held + size_of::<Vehicle<B>>()) as f64 / 1024.0;

    let region = Region::new(COUNTED);
    for vehicle in &mut vehicles {
        (0..STEPS).for_each(|_| vehicle.step(&drive));
    }
    let allocations = region.change().allocations as f64 / (ENVIRONMENTS * STEPS) as f64;
    println!("| {name} | {kib:.0} | {allocations:.0} |");
}
