//! Which block carries the whole machine's gap: blocks put out what was measured, in every combination.

use rayon::prelude::*;
use xt28_sim::Held;
use xt28_sim::effects::Block;

use super::HowFar;
use super::machine_sample::{Horizon, Quantity};
use super::squares;
use super::twin::PreparedRun;

/// Blocks whose output can be taken from the log, in the order of the bits of a combination.
const PLAYERS: [Block; 3] = [Block::Arms, Block::Steering, Block::Drive];

impl HowFar {
    /// Share of the machine's gap over 5 s, on all runs, that each block carries, the largest first.
    ///
    /// Shapley's value: what a block's measured output takes off the gap, averaged over all orders in
    /// which the blocks' outputs can be replaced. What is left when all of them are replaced is that of
    /// the masses and all they rest on (`payload`). Only what goes beyond a floor is dealt out, as long as
    /// the gap does. Shares add up to 1; a block whose measured output makes the others worse has none.
    #[must_use]
    pub fn shares(&self) -> Vec<(Block, f64)> {
        let combinations: Vec<usize> = (0..1 << PLAYERS.len()).collect();
        let gaps: Vec<f64> = combinations
            .into_par_iter()
            .map(|set| {
                let has = |bit: usize| set >> bit & 1 == 1;
                let held = Held { arms: has(0), joints: has(1), drive: has(2) };
                let horizon = Horizon::FiveSeconds;
                let foretell =
                    |run: &PreparedRun| run.foretell(&self.machine, &self.believed, horizon, held);
                let mut blocks = self.squares_of(&foretell, horizon, |_| true);
                if held.drive {
                    // Pressures are the drive's own too, and nothing of the simulator feels them.
                    squares::take_measured(&mut blocks, Quantity::PumpPressure);
                }
                squares::gap(&blocks)
            })
            .collect();
        let gaps = beyond_floor(gaps);
        let mut shares: Vec<(Block, f64)> = PLAYERS
            .iter()
            .enumerate()
            .map(|(bit, &block)| (block, shapley(&gaps, bit).max(0.0)))
            .collect();
        shares.push((Block::Payload, gaps[gaps.len() - 1]));
        let total: f64 = shares.iter().map(|(_, share)| share).sum();
        shares.iter_mut().for_each(|(_, share)| *share /= total.max(f64::MIN_POSITIVE));
        shares.sort_by(|a, b| b.1.total_cmp(&a.1));
        shares
    }
}

/// Gaps less what sound machines leave too; as they are where nothing goes beyond that.
fn beyond_floor(gaps: Vec<f64>) -> Vec<f64> {
    if gaps.first().is_none_or(|gap| *gap <= 1.0) {
        return gaps;
    }
    gaps.into_iter().map(|gap| (gap - 1.0).max(0.0)).collect()
}

/// What player `bit` takes off `gaps`, one a combination, averaged over all orders.
fn shapley(gaps: &[f64], bit: usize) -> f64 {
    let players = gaps.len().trailing_zeros();
    let weight = |others: u32| {
        let orders = |n: u32| (1..=n).map(f64::from).product::<f64>();
        orders(others) * orders(players - 1 - others) / orders(players)
    };
    (0..gaps.len())
        .filter(|set| set >> bit & 1 == 0)
        .map(|set| weight(set.count_ones()) * (gaps[set] - gaps[set | 1 << bit]))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two that only help together share what they give; one that never helps gets nothing.
    #[test]
    fn shares_are_fair() {
        let gap = |set: usize| if set & 0b011 == 0b011 { 1.0 } else { 5.0 };
        let gaps: Vec<f64> = (0..8).map(gap).collect();
        assert!((shapley(&gaps, 0) - 2.0).abs() < 1e-12);
        assert!((shapley(&gaps, 1) - 2.0).abs() < 1e-12);
        assert!(shapley(&gaps, 2).abs() < 1e-12);
    }
}
