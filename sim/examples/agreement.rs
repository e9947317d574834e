//! How far the fast core and the reference come apart in ten seconds on grounds and commands of chance.
//!
//! ```sh
//! cargo run --release -p xt28-sim --example agreement
//! ```
// A program: it prints.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros, clippy::unwrap_used)]

#[path = "../tests/agreement_rig/mod.rs"]
mod agreement_rig;

use agreement_rig::{Chance, KINDS};

/// Grounds, each with commands of its own.
const SEEDS: u64 = 40;

fn main() {
    let mut all: [Vec<f64>; 6] = Default::default();
    for seed in 0..SEEDS {
        let apart = Chance::drawn(seed).apart();
        all.iter_mut().zip(apart).for_each(|(all, apart)| all.push(apart));
    }
    println!("| largest of ten seconds, {SEEDS} grounds | median | nine in ten | all |");
    println!("|---|---|---|---|");
    for (kind, all) in KINDS.iter().zip(&mut all) {
        all.sort_by(f64::total_cmp);
        let at = |share: f64| all[((all.len() - 1) as f64 * share).round() as usize];
        println!("| {kind} | {:.3} | {:.3} | {:.3} |", at(0.5), at(0.9), at(1.0));
    }
}
