//! `soft-tyres`: vertical compliance and damping of a real tyre.

use xt28_machine::Machine;

use crate::effects::{Block, Effect, Parameter, Slot};

/// Spring and damper of one tyre. A number at its default is the machine file's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftTyre {
    /// Stiffness, N/m.
    pub stiffness_n_m: f64,
    /// Damping, N s/m.
    pub damping_n_s_m: f64,
}

/// The nominal, near rigid wheel of the machine file.
const NEAR_RIGID: SoftTyre = SoftTyre { stiffness_n_m: 8.0e6, damping_n_s_m: 6.0e4 };

impl Default for SoftTyre {
    fn default() -> Self {
        NEAR_RIGID
    }
}

impl SoftTyre {
    /// The machine file's own tyre.
    #[must_use]
    pub const fn of(machine: &Machine) -> Self {
        let v = &machine.vehicle;
        Self { stiffness_n_m: v.tyre_stiffness_n_m, damping_n_s_m: v.tyre_damping_n_s_m }
    }
}

/// The axle sinks by load over stiffness, the wheel rolls on a smaller radius, the machine bounces
/// and pitches on its tyres. The law is [`crate::Tyre`].
pub(in crate::effects) const EFFECT: Effect = Effect {
    name: "soft-tyres",
    block: Block::Tyre,
    meaning: "vertical compliance and damping of the tyres",
    source: "forestry tyres of 700 mm width: 0.3 to 1 MN/m by load and pressure (textbook); \
             tolerance assumed, 5 %",
    parameters: &[
        Parameter {
            name: "stiffness_n_m",
            neutral: NEAR_RIGID.stiffness_n_m,
            tolerance: 4.0e5,
            range: [1.5e5, 2.0e7],
            acts_alone: true,
            slot: Slot::PerWheel(|effects, wheel| {
                &mut effects.wheels[wheel].soft_tyre.stiffness_n_m
            }),
        },
        Parameter {
            name: "damping_n_s_m",
            neutral: NEAR_RIGID.damping_n_s_m,
            tolerance: 3.0e3,
            range: [0.0, 2.0e5],
            acts_alone: true,
            slot: Slot::PerWheel(|effects, wheel| {
                &mut effects.wheels[wheel].soft_tyre.damping_n_s_m
            }),
        },
    ],
};
