//! The floors of one run: what separates two models of one machine with readings as noisy as its are.

use std::collections::BTreeMap;

use super::floor::Signal;

/// A block by its name, and which of several alike it is: a wheel or a joint.
pub type BlockKey = (&'static str, usize);

/// By how much floors are lifted, 1 or more, where readings are noisier than floors have it.
#[derive(Clone, Debug, Default)]
pub struct Floors(BTreeMap<(BlockKey, Signal), f64>);

impl Floors {
    /// Standard deviation that separates two models of one machine with these readings, SI.
    #[must_use]
    pub fn sigma(&self, at: BlockKey, signal: Signal) -> f64 {
        signal.floor().sigma * self.0.get(&(at, signal)).copied().unwrap_or(1.0)
    }

    /// Lifts a floor, so many times as high as it was.
    pub(super) fn lift(&mut self, at: BlockKey, signal: Signal, times: f64) {
        self.0.insert((at, signal), times);
    }

    /// The floors that are lifted, and by how many times.
    pub fn lifted(&self) -> impl Iterator<Item = (BlockKey, Signal, f64)> {
        self.0.iter().map(|((at, signal), times)| (*at, *signal, *times))
    }

    /// What to say of a machine's runs of which some have lifted floors; `None` where none has.
    pub fn remark<'a>(all: impl Iterator<Item = &'a Self>) -> Option<String> {
        let mut most: BTreeMap<(&str, String), f64> = BTreeMap::new();
        for ((part, _), signal, times) in all.flat_map(Self::lifted) {
            let old = most.entry((part, signal.with_wheel())).or_insert(times);
            *old = old.max(times);
        }
        let of = |((part, signal), times): (&(&str, String), &f64)| {
            format!("{signal} of {part} {times:.1} times")
        };
        (!most.is_empty()).then(|| {
            let all: Vec<String> = most.iter().map(of).collect();
            format!(
                "readings are noisier than ordinary, so that small gaps do not show: the noise floor is \
                 lifted for {}",
                all.join(", ")
            )
        })
    }
}
