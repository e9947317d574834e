//! What the emulator tells of its plant, with a plant that knocks when it is told to.

use xt28_machine::Machine;
use xt28_sim::{Held, Plant, Terrain};

use super::*;

/// Stands, and is knocked in the first step of every tick but not in its last.
#[derive(Clone, Default)]
struct Knocked {
    steps: usize,
    state: VehicleState,
}

impl Plant for Knocked {
    fn step(&mut self, _: &Actuation) {
        self.state.chassis_force_n = if self.steps.is_multiple_of(2) { 700.0 } else { 0.0 };
        self.steps += 1;
    }

    fn state(&self) -> &VehicleState {
        &self.state
    }
}

impl Track for Knocked {
    fn track(&mut self, _: &VehicleState, actuation: &Actuation) {
        self.step(actuation);
    }

    fn place(&mut self, _: &VehicleState, _: &Actuation) {}

    fn hold(&mut self, _: &VehicleState, _: &Actuation, _: Held) {}

    fn snapshot(&self) -> Box<dyn Track + Send> {
        Box::new(self.clone())
    }
}

#[test]
fn a_knock_between_two_ticks_is_told() {
    let config = EmulatorConfig::new(Machine::xt28(), Terrain::Flat, None);
    let mut emulator = Emulator::set_down(&config);
    emulator.plant = Box::new(Knocked::default());
    let mut out = Outbox::default();
    emulator.tick(SimTime::ZERO, &mut out);
    assert_eq!(emulator.plant.state().chassis_force_n, 0.0, "it is over at the tick's end");
    assert_eq!(emulator.truth().chassis_force_n, 700.0);
    assert_eq!(emulator.clone().truth().chassis_force_n, 700.0);
    emulator.tick_held(SimTime::ZERO + TICK, &VehicleState::default(), Held::ALL, &mut out);
    assert_eq!(emulator.truth().chassis_force_n, 700.0);
    // Told once: what did not happen again is not said again.
    emulator.plant = Box::new(Knocked { steps: 1, ..Knocked::default() });
    emulator.go_on(|_| ());
    assert_eq!(emulator.truth().chassis_force_n, 0.0);
}
