//! What inference may turn: every parameter of every effect, and the machine's own tolerances.

use core::fmt;

use xt28_machine::{Machine, Wheel};
use xt28_sim::Effects;
use xt28_sim::effects::{Block, CATALOGUE, Effect, LOCK_STIFFNESS, Parameter, Scope, Slot};

/// Share of an effect's tolerance by which a sound machine is off, all effects at once. A tolerance is
/// what one believes of one effect before seeing data; two hundred of them at their full width bend to
/// a third of a valve's gain (measured on foreign plants, docs/diagnosis-log.md, item 6).
const SOUND: f64 = 0.4;
/// How many of its own a knob goes beside a right answer; one that goes further hides something.
pub(crate) const SHIFT_MAX: f64 = 2.5;

/// One number that may be other than one believes.
#[derive(Clone, Copy, Debug)]
pub enum Knob {
    /// A parameter of an effect, on the wheels of a scope.
    Effect(&'static Effect, &'static Parameter, Scope),
    /// A number of the machine file, scaled.
    Machine(&'static Tolerance),
}

/// A number of the machine file that differs from machine to machine without being an effect.
#[derive(Debug)]
pub struct Tolerance {
    /// What it is.
    pub name: &'static str,
    /// Standard deviation of its factor.
    pub sigma: f64,
    /// Scales it.
    apply: fn(&mut Machine, f64),
}

/// Of masses within 3 % of what the machine file says; somewhat more than 3 % over the square root of
/// three, as arms and wheels have tolerances too and stand for none here.
const MASS_SIGMA: f64 = 0.02;

/// The tolerances that the diagnosis allows for (assumed: masses within 3 %, 5 % of what is looked up).
pub static TOLERANCES: &[Tolerance] = &[
    Tolerance { name: "front mass", sigma: MASS_SIGMA, apply: |m, f| m.masses.front_frame_kg *= f },
    Tolerance {
        name: "middle mass",
        sigma: MASS_SIGMA,
        apply: |m, f| m.masses.middle_frame_kg *= f,
    },
    Tolerance { name: "rear mass", sigma: MASS_SIGMA, apply: |m, f| m.masses.rear_frame_kg *= f },
    Tolerance {
        name: "joint stiffness",
        sigma: 0.05,
        apply: |m, f| m.vehicle.joint_stiffness_nm *= f,
    },
    Tolerance {
        name: "joint damping",
        sigma: 0.05,
        apply: |m, f| m.vehicle.joint_damping_nms *= f,
    },
    // How tyres scrub as joints turn: plants differ in it by as much (docs/diagnosis-log.md, item 9).
    Tolerance { name: "scrub", sigma: 0.3, apply: |m, f| m.wheels.friction *= f },
    Tolerance { name: "drive gain", sigma: 0.05, apply: |m, f| m.vehicle.circuit_gain_nms *= f },
    Tolerance {
        name: "drive integral",
        sigma: 0.05,
        apply: |m, f| m.vehicle.mean_integral_nm *= f,
    },
    Tolerance {
        name: "drive time constant",
        sigma: 0.1,
        apply: |m, f| m.drive.speed_time_constant_s *= f,
    },
];

impl fmt::Display for Knob {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Effect(effect, parameter, scope) => {
                write!(f, "{} {scope} {}", effect.name, parameter.name)
            }
            Self::Machine(tolerance) => f.write_str(tolerance.name),
        }
    }
}

impl Knob {
    /// All that may be turned at once: scoped effects wheel by wheel, the others once.
    #[must_use]
    pub fn all() -> Vec<Self> {
        Self::of(&CATALOGUE.iter().collect::<Vec<_>>())
    }

    /// The same of some effects: what is in no catalogue is no tolerance either. Nor is the bus: single
    /// frames are lost or not, so that residuals have no slope by their share.
    #[must_use]
    pub fn of(effects: &[&'static Effect]) -> Vec<Self> {
        let mut all = Vec::new();
        for effect in effects.iter().copied().filter(|effect| effect.block != Block::Bus) {
            for parameter in effect.parameters {
                match parameter.slot {
                    Slot::PerWheel(_) => all.extend(
                        Wheel::ALL.map(|w| Self::Effect(effect, parameter, Scope::Wheel(w))),
                    ),
                    Slot::Whole(_) => all.push(Self::Effect(effect, parameter, Scope::All)),
                }
            }
        }
        all.extend(Self::tolerances());
        all
    }

    /// What differs from machine to machine, and no effect.
    #[must_use]
    pub fn tolerances() -> Vec<Self> {
        let locks = LOCK_STIFFNESS.parameters.iter().flat_map(|parameter| {
            Wheel::ALL.map(|w| Self::Effect(&LOCK_STIFFNESS, parameter, Scope::Wheel(w)))
        });
        TOLERANCES.iter().map(Self::Machine).chain(locks).collect()
    }

    /// Value at which it changes nothing.
    #[must_use]
    pub const fn neutral(&self) -> f64 {
        match self {
            Self::Effect(_, parameter, _) => parameter.neutral,
            Self::Machine(_) => 1.0,
        }
    }

    /// Standard deviation that one believes before seeing data.
    #[must_use]
    pub const fn tolerance(&self) -> f64 {
        match self {
            Self::Effect(effect, parameter, _) => match effect.block {
                // Ground is as it is, however well the machine is kept.
                Block::Ground => parameter.tolerance,
                _ => SOUND * parameter.tolerance,
            },
            Self::Machine(tolerance) => tolerance.sigma,
        }
    }

    /// Sets it.
    pub fn set(&self, machine: &mut Machine, effects: &mut Effects, value: f64) {
        match self {
            Self::Effect(_, parameter, scope) => parameter.set(effects, *scope, value),
            Self::Machine(tolerance) => (tolerance.apply)(machine, value),
        }
    }
}
