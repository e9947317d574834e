//! Numbers of the machine and of its effects, and what nudging one makes of the drive.

use xt28_machine::{Machine, TyreModel, Wheel};
use xt28_sim::effects::{Block, CATALOGUE, Effect, Parameter, Scope, Slot};
use xt28_sim::{Effects, Terrain};

use super::{Trace, grounds, lifted_and_landed, trace};

/// A rigid wheel creeps by 1e-8 m/s/N of its own, a thousandth of the tolerance of what the ground adds, and
/// answers in proportion to what is little beside that.
const FINE: (&str, f64) = ("creep_m_s_n", 1e-3);

/// That of a number of the machine file, as a share of itself.
const TOLERANCE: f64 = 0.1;

/// A number to be nudged.
#[derive(Clone, Copy)]
pub(crate) enum Knob {
    Effect(&'static Effect, &'static Parameter),
    Machine(&'static str, fn(&mut Machine) -> &mut f64),
}

impl Knob {
    /// Every parameter of an effect that the plant or a sensor has, and numbers of the machine file that
    /// no effect replaces.
    pub(crate) fn all() -> Vec<Self> {
        let parameters = |effect: &'static Effect| {
            let of_plant = |p: &&Parameter| !effect.is_law_of_an_ecu(p);
            let own = effect.parameters.iter().filter(of_plant);
            own.map(move |p| Self::Effect(effect, p)).collect::<Vec<_>>()
        };
        // What a bus loses and delays is none of the plant's either.
        let of_no_bus = CATALOGUE.iter().filter(|effect| effect.block != Block::Bus);
        let mut all: Vec<Self> = of_no_bus.flat_map(parameters).collect();
        all.extend([
            Self::Machine("front frame's mass", |m| &mut m.masses.front_frame_kg),
            Self::Machine("lock's stiffness", |m| &mut m.hydraulics.lock_stiffness_n_m),
            Self::Machine("valve's speed", |m| &mut m.hydraulics.speed_full_m_s),
            Self::Machine("tyre's stiffness", |m| &mut m.vehicle.tyre_stiffness_n_m),
            Self::Machine("friction", |m| &mut m.wheels.friction),
            Self::Machine("rolling resistance", |m| &mut m.wheels.rolling_resistance),
            Self::Machine("joint's damping", |m| &mut m.vehicle.joint_damping_nms),
        ]);
        all
    }

    pub(crate) fn name(&self) -> String {
        match self {
            Self::Effect(effect, p) => format!("{} {}", effect.name, p.name),
            Self::Machine(name, _) => (*name).to_owned(),
        }
    }

    /// Moves it by a share of its tolerance, up unless it is at the end of its range; a number of the
    /// machine file by a share of [`TOLERANCE`].
    fn nudge(&self, machine: &mut Machine, effects: &mut Effects, share: f64) {
        match self {
            Self::Effect(_, p) => {
                let fine = if p.name == FINE.0 { FINE.1 } else { 1.0 };
                let by = up(p) * fine * share * p.tolerance;
                match p.slot {
                    Slot::PerWheel(slot) => {
                        Wheel::ALL.into_iter().for_each(|w| *slot(effects, w) += by);
                    }
                    Slot::Whole(slot) => *slot(effects) += by,
                }
            }
            Self::Machine(_, number) => *number(machine) *= 1.0 + TOLERANCE * share,
        }
    }
}

/// 1 for a parameter that can grow from its neutral value, or else -1.
fn up(p: &Parameter) -> f64 {
    if p.neutral < p.range[1] { 1.0 } else { -1.0 }
}

/// Every effect at once, about a tolerance off, a little otherwise at each wheel; pump and engine so that
/// they run short.
fn all_at_once() -> Effects {
    let mut effects = Effects::default();
    for effect in CATALOGUE {
        for (i, p) in effect.parameters.iter().enumerate() {
            for wheel in Wheel::ALL {
                let tolerances = if i == 0 { 1.3 } else { 0.7 } + 0.03 * wheel.index() as f64;
                let value = p.neutral + up(p) * tolerances * p.tolerance;
                p.set(&mut effects, Scope::Wheel(wheel), value.clamp(p.range[0], p.range[1]));
            }
        }
    }
    effects.pump_flow.flow_m3_s = 0.001;
    effects.drive.engine_droop.power_factor = 0.1;
    effects
}

/// A machine on a ground, and how it goes there.
pub(crate) struct Base {
    pub(crate) name: String,
    machine: Machine,
    effects: Effects,
    terrain: Terrain,
    pub(crate) trace: Trace,
}

impl Base {
    /// Rigid and brush tyres on all grounds, nominal and with every effect at once.
    pub(crate) fn all() -> Vec<Self> {
        let mut all = Vec::new();
        for tyre_model in [TyreModel::Rigid, TyreModel::Brush] {
            let mut machine = Machine::xt28();
            machine.vehicle.tyre_model = tyre_model;
            for (ground, terrain) in grounds() {
                for (kind, effects) in [("nominal", Effects::default()), ("all", all_at_once())] {
                    let name = format!("{tyre_model:?} tyres on {ground}, {kind}");
                    let trace = trace(&machine, &effects, &terrain);
                    assert!(lifted_and_landed(&trace), "{name}");
                    let (machine, terrain) = (machine.clone(), terrain.clone());
                    all.push(Self { name, machine, effects, terrain, trace });
                }
            }
        }
        all
    }

    /// What a nudge makes of the drive.
    pub(crate) fn nudged(&self, knob: &Knob, share: f64) -> Trace {
        let (mut machine, mut effects) = (self.machine.clone(), self.effects.clone());
        knob.nudge(&mut machine, &mut effects, share);
        trace(&machine, &effects, &self.terrain)
    }
}
