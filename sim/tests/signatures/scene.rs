//! What a machine is made to do for an effect to show, and its states while it does so.

use xt28_machine::{Axle, Machine, PerWheel, Wheel};
use xt28_sim::{Actuation, Bodies, Effects, Plant, STEP, Terrain, Vehicle, VehicleState};

/// Stroke at which every scene begins, m.
pub(crate) const STROKE_M: f64 = 0.17;
/// Valves, pumps and steering open no sooner, s; scenes that steer drive from the start.
pub(crate) const OPENS_S: f64 = 2.0;
/// The joints turn one way and back between these times, s.
pub(crate) const TURNS_S: [[f64; 2]; 2] = [[5.0, 7.0], [8.0, 10.0]];
/// Openings of the front and the rear steering valve meanwhile.
pub(crate) const TURNS_BY: [f64; 2] = [0.3, 0.15];

/// One thing that a machine does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Scene {
    /// It stands with all valves closed.
    Stands,
    /// All arms extend by 0.2 of the valves until 3.5 s, go back by 0.1 until 4.5 s, and stand.
    Swings,
    /// All arms extend by 0.02 of the valves.
    Creeps,
    /// Front and rear arms extend by 0.25 of the valves until 3 s, the middle ones do not.
    Spreads,
    /// The pumps open at once to this displacement.
    Drives(f64),
    /// It stands with its brake on.
    Brakes,
    /// It drives, bends to the left and straightens out.
    Bends,
    /// Arms, joints and pumps at once.
    Everything,
}

impl Scene {
    fn lasts_s(self) -> f64 {
        match self {
            Self::Stands | Self::Drives(_) => 10.0,
            Self::Swings | Self::Creeps | Self::Spreads | Self::Brakes | Self::Everything => 6.0,
            Self::Bends => 11.0,
        }
    }

    fn actuation(self, t_s: f64) -> Actuation {
        let idle = Actuation::idle(1200.0);
        let opened = t_s >= OPENS_S;
        let arms = |opening: f64| Actuation { arm_opening: PerWheel::splat(opening), ..idle };
        match self {
            Self::Swings if opened && t_s < 3.5 => arms(0.2),
            Self::Swings if opened && t_s < 4.5 => arms(-0.1),
            Self::Creeps if opened => arms(0.02),
            Self::Spreads if opened && t_s < 3.0 => {
                let outer = |w: Wheel| if w.axle() == Axle::Middle { 0.0 } else { 0.25 };
                Actuation { arm_opening: PerWheel::from_fn(outer), ..idle }
            }
            Self::Drives(pump) if opened => Actuation { pump_displacement: [pump; 2], ..idle },
            Self::Brakes => Actuation { brake_released: false, ..idle },
            Self::Bends => {
                let [there, back] = TURNS_S.map(|[from, to]| (from..to).contains(&t_s));
                let sense = f64::from(u8::from(there)) - f64::from(u8::from(back));
                Actuation {
                    pump_displacement: [(t_s / 2.0).min(1.0); 2],
                    steer_opening: TURNS_BY.map(|opening| sense * opening),
                    ..idle
                }
            }
            Self::Everything => Actuation {
                arm_opening: PerWheel::from_fn(|w| {
                    0.3 * (t_s * (1.0 + 0.1 * w.index() as f64)).sin()
                }),
                steer_opening: [0.2 * t_s.sin(), 0.1],
                pump_displacement: [0.5; 2],
                ..idle
            },
            _ => idle,
        }
    }

    /// The state before the first step and after each.
    pub(crate) fn states<B: Bodies>(self, effects: &Effects) -> Vec<VehicleState> {
        let strokes = PerWheel::splat(STROKE_M);
        let mut vehicle =
            Vehicle::<B>::with(&Machine::xt28(), effects, &Terrain::Flat, strokes, STEP);
        let first = *vehicle.state();
        let later = (0..step_at(self.lasts_s())).map(|step| {
            vehicle.step(&self.actuation(step as f64 * STEP.as_secs_f64()));
            *vehicle.state()
        });
        core::iter::once(first).chain(later).collect()
    }
}

/// The step that ends at this time.
pub(crate) fn step_at(t_s: f64) -> usize {
    (t_s / STEP.as_secs_f64()).round() as usize
}
