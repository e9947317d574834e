//! Effects whose laws are known less well than others', and by how much: what a right answer may leave of a gap for
//! it, and how uncertain it makes their sizes. All other laws have one form: a delay is a delay.

use xt28_sim::effects::Effect;

use super::floor::Signal;
use super::generator::Generator;

/// Effects whose law remembers how the machine came to rest, which is in no log, and has another form on each make.
const REMEMBERING: [&str; 2] = ["seal-stiction", "standstill-drag"];

/// Share of an effect's size by which an interval is wider than noise makes it: laws of machines differ (six in ten
/// intervals held the truth without).
const SIZE_SHARE: f64 = 0.05;
/// That share for [`REMEMBERING`]: what holds an idle wheel comes out 14 % low on one make and 23 % high on another.
const SIZE_SHARE_REMEMBERING: f64 = 0.12;

/// Causes whose laws are known less well than others', and by how much.
struct Vague {
    effects: &'static [&'static str],
    /// Where that shows.
    shows: fn(Generator, Signal) -> bool,
    /// Share of a gap that they may leave there.
    share: f64,
}

/// The causes that are vague, and why.
const VAGUE: [Vague; 7] = [
    Vague { effects: &REMEMBERING, shows: anywhere, share: 0.6 },
    // How much oil stood where before an accumulator opened is not known.
    Vague { effects: &["accumulator-gas"], shows: anywhere, share: 0.25 },
    // What load an arm drifts at, and how fast near it, is each make's own.
    Vague { effects: &["unsupported-sag"], shows: anywhere, share: 0.15 },
    // One name for laws of some forms: an edge may be sharp or round, a speed go with a load or its root.
    Vague {
        effects: &[
            "load-dependent-speed",
            "pump-flow-limit",
            "lock-damping",
            "rear-follower-lag",
            "engine-droop",
            "slippery-ground",
            "soft-tyres",
            "valve-hysteresis",
        ],
        shows: anywhere,
        share: 0.1,
    },
    // A leak that is believed a little too slow is a large gap in half a minute.
    Vague { effects: &["leakage-drift"], shows: anywhere, share: 0.08 },
    // What pushes the wheels acts between wheel and arm on one make, between wheel and ground on another.
    Vague { effects: &["rolling-resistance"], shows: weighs, share: 0.35 },
    // No log says which of a bunch of commands a controller took.
    Vague { effects: &["command-jitter"], shows: controls, share: 0.6 },
];

/// The share of a gap by which the laws of `names` are vague in `signal`.
pub(super) fn vagueness(names: &[&str], generator: Generator, signal: Signal) -> f64 {
    let vague = VAGUE.iter().filter(|v| v.effects.iter().any(|effect| names.contains(effect)));
    let here = vague.filter(|vague| (vague.shows)(generator, signal));
    here.map(|vague| vague.share).fold(0.0, f64::max)
}

/// Whether makes differ in the form of the law that is called `name`.
pub(super) fn is_vague(name: &str) -> bool {
    VAGUE.iter().any(|vague| vague.effects.contains(&name))
}

/// Share of the size of `effect` by which that is uncertain because its law is.
pub(super) fn size_share(effect: &Effect) -> f64 {
    if REMEMBERING.contains(&effect.name) { SIZE_SHARE_REMEMBERING } else { SIZE_SHARE }
}

fn anywhere(_: Generator, _: Signal) -> bool {
    true
}

fn weighs(_: Generator, signal: Signal) -> bool {
    matches!(signal, Signal::Weight | Signal::WeightX | Signal::WeightY)
}

/// Whether a controller makes the signal.
pub(super) fn controls(generator: Generator, _: Signal) -> bool {
    matches!(generator, Generator::ArmEcu(_) | Generator::SteerEcu(_))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_vague_cause_is_in_the_catalogue() {
        for effect in VAGUE.iter().flat_map(|vague| vague.effects) {
            assert!(xt28_sim::effects::find(effect).is_some(), "{effect}");
        }
    }
}
