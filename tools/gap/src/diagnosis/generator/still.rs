//! A run in which nothing happens, for tests to put into it what should.

use crate::diagnosis::signals::Signals;
use crate::{Channel, Terrain};

/// All channels there are, all at zero for `seconds` on flat ground.
pub(in crate::diagnosis) fn still(seconds: u32) -> Signals {
    let zeros = (0..100 * seconds).map(|i| (f64::from(i) * 0.01, 0.0));
    let all = Channel::all().into_iter().map(|c| (c, zeros.clone().collect()));
    Signals::of_series("made up", &all.collect(), f64::from(seconds), Terrain::Flat).unwrap()
}
