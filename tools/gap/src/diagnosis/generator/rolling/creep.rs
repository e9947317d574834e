//! Tyres that creep: how far their feet give way to what they push is in no log, and is what the wheels' speeds leave
//! least of.

use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::{Effects, Parts};

use super::{CREEPS_M_S_N, RollingErrors, held_errors};
use crate::diagnosis::signals::Signals;

/// Share of what wheels part by that tyres have to take by creeping for none of it and for all to count (assumed).
const TOLD: [f64; 2] = [0.1, 0.3];

/// What the feet of wheels may creep by, m/s/N: all, where some wheel rolls harder than is known, as what resists it
/// goes with its load, so that the ground pushes the lighter ones along, or holds them, even where all have one
/// coefficient; and a tyre that is softer than believed, which gives way along the ground as well, the more so the softer it is.
pub(super) fn creeps_at_most(machine: &Machine, effects: &Effects, parts: &Parts) -> PerWheel<f64> {
    let [.., most_m_s_n] = CREEPS_M_S_N;
    let nominal = Parts::new(machine, &Effects::default());
    let rolls_harder = rolls_harder(effects);
    PerWheel::from_fn(|w| {
        let softer = nominal.tyres[w].stiffness_n_m / parts.tyres[w].stiffness_n_m - 1.0;
        most_m_s_n * if rolls_harder { softer.max(1.0) } else { softer.max(0.0) }
    })
}

/// Rolling on tyres that creep by that share of `most_m_s_n` which leaves least: `free` is what is left of wheels that
/// do not. A wheel that rolls harder than others is pushed by the ground, and turns the slower.
pub(super) fn creeping(
    s: &Signals,
    machine: &Machine,
    effects: &Effects,
    free: &RollingErrors,
    most_m_s_n: &PerWheel<f64>,
) -> RollingErrors {
    let on = |share: f64| {
        let mut effects = effects.clone();
        for wheel in Wheel::ALL {
            effects.wheels[wheel].slippery_ground.creep_m_s_n += share * most_m_s_n[wheel];
        }
        held_errors(s, machine, &effects, None)
    };
    let most = on(1.0);
    // What tyres take of an error is in proportion to how they creep.
    let (mut product, mut square, mut all) = (0.0, f64::MIN_POSITIVE, f64::MIN_POSITIVE);
    for wheel in Wheel::ALL {
        for (free, most) in free.wheel_rad_s[wheel].iter().zip(&most.wheel_rad_s[wheel]) {
            let taken = free - most;
            if taken.is_finite() {
                product += taken * free;
                square += taken * taken;
                all += free * free;
            }
        }
    }
    // A soft tyre need not creep: wheels that hardly part say nothing of it.
    let told = product * product / (square * all);
    let [none, whole] = TOLD;
    let is_told =
        if rolls_harder(effects) { 1.0 } else { ((told - none) / (whole - none)).clamp(0.0, 1.0) };
    on(is_told * (product / square).clamp(0.0, 1.0))
}

/// Whether some wheel rolls harder than is known.
fn rolls_harder(effects: &Effects) -> bool {
    effects.wheels.iter().any(|(_, e)| e.rolling_resistance.added != 0.0)
}
