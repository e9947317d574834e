//! The hypotheses worth a fit: all are looked at on a coarse grid, the promising ones followed.

mod jumped;

use rayon::prelude::*;
use xt28_sim::effects::{Effect, Parameter};

use super::evidence::{Evidence, Memory};
use super::generator::Generator;
use super::hypothesis::{Fit, Hypothesis};
use super::onset::{Onset, once_least};

/// Grid of the first look, in tolerances from neutral.
const REACHES: [f64; 8] = [-30.0, -10.0, -4.0, -1.5, 1.5, 4.0, 10.0, 30.0];
/// The same for what has its neutral value at an end of its range, a delay for one: what comes late by
/// much gains nothing until it is late by nearly all of it, so the grid is close.
const FURTHER: [f64; 12] = [1.5, 3.0, 5.0, 7.0, 9.0, 11.0, 13.0, 15.0, 18.0, 21.0, 25.0, 30.0];
/// Grid of a parameter beside a fraction of another, in tolerances.
const BESIDE: [f64; 3] = [10.0, 20.0, 40.0];
/// Amounts beside which a parameter is looked at that does nothing without one, and how far it goes then,
/// in tolerances: a drift, and the load below which it sets in.
const AMOUNTS: [f64; 2] = [3.0, 6.0];
const THRESHOLDS: [f64; 4] = [-4.0, -1.5, 1.5, 4.0];
/// Parts of itself that a limit is looked at, and tolerances of what goes with it there.
const LOWERED: [f64; 4] = [0.5, 0.35, 0.2, 0.1];
const WITH_LOWERED: [f64; 3] = [1.5, 4.0, 10.0];
/// Instants of a test drive from which an effect is looked for, s; what sets in between is seen at one. Longer runs
/// have them as much further apart.
const LOOKED_FROM_S: [f64; 4] = [0.0, 6.0, 12.0, 18.0];
/// What an effect that sets in late must gain beyond one that was always there, nats.
const LATE_MIN: f64 = 6.0;
/// How many hypotheses are followed to their best values.
const FOLLOWED: usize = 24;
/// What the best of an effect must gain to be followed beside them, nats.
const MUCH: f64 = 12.0;
/// How many starts of one hypothesis, if they are the leading ones.
const STARTS: usize = 2;
/// Hypotheses that count as leading.
const LEADING: usize = 6;
/// A start must gain this much, nats.
const GAIN_MIN: f64 = 0.5;

/// A hypothesis with the best values of the first look.
#[derive(Clone, Debug)]
struct Start {
    hypothesis: Hypothesis,
    values: Vec<f64>,
    onset: Onset,
    gain: f64,
}

/// Fits of the hypotheses that may explain something, there always, from late in every run on or from
/// one instant of the day on, the likeliest first.
#[must_use]
pub fn search(evidence: &Evidence<'_>, effects: &[&'static Effect]) -> Vec<Fit> {
    let mut starts: Vec<Start> =
        effects.par_iter().flat_map_iter(|effect| first_look(evidence, effect)).collect();
    starts.extend(jumped::starts(evidence, effects));
    starts.retain(|start| start.gain > GAIN_MIN);
    starts.sort_by(|a, b| weight(b).total_cmp(&weight(a)));
    let followed = followed(&starts);
    let mut fits: Vec<Fit> = followed
        .into_par_iter()
        .map(|start| start.hypothesis.refit(evidence, start.onset, &start.values))
        .collect();
    fits.sort_by(|a, b| b.log_evidence.total_cmp(&a.log_evidence));
    let mut best: Vec<Fit> = Vec::new();
    for fit in fits {
        if best.iter().all(|known| known.hypothesis != fit.hypothesis) {
            best.push(fit);
        }
    }
    best
}

/// Those of `starts`, the weightiest first, that are worth following: of the leading hypotheses, and the best of every
/// effect that gains much. Where a pressure reading jumps, all that an arm can have gains by its oil that begins anew, at
/// every scope, and would leave no place for the reading.
fn followed(starts: &[Start]) -> Vec<&Start> {
    let mut followed: Vec<&Start> = Vec::new();
    let mut hypotheses: Vec<Hypothesis> = Vec::new();
    for start in starts {
        let known = hypotheses.iter().position(|known| *known == start.hypothesis);
        let again = followed.iter().filter(|other| other.hypothesis == start.hypothesis).count();
        let is_first = || hypotheses.iter().all(|known| known.effect != start.hypothesis.effect);
        match known {
            Some(rank) if rank < LEADING && again < STARTS => followed.push(start),
            None if hypotheses.len() < FOLLOWED || (start.gain > MUCH && is_first()) => {
                hypotheses.push(start.hypothesis);
                followed.push(start);
            }
            _ => {}
        }
    }
    followed
}

fn weight(start: &Start) -> f64 {
    start.gain + start.hypothesis.log_prior()
}

/// Onsets of the first look: instants of every run, and the starts of all runs but the first on their day.
fn looked_from(evidence: &Evidence<'_>) -> Vec<Onset> {
    let every = LOOKED_FROM_S.map(|at_s| Onset::in_every_run(at_s * evidence.stretch()));
    let once = evidence.starts_on_the_day_s().into_iter().map(Onset::once);
    every.into_iter().chain(once).collect()
}

/// The onset of most worth, and what that is, nats: `gains` are those of each of `onsets`.
fn best_onset(onsets: &[Onset], gains: impl Iterator<Item = f64>) -> Option<(Onset, f64)> {
    let late = |(onset, gain): (&Onset, f64)| {
        let least = if onset.is_late() && !onset.is_once() { LATE_MIN } else { 0.0 };
        (*onset, gain - least)
    };
    let (once, each): (Vec<_>, Vec<_>) =
        onsets.iter().zip(gains).map(late).partition(|(onset, _)| onset.is_once());
    let best = |all: Vec<(Onset, f64)>| all.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
    let each = best(each)?;
    let once = best(once).map(|(onset, gain)| (onset, gain - once_least(each.1)));
    Some(once.filter(|once| once.1 > each.1).unwrap_or(each))
}

/// All scopes of one effect on the grid. What a single arm does with some values is the same at every
/// scope that has the arm, and is remembered.
fn first_look(evidence: &Evidence<'_>, effect: &'static Effect) -> Vec<Start> {
    let mut memory = Memory::new();
    let onsets = looked_from(evidence);
    let mut starts = Vec::new();
    for hypothesis in Hypothesis::of(&[effect]) {
        for values in grid(effect.parameters) {
            let supposed = hypothesis.supposed(evidence, &values);
            let only = |generator: Generator| generator.hears(effect, hypothesis.scope);
            let remembered = (&values[..], &mut memory);
            let costs = evidence.costs_remembered(&supposed, &only, &onsets, remembered);
            let gains = costs.into_iter().map(|cost| 0.5 * (evidence.base_cost() - cost));
            if let Some((onset, gain)) = best_onset(&onsets, gains) {
                starts.push(Start { hypothesis, values, onset, gain });
            }
        }
    }
    starts
}

/// Values in equal ratios from neutral down to the least, for what is neutral at the upper end of a
/// positive range: a limit that is far away changes nothing, so that no slope leads to it.
fn falling(p: &Parameter) -> impl Iterator<Item = f64> {
    let [least, most] = p.range;
    let is_limit = least > 0.0 && p.neutral == most;
    let values = move |share: f64| most * (least / most).powf(share);
    [0.35, 0.5, 0.6, 0.7, 0.8].into_iter().filter(move |_| is_limit).map(values)
}

/// All parameters as they are without the effect.
fn without(parameters: &[Parameter]) -> Vec<f64> {
    parameters.iter().map(|p| p.neutral).collect()
}

/// So many tolerances from neutral, or as far as the parameter goes.
fn at(p: &Parameter, reach: f64) -> f64 {
    (p.neutral + reach * p.tolerance).clamp(p.range[0], p.range[1])
}

/// One parameter at a time on both sides of neutral, near and far.
fn grid(parameters: &[Parameter]) -> Vec<Vec<f64>> {
    let mut grid: Vec<Vec<f64>> = Vec::new();
    for (k, p) in parameters.iter().enumerate() {
        let sign = if p.neutral == p.range[0] { 1.0 } else { -1.0 };
        let far = FURTHER.map(|reach| sign * reach);
        let reaches = if p.is_one_sided() { &far[..] } else { &REACHES[..] };
        let near = reaches.iter().map(|reach| p.neutral + reach * p.tolerance);
        for value in near.chain(falling(p)) {
            let mut values = without(parameters);
            values[k] = value.clamp(p.range[0], p.range[1]);
            if values[k] != p.neutral && !grid.contains(&values) {
                grid.push(values);
            }
        }
        for values in fractions(parameters, k) {
            grid.extend(beside(parameters, k, &values));
            grid.push(values);
        }
        for values in with_amounts(parameters, k).into_iter().chain(lowered(parameters, k)) {
            if !grid.contains(&values) {
                grid.push(values);
            }
        }
    }
    grid
}

/// A parameter that can go both ways beside amounts of one that is neutral at none, where there is such.
fn with_amounts(parameters: &[Parameter], k: usize) -> Vec<Vec<f64>> {
    let amount = parameters.iter().position(|p| p.neutral == p.range[0]);
    let (p, Some(j)) = (&parameters[k], amount) else { return Vec::new() };
    if p.is_one_sided() {
        return Vec::new();
    }
    let reaches = AMOUNTS.iter().flat_map(|much| THRESHOLDS.map(|far| (*much, far)));
    let values = |(much, far)| {
        let mut values = without(parameters);
        (values[j], values[k]) = (at(&parameters[j], much), at(p, far));
        values
    };
    reaches.map(values).collect()
}

/// What can fall to less than a tenth of itself within few tolerances, alone and beside what goes both ways: the
/// friction of slippery ground does nothing until wheels slide, so that no slope leads to it from where its slip is
/// found, and no slip alone explains wheels that slide.
fn lowered(parameters: &[Parameter], k: usize) -> Vec<Vec<f64>> {
    let Parameter { neutral, range: [least, _], tolerance, .. } = parameters[k];
    if !(least > 0.0 && neutral > 10.0 * least && neutral - least <= 10.0 * tolerance) {
        return Vec::new();
    }
    let alone = LOWERED.map(|part| {
        let mut values = without(parameters);
        values[k] *= part;
        values
    });
    let both_ways = |j: &usize| *j != k && !parameters[*j].is_one_sided();
    let beside = (0..parameters.len()).filter(both_ways).flat_map(|j| {
        let (p, alone) = (&parameters[j], &alone);
        WITH_LOWERED.into_iter().flat_map(move |reach| {
            alone.iter().map(move |values| {
                let mut values = values.clone();
                values[j] = at(p, reach);
                values
            })
        })
    });
    beside.chain(alone.iter().cloned()).collect()
}

/// What can only be positive may be a fraction of itself, far beyond its tolerances: a tyre's stiffness.
fn fractions(parameters: &[Parameter], k: usize) -> Vec<Vec<f64>> {
    let Parameter { neutral, range: [least, _], tolerance, .. } = parameters[k];
    let fraction = |share: f64| {
        let mut values = without(parameters);
        values[k] *= (least / neutral).powf(share);
        values
    };
    let far = least > 0.0 && neutral - least > 10.0 * tolerance;
    if far { [0.3, 0.45, 0.55, 0.65, 0.75, 0.85].map(fraction).to_vec() } else { Vec::new() }
}

/// The same beside what another parameter does that is neutral at an end of its range: an engine that
/// has lost power and droops under the rest does neither alone.
fn beside(parameters: &[Parameter], k: usize, values: &[f64]) -> Vec<Vec<f64>> {
    let others = parameters.iter().enumerate().filter(|(j, p)| *j != k && p.neutral == p.range[0]);
    let with = |(j, p): (usize, &Parameter)| {
        BESIDE.map(|reach| {
            let mut values = values.to_vec();
            values[j] = at(p, reach);
            values
        })
    };
    others.flat_map(with).collect()
}

#[cfg(test)]
mod tests {
    use xt28_sim::effects::{Scope, find};

    use super::*;

    #[test]
    fn an_effect_that_gains_much_is_followed_beside_many_scopes_of_others() {
        let start = |hypothesis: &Hypothesis, gain: f64| Start {
            hypothesis: *hypothesis,
            values: Vec::new(),
            onset: Onset::ALWAYS,
            gain,
        };
        let of = |name: &str| Hypothesis::of(&[find(name).unwrap()]);
        let others = ["leakage-drift", "valve-hysteresis", "speed-asymmetry"].map(of).concat();
        assert!(others.len() > FOLLOWED);
        let mut starts: Vec<Start> = others.iter().map(|other| start(other, 90.0)).collect();
        for (name, gain) in [("pressure-scale", MUCH + 1.0), ("stroke-scale", MUCH - 1.0)] {
            starts.extend(of(name).iter().map(|own| start(own, gain)));
        }
        let followed = followed(&starts);
        let is = |start: &&Start, name: &str| start.hypothesis.effect.name == name;
        let count = |name: &str| followed.iter().filter(|start| is(start, name)).count();
        assert_eq!((followed.len(), count("pressure-scale"), count("stroke-scale")), (26, 1, 0));
    }

    #[test]
    fn the_grid_stays_in_range_and_names_nothing_twice() {
        for name in [
            "arm-delay",
            "speed-asymmetry",
            "payload",
            "pump-flow-limit",
            "unsupported-sag",
            "slippery-ground",
        ] {
            let p = find(name).unwrap().parameters;
            let grid = grid(p);
            assert!(grid.len() >= 2, "{name}");
            for (i, values) in grid.iter().enumerate() {
                assert!(!grid[..i].contains(values));
                for (value, p) in values.iter().zip(p) {
                    assert!((p.range[0]..=p.range[1]).contains(value), "{name}");
                }
            }
        }
        let sag = grid(find("unsupported-sag").unwrap().parameters);
        assert!(sag.iter().any(|values| values[0] > 0.0 && values[1] > 0.0));
        let slides = |values: &Vec<f64>| values[0] < 0.4 && values[1] > 0.1;
        assert!(grid(find("slippery-ground").unwrap().parameters).iter().any(slides));
        assert_eq!(Scope::ALL.len(), Hypothesis::of(&[find("arm-delay").unwrap()]).len());
    }
}
