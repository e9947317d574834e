//! Signals of a machine that never was, for tests.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use xt28_gap::diagnosis::Signals;
use xt28_gap::{Channel, Series, Terrain};
use xt28_machine::Wheel;

const SECONDS: f64 = 20.0;

/// A channel over the run.
pub(crate) fn series(value: impl Fn(f64) -> f64) -> Series {
    (0..2000).map(|i| f64::from(i) * 0.01).map(|at_s| (at_s, value(at_s))).collect()
}

/// A machine that stands with all arms held.
pub(crate) fn standing() -> BTreeMap<Channel, Series> {
    let zero = Channel::all().into_iter().map(|channel| (channel, series(|_| 0.0)));
    let mut all: BTreeMap<Channel, Series> = zero.collect();
    for w in Wheel::ALL {
        all.insert(Channel::CylinderLoad(w), series(|_| 60e3));
        all.insert(Channel::Stroke(w), series(|_| 0.17));
        all.insert(Channel::TargetStroke(w), series(|_| 0.17));
    }
    all.insert(Channel::ArmMode, series(|_| 2.0));
    for receiver in [Channel::East, Channel::North, Channel::Heading] {
        all.remove(&receiver);
    }
    all
}

pub(crate) fn signals(all: &BTreeMap<Channel, Series>) -> [Signals; 1] {
    [Signals::of_series("made up", all, SECONDS, Terrain::Flat).unwrap()]
}

/// The same with every arm swinging at a frequency of its own, 30 mm each way.
pub(crate) fn swinging() -> BTreeMap<Channel, Series> {
    let mut all = standing();
    for (k, w) in (0_u8..).zip(Wheel::ALL) {
        let phase = move |at_s: f64| TAU * (0.05 + 0.02 * f64::from(k)) * at_s;
        let late = 1.18 * TAU * (0.05 + 0.02 * f64::from(k));
        all.insert(Channel::TargetStroke(w), series(|t| 0.17 + 0.03 * phase(t).sin()));
        let swing =
            move |t: f64| 0.03 / (1.0 + late * late).sqrt() * (phase(t) - late.atan()).sin();
        all.insert(Channel::Stroke(w), series(|t| ((0.17 + swing(t)) * 1e3).floor() * 1e-3));
        let speed = move |t: f64| swing(t + 0.01) - swing(t);
        let current = |on: bool| if on { 0.44 } else { 0.0 };
        all.insert(Channel::ExtendCurrent(w), series(|t| current(speed(t) > 0.0)));
        all.insert(Channel::RetractCurrent(w), series(|t| current(speed(t) < 0.0)));
    }
    all
}
