//! Many vehicles at once against each alone.

use std::sync::Arc;

use rayon::ThreadPoolBuilder;
use xt28_machine::{Machine, PerWheel};
use xt28_sim::effects::{CATALOGUE, Scope};
use xt28_sim::terrain::{Extent, Grid};
use xt28_sim::{
    Actuation, Bodies, Effects, Fleet, Plant, RapierBodies, ReducedBodies, STEP, Terrain, Vehicle,
    VehicleState,
};

const VEHICLES: usize = 7;
/// Steps a call, calls.
const STEPS: u32 = 10;
const CALLS: usize = 20;

fn rough() -> Terrain {
    let extent = Extent { x_m: [-6.0, 12.0], y_m: [-6.0, 6.0] };
    Terrain::Grid(Arc::new(Grid::from_fn(extent, |x, y| {
        0.05 * ((3.0 * x).sin() + (2.0 * y).cos())
    })))
}

/// Each with another effect of the catalogue, three tolerances of its first parameter.
fn vehicles<B: Bodies>() -> Vec<Vehicle<B>> {
    let (machine, ground) = (Machine::xt28(), rough());
    let vehicle = |i: usize| {
        let mut effects = Effects::default();
        let p = &CATALOGUE[5 * i].parameters[0];
        let [low, high] = p.range;
        p.set(&mut effects, Scope::All, (p.neutral + 3.0 * p.tolerance).clamp(low, high));
        Vehicle::with(&machine, &effects, &ground, PerWheel::splat(0.17), STEP)
    };
    (0..VEHICLES).map(vehicle).collect()
}

/// Asks of each what its number and its state say.
#[allow(clippy::cast_precision_loss)]
fn policy(i: usize, state: &VehicleState) -> Actuation {
    let lift = (0.2 - state.stroke_m.mean()).clamp(-1.0, 1.0);
    Actuation {
        pump_displacement: [0.1 * i as f64; 2],
        arm_opening: PerWheel::splat(lift),
        ..Actuation::idle(1200.0)
    }
}

fn as_each_alone<B: Bodies + Clone + Send>() {
    let run = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut fleet: Fleet<B> = vehicles().into_iter().collect();
        pool.install(|| (0..CALLS).for_each(|_| fleet.step(STEPS, policy)));
        (0..fleet.len()).map(|i| *fleet.state(i)).collect::<Vec<VehicleState>>()
    };
    let alone = vehicles::<B>().into_iter().enumerate().map(|(i, mut vehicle)| {
        for _ in 0..CALLS {
            let actuation = policy(i, vehicle.state());
            (0..STEPS).for_each(|_| vehicle.step(&actuation));
        }
        *vehicle.state()
    });
    let alone: Vec<VehicleState> = alone.collect();
    assert_ne!(alone[0].position_m, alone[1].position_m);
    assert_eq!(run(1), alone);
    assert_eq!(run(3), alone);
}

#[test]
fn a_vehicle_goes_its_way_whoever_is_beside_it_and_on_however_many_threads() {
    as_each_alone::<ReducedBodies>();
    as_each_alone::<RapierBodies>();
}

#[test]
fn an_episode_begins_anew_from_a_snapshot() {
    let mut fleet: Fleet = vehicles().into_iter().collect();
    fleet.step(STEPS, policy);
    let begun = fleet.snapshot(3);
    fleet.step(STEPS, policy);
    let went = *fleet.state(3);
    fleet.restart(3, begun);
    let others = *fleet.state(2);
    assert_ne!(*fleet.state(3), went);
    assert_eq!(*fleet.state(2), others);
    fleet.step(STEPS, policy);
    assert_eq!(*fleet.state(3), went);
}

#[test]
fn an_empty_fleet_has_nothing_to_do() {
    let mut fleet: Fleet = std::iter::empty().collect();
    fleet.step(STEPS, policy);
    assert!(fleet.is_empty());
}
