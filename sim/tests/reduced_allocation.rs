//! A step of the fast core takes no memory. Alone in its program: the counter is the whole program's.

use std::alloc::System;
use std::sync::Arc;
use std::time::Duration;

use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use xt28_machine::{Machine, PerWheel};
use xt28_sim::terrain::{Extent, Grid};
use xt28_sim::{Actuation, Effects, Plant, ReducedBodies, Terrain, Vehicle};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

#[test]
fn a_step_allocates_nothing() {
    let rough = Grid::from_fn(Extent::default(), |x, y| {
        0.15 * (1.1 * x).sin() * (0.9 * y + 0.4).cos() + 0.03 * (7.0 * x - 5.0 * y).sin()
    });
    for terrain in [Terrain::Flat, Terrain::Grid(Arc::new(rough))] {
        let step = Duration::from_secs_f64(1.0 / 120.0);
        let (machine, effects) = (Machine::xt28(), Effects::default());
        let strokes = PerWheel::splat(0.17);
        let mut vehicle =
            Vehicle::<ReducedBodies>::with(&machine, &effects, &terrain, strokes, step);
        let drive = Actuation {
            pump_displacement: [1.0; 2],
            steer_opening: [0.2, 0.1],
            ..Actuation::idle(1200.0)
        };
        vehicle.step(&drive);
        // The harness has a thread of its own that may allocate meanwhile: once, and not each time.
        let counts = [(); 3].map(|()| {
            let region = Region::new(ALLOCATOR);
            for _ in 0..200 {
                vehicle.step(&drive);
            }
            let change = region.change();
            change.allocations + change.reallocations
        });
        assert_eq!(counts.into_iter().min(), Some(0));
    }
}
