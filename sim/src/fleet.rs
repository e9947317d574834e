//! Many vehicles at once, on all cores: what a trainer runs its policy against.

use rayon::prelude::*;

use crate::{Actuation, Bodies, Plant, ReducedBodies, Vehicle, VehicleState};

/// Vehicles that share nothing but their grounds, in the order in which they were given. Each may have
/// a machine, effects ([`crate::effects::Overlay`]) and a ground of its own.
///
/// What becomes of one depends neither on the others nor on how many threads there are, to the bit. The
/// threads are those of the rayon pool that a call is made in: all cores, unless a caller installs another.
///
/// ```
/// use xt28_machine::{Machine, PerWheel};
/// use xt28_sim::effects::Overlay;
/// use xt28_sim::{Actuation, Effects, Fleet, ReducedBodies, STEP, Terrain, Vehicle};
///
/// let machine = Machine::xt28();
/// let overlay = "[[effect]]\nname = 'payload'\nmass_kg = 3000.0";
/// let loaded = Overlay::parse(overlay, "loaded.toml".as_ref())?.effects(&machine)?;
/// let ground = Terrain::Flat;
/// let vehicle = |effects: &Effects| -> Vehicle<ReducedBodies> {
///     Vehicle::with(&machine, effects, &ground, PerWheel::splat(0.17), STEP)
/// };
/// let mut fleet: Fleet = [vehicle(&Effects::default()), vehicle(&loaded)].into_iter().collect();
/// fleet.step(200, |_, _| Actuation::idle(1200.0));
/// let [empty, full] = [0, 1].map(|i| fleet.state(i).ground_force_n.sum());
/// assert!(full > empty + 25e3);
/// # Ok::<(), xt28_sim::effects::OverlayError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Fleet<B = ReducedBodies> {
    vehicles: Vec<Vehicle<B>>,
}

impl<B> FromIterator<Vehicle<B>> for Fleet<B> {
    fn from_iter<I: IntoIterator<Item = Vehicle<B>>>(vehicles: I) -> Self {
        Self { vehicles: vehicles.into_iter().collect() }
    }
}

impl<B: Bodies + Send> Fleet<B> {
    /// Advances every vehicle by `steps` steps under what `policy` asks of it by its number and its
    /// state at the beginning; `policy` is called once for each, on any thread.
    pub fn step(
        &mut self,
        steps: u32,
        policy: impl Fn(usize, &VehicleState) -> Actuation + Send + Sync,
    ) {
        self.vehicles.par_iter_mut().enumerate().for_each(|(i, vehicle)| {
            let actuation = policy(i, vehicle.state());
            (0..steps).for_each(|_| vehicle.step(&actuation));
        });
    }

    /// State of vehicle `i` after the last step.
    ///
    /// # Panics
    ///
    /// If there are not that many.
    #[must_use]
    pub fn state(&self, i: usize) -> &VehicleState {
        self.vehicles[i].state()
    }

    /// Vehicle `i` as it is now: stepped alike, it goes on bit for bit like the one in the fleet.
    ///
    /// # Panics
    ///
    /// If there are not that many.
    #[must_use]
    pub fn snapshot(&self, i: usize) -> Vehicle<B>
    where
        B: Clone,
    {
        self.vehicles[i].clone()
    }

    /// Lets `vehicle` go on in the place of vehicle `i`: an episode begins anew.
    ///
    /// # Panics
    ///
    /// If there are not that many.
    pub fn restart(&mut self, i: usize, vehicle: Vehicle<B>) {
        self.vehicles[i] = vehicle;
    }

    /// How many there are.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.vehicles.len()
    }

    /// Whether there is none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.vehicles.is_empty()
    }
}
