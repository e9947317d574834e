//! Wheels that arms hold in the air: who tells then how fast the machine goes.

use std::borrow::Cow;

use xt28_machine::{Machine, Wheel};
use xt28_sim::Effects;
use xt28_sim::effects::{SoftTyre, WheelSpeedScale};

use super::rolling::{CARRYING_N, rolling_errors};
use crate::diagnosis::signals::Signals;

/// Friction on which no wheel slides, whatever it is pushed with.
const HOLDS_ON: f64 = 1.0e3;

/// Speed of the front axle that the wheels say, m/s, which of them slip and misread taken off.
pub(super) fn travels_m_s<'a>(
    signals: &'a Signals,
    machine: &Machine,
    effects: &Effects,
    slips: bool,
) -> Cow<'a, [f64]> {
    let misread = effects.wheels.iter().any(|(_, e)| {
        e.wheel_speed_scale != WheelSpeedScale::default() || e.soft_tyre != SoftTyre::default()
    });
    if slips || misread {
        return rolling_errors(signals, machine, effects).ahead_m_s.into();
    }
    let first = || {
        let mut holding = machine.clone();
        holding.wheels.friction = HOLDS_ON;
        rolling_errors(signals, &holding, &Effects::default()).ahead_m_s
    };
    signals.travels_m_s(first).into()
}

/// Mean speed of the wheels that carry at sample `i`, which alone roll as the machine goes, rad/s; of all where none
/// does.
pub(super) fn rolls_rad_s(signals: &Signals, i: usize) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for w in carrying(signals, i) {
        (sum, count) = (sum + signals.wheel_speed_rad_s[w][i], count + 1.0);
    }
    if count > 0.0 { sum / count } else { signals.mean_wheel_speed_rad_s(i) }
}

/// Whether arms hold a wheel too high at sample `i` for it to turn as the machine travels, which others tell then.
pub(super) fn is_lifted(signals: &Signals, i: usize) -> bool {
    (1..6).contains(&carrying(signals, i).count())
}

/// The wheels that carry at sample `i`.
fn carrying(signals: &Signals, i: usize) -> impl Iterator<Item = Wheel> {
    Wheel::ALL.into_iter().filter(move |w| signals.cylinder_load_n[*w][i] > CARRYING_N)
}
