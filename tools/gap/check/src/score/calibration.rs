//! Whether what is said with 80 % is true four times in five.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use super::rate::average;
use crate::reply::Reply;
use crate::truth::{Kind, Truth};
use crate::wilson;

/// Bins of the reliability curve, at most; each has as many statements as the next, and at least
/// [`BIN_MIN`].
const BINS: usize = 10;
const BIN_MIN: usize = 8;
/// Draws behind [`error_by_chance`], and their seed.
const CHANCE_DRAWS: usize = 200;
const CHANCE_SEED: u64 = 28;

/// Something said with a probability, and whether it was so.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statement {
    /// As stated, 0 to 1.
    pub probability: f64,
    /// What came out.
    pub is_true: bool,
}

/// A group of statements that were made with about the same probability.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bin {
    /// Mean probability stated.
    pub stated: f64,
    /// Share that was true.
    pub true_share: f64,
    /// Its 95 % interval (Wilson).
    pub interval: [f64; 2],
    /// Statements.
    pub count: usize,
}

/// What a reply states of a case: its likeliest answer (a cause, nothing, or something unknown), and
/// a second cause where it stands by two.
#[must_use]
pub fn statements(truth: &Truth, reply: &Reply) -> Vec<Statement> {
    let (Some(none), Some(unknown)) = (reply.none, reply.unknown) else { return Vec::new() };
    let of_cause = |place: usize| {
        let cause = reply.cause(place)?;
        Some(Statement { probability: cause.probability?, is_true: truth.has(cause.effect) })
    };
    let mut all = vec![
        Statement { probability: none, is_true: truth.kind == Kind::Null },
        Statement { probability: unknown, is_true: truth.kind == Kind::Unknown },
    ];
    all.extend(of_cause(0));
    all.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    all.truncate(1);
    all.extend(of_cause(1).filter(|second| second.probability > 0.5));
    all
}

/// What a reply states of the wheels of its likeliest cause, where that is the right effect and has any.
pub(super) fn scope_statement(truth: &Truth, reply: &Reply) -> Option<Statement> {
    let first = reply.cause(0).filter(|c| c.effect.has_scope() && truth.has(c.effect))?;
    let is_true = truth.has_at(first.effect, first.scope);
    Some(Statement { probability: first.scope_share?, is_true })
}

/// Statements by probability in bins of equal count; statements of one probability stay together.
#[must_use]
pub fn reliability(statements: &[Statement]) -> Vec<Bin> {
    let mut sorted = statements.to_vec();
    sorted.sort_by(|a, b| a.probability.total_cmp(&b.probability));
    let bins = (sorted.len() / BIN_MIN).clamp(1, BINS);
    let (mut found, mut from) = (Vec::new(), 0);
    for number in 1..=bins {
        let edge = number * sorted.len() / bins;
        let alike = |s: &&Statement| edge > 0 && s.probability == sorted[edge - 1].probability;
        let to = edge + sorted[edge..].iter().take_while(alike).count();
        if to > from {
            found.push(bin(&sorted[from..to]));
            from = to;
        }
    }
    found
}

/// Expected calibration error: how far stated probabilities lie from what came out, mean over
/// statements (Naeini et al. 2015, with bins of equal count).
#[must_use]
#[allow(clippy::cast_precision_loss)]
pub fn calibration_error(statements: &[Statement]) -> f64 {
    let weighted = |bin: &Bin| (bin.stated - bin.true_share).abs() * bin.count as f64;
    reliability(statements).iter().map(weighted).sum::<f64>() / statements.len() as f64
}

/// The error that statements with these probabilities would show on average if every one came out as
/// stated: few statements scatter.
#[must_use]
pub fn error_by_chance(statements: &[Statement]) -> f64 {
    let mut random = ChaCha8Rng::seed_from_u64(CHANCE_SEED);
    let mut drawn = || {
        let came_out = |s: &Statement| {
            let is_true = random.random_bool(s.probability.clamp(0.0, 1.0));
            Statement { is_true, ..*s }
        };
        calibration_error(&statements.iter().map(came_out).collect::<Vec<_>>())
    };
    average(&(0..CHANCE_DRAWS).map(|_| drawn()).collect::<Vec<_>>())
}

#[allow(clippy::cast_precision_loss)]
fn bin(statements: &[Statement]) -> Bin {
    let stated: Vec<f64> = statements.iter().map(|s| s.probability).collect();
    let hits = statements.iter().filter(|s| s.is_true).count();
    let count = statements.len();
    Bin {
        stated: average(&stated),
        true_share: hits as f64 / count as f64,
        interval: wilson(hits, count),
        count,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(probability: f64, hits: usize, of: usize) -> Vec<Statement> {
        (0..of).map(|i| Statement { probability, is_true: i < hits }).collect()
    }

    #[test]
    fn who_says_what_comes_out_has_no_error() {
        let all: Vec<_> = [(0.25, 10), (0.5, 20), (1.0, 40)]
            .into_iter()
            .flat_map(|(p, hits)| said(p, hits, 40))
            .collect();
        assert!(calibration_error(&all) < 1e-12);
        let bins = reliability(&all);
        assert_eq!(
            bins.iter().map(|b| (b.stated, b.count)).collect::<Vec<_>>(),
            [(0.25, 40), (0.5, 40), (1.0, 40)]
        );
        assert!(error_by_chance(&all) > 0.01, "few statements scatter");
    }

    #[test]
    fn boasting_by_a_fifth_is_an_error_of_a_fifth() {
        assert!((calibration_error(&said(0.9, 28, 40)) - 0.2).abs() < 1e-12);
        // Half of them boast by 0.2, half are modest by 0.1.
        let both = [said(0.9, 28, 40), said(0.5, 24, 40)].concat();
        assert!((calibration_error(&both) - 0.15).abs() < 1e-12);
        assert!(calibration_error(&[]).is_nan() && reliability(&[]).is_empty());
    }

    #[test]
    fn bins_hold_as_many_each() {
        let all: Vec<_> = (0..80)
            .map(|i| Statement { probability: f64::from(i) / 80.0, is_true: i % 2 == 0 })
            .collect();
        let counts: Vec<_> = reliability(&all).iter().map(|bin| bin.count).collect();
        assert_eq!(counts, [8; 10]);
    }
}
