//! A snapshot goes on bit for bit: taken at any tick, with any effects, on either solver and either tyre.

use core::time::Duration;
use std::sync::Arc;

use proptest::prelude::*;
use proptest::sample::select;
use xt28_machine::{Machine, PerWheel, TyreModel};
use xt28_sim::effects::{CATALOGUE, Entry, Overlay, Scope};
use xt28_sim::terrain::{Extent, Grid};
use xt28_sim::{
    Actuation, Bodies, Effects, Plant, RapierBodies, ReducedBodies, STEP, Solver, Terrain, Vehicle,
    VehicleState,
};

/// How long original and snapshot are watched, s.
const WATCHED_S: f64 = 0.75;

/// A machine, its ground and the instant of its snapshot.
#[derive(Clone, Debug)]
struct Case {
    overlay: Overlay,
    tyre_model: TyreModel,
    roll_hinge: bool,
    step: Duration,
    /// When the snapshot is taken, s.
    at_s: f64,
    /// Whether a stump waits under the front frame, onto which the arms let it down.
    over_stump: bool,
}

impl Case {
    /// Up to five effects on some of the wheels, three tolerances from neutral at the most; at 60 Hz the
    /// reference makes a step of four.
    fn any(over_stump: bool, at_s: core::ops::Range<f64>) -> impl Strategy<Value = Self> {
        let entry = (0..CATALOGUE.len(), select(Scope::ALL.to_vec()), -3.0..3.0_f64);
        let entry = entry.prop_map(|(effect, scope, tolerances)| {
            let effect = &CATALOGUE[effect];
            let scope = if effect.has_scope() { scope } else { Scope::All };
            let values = effect
                .parameters
                .iter()
                .map(|p| (p, (p.neutral + tolerances * p.tolerance).clamp(p.range[0], p.range[1])));
            Entry { effect, scope, severity: 1.0, values: values.collect() }
        });
        let steps = select(vec![STEP, Duration::from_secs_f64(1.0 / 60.0)]);
        let tyres = select(vec![TyreModel::Rigid, TyreModel::Brush]);
        let entries = proptest::collection::vec(entry, 0..=5);
        (entries, tyres, any::<bool>(), steps, at_s).prop_map(
            move |(entries, tyre_model, roll_hinge, step, at_s)| Self {
                overlay: Overlay { entries },
                tyre_model,
                roll_hinge,
                step,
                at_s,
                over_stump,
            },
        )
    }

    fn machine(&self) -> Machine {
        let mut machine = Machine::xt28();
        machine.vehicle.tyre_model = self.tyre_model;
        machine.vehicle.roll_hinge = self.roll_hinge;
        machine
    }

    fn effects(&self) -> Effects {
        self.overlay.effects(&self.machine()).expect("three tolerances are no overload")
    }

    fn terrain(&self) -> Terrain {
        let rough = |x: f64, y: f64| 0.04 * ((3.0 * x).sin() + (2.0 * y).cos());
        let stump = |x: f64, y: f64| if x.abs() <= 0.3 && y.abs() <= 0.2 { 0.5 } else { 0.0 };
        let extent = Extent { x_m: [-10.0, 10.0], y_m: [-5.0, 5.0] };
        Terrain::Grid(Arc::new(if self.over_stump {
            Grid::from_fn(extent, stump)
        } else {
            Grid::from_fn(extent, rough)
        }))
    }

    /// Drives off, steers and moves its arms; over a stump it lets itself down first.
    fn actuation(&self, step: u32) -> Actuation {
        let t_s = f64::from(step) * self.step.as_secs_f64();
        let lowers = self.over_stump && t_s < 1.6;
        let swing = |phase: f64| 0.3 * (1.7 * t_s + phase).sin();
        Actuation {
            pump_displacement: [(t_s - 0.2).clamp(0.0, 1.0); 2],
            steer_opening: [swing(0.0), swing(1.0)],
            arm_opening: PerWheel::from_fn(|w| if lowers { -1.0 } else { swing(w.index() as f64) }),
            ..Actuation::idle(1200.0)
        }
    }

    fn steps(&self, seconds: f64) -> u32 {
        (seconds / self.step.as_secs_f64()) as u32
    }

    /// The machine at the instant of its snapshot, and the number of the next step.
    fn vehicle<B: Bodies>(&self) -> (Vehicle<B>, u32) {
        let strokes = PerWheel::splat(if self.over_stump { 0.3 } else { 0.17 });
        let (machine, terrain) = (self.machine(), self.terrain());
        let mut vehicle = Vehicle::with(&machine, &self.effects(), &terrain, strokes, self.step);
        let steps = self.steps(self.at_s);
        (0..steps).for_each(|step| vehicle.step(&self.actuation(step)));
        (vehicle, steps)
    }

    /// What a plant does after the snapshot, each state to the bit.
    fn went_on(&self, plant: &mut (impl Plant + ?Sized), from: u32) -> Vec<String> {
        let step = |step: u32| {
            plant.step(&self.actuation(step));
            bits(plant.state())
        };
        (from..from + self.steps(WATCHED_S)).map(step).collect()
    }

    /// Steps the original first, then what was taken of it before and what is taken of that.
    fn goes_on<B: Bodies>(&self) -> Result<VehicleState, TestCaseError> {
        let (mut original, from) = self.vehicle::<B>();
        let taken_at = *original.state();
        let mut snapshot = original.clone();
        let mut again = snapshot.clone();
        prop_assert_eq!(bits(snapshot.state()), bits(&taken_at));
        let went = self.went_on(&mut original, from);
        prop_assert_eq!(&self.went_on(&mut snapshot, from), &went);
        prop_assert_eq!(&self.went_on(&mut again, from), &went);
        Ok(taken_at)
    }
}

/// A state as text that two states share only where every number has the same bits: a minus before
/// zero shows, and what is no number equals itself.
fn bits(state: &VehicleState) -> String {
    format!("{state:?}")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn the_reference_goes_on_from_any_tick(case in Case::any(false, 0.0..3.0)) {
        case.goes_on::<RapierBodies>()?;
    }

    #[test]
    fn the_fast_core_goes_on_from_any_tick(case in Case::any(false, 0.0..3.0)) {
        case.goes_on::<ReducedBodies>()?;
    }

    /// The hull is in the engine then, with contacts that remember the step before.
    #[test]
    fn a_grounded_machine_goes_on_from_any_tick(case in Case::any(true, 0.6..3.0)) {
        let on_hull_n = [
            case.goes_on::<RapierBodies>()?.chassis_force_n,
            case.goes_on::<ReducedBodies>()?.chassis_force_n,
        ];
        prop_assume!(on_hull_n.iter().all(|force_n| *force_n > 0.0));
    }
}

/// What the diagnosis takes, which knows no solver by its type.
#[test]
fn a_snapshot_of_whatever_solver_goes_on_as_well() {
    let case = Case {
        overlay: Overlay::default(),
        tyre_model: TyreModel::Brush,
        roll_hinge: false,
        step: STEP,
        at_s: 2.0,
        over_stump: true,
    };
    for solver in [Solver::Rapier, Solver::Reduced] {
        let (machine, terrain) = (case.machine(), case.terrain());
        let strokes = PerWheel::splat(0.3);
        let mut plant = solver.vehicle(&machine, &Effects::default(), &terrain, strokes, case.step);
        let from = case.steps(case.at_s);
        (0..from).for_each(|step| plant.step(&case.actuation(step)));
        assert!(plant.state().chassis_force_n > 0.0, "{solver} lies on the stump");
        let mut snapshot = plant.snapshot();
        let went = case.went_on(&mut *plant, from);
        assert_eq!(case.went_on(&mut *snapshot, from), went, "{solver}");
    }
}
