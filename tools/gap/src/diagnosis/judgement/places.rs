//! Blocks by their gap; wheels of one signal that part alike are one place.

use std::collections::BTreeMap;

use xt28_machine::{PerWheel, Wheel};
use xt28_sim::effects::{Block, Scope};

use crate::diagnosis::evidence::Left;
use crate::diagnosis::floor::Signal;
use crate::diagnosis::verdict::Place;

/// A wheel with more than this share of the worst wheel's gap parts as it does.
const ALIKE: f64 = 0.4;

/// Places by their gap, largest first.
pub(super) fn places(before: &[Left]) -> Vec<Place> {
    let excess = |left: &Left| (left.square - 1.0).max(0.0);
    let total: f64 = before.iter().map(excess).sum::<f64>().max(f64::MIN_POSITIVE);
    let place = |block: Block, scope: Scope, signal: Signal, of: &[&Left]| Place {
        block,
        scope,
        residual: signal.to_string(),
        gap_over_noise: of.iter().map(|left| left.square.sqrt()).fold(0.0, f64::max),
        share: of.iter().map(|left| excess(left)).sum::<f64>() / total,
    };
    let mut of_wheels: BTreeMap<String, Vec<(Wheel, &Left)>> = BTreeMap::new();
    let mut places = Vec::new();
    for left in before {
        match wheel(left) {
            Some(wheel) => {
                of_wheels.entry(left.signal.to_string()).or_default().push((wheel, left))
            }
            None => places.push(place(left.generator.block(), Scope::All, left.signal, &[left])),
        }
    }
    for wheels in of_wheels.values() {
        let mut gaps = PerWheel::splat(0.0);
        for (wheel, left) in wheels {
            gaps[*wheel] = left.square.sqrt();
        }
        for scope in scopes(&gaps) {
            let of: Vec<&Left> = wheels
                .iter()
                .filter(|(wheel, _)| scope.contains(*wheel))
                .map(|(_, l)| *l)
                .collect();
            if let Some(first) = of.first() {
                places.push(place(first.generator.block(), scope, first.signal, &of));
            }
        }
    }
    places.sort_by(|a, b| b.gap_over_noise.total_cmp(&a.gap_over_noise));
    places
}

fn wheel(left: &Left) -> Option<Wheel> {
    match left.signal {
        Signal::WheelSpeed(wheel) => Some(wheel),
        _ => left.generator.wheel(),
    }
}

/// The scope whose wheels are those that part alike, and the wheels beside it; wheel by wheel where
/// those that do have no name together.
fn scopes(gaps: &PerWheel<f64>) -> Vec<Scope> {
    let worst = Wheel::ALL.iter().map(|&wheel| gaps[wheel]).fold(0.0, f64::max);
    let alike = |wheel: Wheel| gaps[wheel] > ALIKE * worst;
    let together = Scope::ALL
        .into_iter()
        .find(|scope| Wheel::ALL.iter().all(|&wheel| scope.contains(wheel) == alike(wheel)));
    let rest = |scope: Scope| {
        Wheel::ALL.into_iter().filter(move |&wheel| !scope.contains(wheel)).map(Scope::Wheel)
    };
    match together {
        Some(scope) => std::iter::once(scope).chain(rest(scope)).collect(),
        None => Wheel::ALL.into_iter().map(Scope::Wheel).collect(),
    }
}

#[cfg(test)]
mod tests {
    use xt28_machine::Axle;

    use super::*;
    use crate::diagnosis::Generator;

    fn left(wheel: Wheel, square: f64) -> Left {
        Left {
            generator: Generator::ArmStroke(wheel),
            signal: Signal::Stroke,
            square,
            samples: 100.0,
        }
    }

    #[test]
    fn an_axle_that_parts_is_one_place() {
        let square = |wheel: Wheel| if wheel.axle() == Axle::Front { 100.0 } else { 1.0 };
        let before: Vec<Left> = Wheel::ALL.into_iter().map(|w| left(w, square(w))).collect();
        let places = places(&before);
        assert_eq!(places[0].scope, Scope::Axle(Axle::Front));
        assert!((places[0].gap_over_noise - 10.0).abs() < 1e-12);
        assert!((places[0].share - 1.0).abs() < 1e-12);
        assert_eq!(places.len(), 5);
    }

    #[test]
    fn wheels_without_a_name_together_stand_alone() {
        let square = |wheel| if matches!(wheel, Wheel::Fr | Wheel::Bl) { 81.0 } else { 1.0 };
        let before: Vec<Left> = Wheel::ALL.into_iter().map(|w| left(w, square(w))).collect();
        assert_eq!(places(&before).len(), 6);
    }
}
