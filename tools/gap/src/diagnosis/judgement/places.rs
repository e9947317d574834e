//! Blocks by what their gaps say; wheels of one signal that part alike are one place.

use std::collections::BTreeMap;

use xt28_machine::{PerWheel, Wheel};
use xt28_sim::effects::Scope;

use crate::diagnosis::evidence::Left;
use crate::diagnosis::floor::Signal;
use crate::diagnosis::generator::Generator;
use crate::diagnosis::verdict::{Place, Spot};

/// A wheel with more than this share of the worst wheel's gap parts as it does.
const ALIKE: f64 = 0.4;
/// Independent samples by which a gap is as sure as it gets: more of them do not make a place of two
/// floors out of what any model errs by, beside one of sixty.
const SURE: f64 = 40.0;

/// Places by what their gaps say, in nats: what goes once the best cause is believed, and what is then
/// still there beyond the floor; one of several wheels by the wheel that says most, as six that are each off by
/// little are no more than that. A gap that every machine has says nothing, however large it is.
pub(super) fn places(before: &[Left], after: &[Left]) -> Vec<Place> {
    // What was never measured has no gap, and not one of nothing.
    let measured = before.iter().zip(after).filter(|(before, _)| before.samples > 0.0);
    let all: Vec<Parting> = measured.map(Parting::new).collect();
    let total: f64 = all.iter().map(|parting| parting.excess).sum::<f64>().max(f64::MIN_POSITIVE);
    let mut places = Vec::new();
    let mut place = |scope: Scope, of: &[&Parting]| {
        let Some(Parting { left, .. }) = of.first() else { return };
        let place = Place {
            spot: spot((left.generator, left.signal), scope),
            gap_over_noise: of.iter().map(|p| p.left.square.sqrt()).fold(0.0, f64::max),
            share: of.iter().map(|parting| parting.excess).sum::<f64>() / total,
        };
        places.push((of.iter().map(|parting| parting.nats).fold(0.0, f64::max), place));
    };
    let mut of_wheels: BTreeMap<String, Vec<(Wheel, &Parting)>> = BTreeMap::new();
    for parting in &all {
        let (generator, signal) = (parting.left.generator, parting.left.signal);
        match wheel(generator, signal) {
            // How a machine stands takes one wheel off the ground by what another does: none is of others.
            Some(wheel) if matches!(signal, Signal::Contact(_)) => {
                place(Scope::Wheel(wheel), &[parting]);
            }
            Some(wheel) => {
                of_wheels.entry(signal.to_string()).or_default().push((wheel, parting));
            }
            None => place(Scope::All, &[parting]),
        }
    }
    for wheels in of_wheels.values() {
        let mut gaps = PerWheel::splat(0.0);
        for (wheel, parting) in wheels {
            gaps[*wheel] = parting.left.square.sqrt();
        }
        for scope in scopes(&gaps) {
            let within = wheels.iter().filter(|(wheel, _)| scope.contains(*wheel));
            place(scope, &within.map(|(_, parting)| *parting).collect::<Vec<_>>());
        }
    }
    let gap = |place: &Place| place.gap_over_noise;
    places.sort_by(|(a, one), (b, other)| b.total_cmp(a).then(gap(other).total_cmp(&gap(one))));
    places.into_iter().map(|(_, place)| place).collect()
}

/// How one signal parts.
struct Parting<'a> {
    left: &'a Left,
    /// Mean square beyond the floor's.
    excess: f64,
    /// What that says.
    nats: f64,
}

impl<'a> Parting<'a> {
    fn new((before, after): (&'a Left, &Left)) -> Self {
        let samples = before.samples.min(SURE);
        let cost = |square| Left { square, samples, ..*before }.cost();
        let nats = (cost(before.square) - cost(after.square.min(1.0))).max(0.0);
        Self { left: before, excess: (before.square - 1.0).max(0.0), nats }
    }
}

/// The signal in words, with its joint where it is of one.
fn residual(generator: Generator, signal: Signal) -> String {
    match (generator, signal) {
        (Generator::Joint(0) | Generator::SteerEcu(0), signal) => format!("front {signal}"),
        (Generator::Joint(_) | Generator::SteerEcu(_), signal) => format!("rear {signal}"),
        (_, signal) => signal.to_string(),
    }
}

fn wheel(generator: Generator, signal: Signal) -> Option<Wheel> {
    match signal {
        Signal::WheelSpeed(wheel) | Signal::Contact(wheel) => Some(wheel),
        _ => generator.wheel(),
    }
}

/// One signal of one generator at wheels that were chosen.
fn spot((generator, signal): (Generator, Signal), scope: Scope) -> Spot {
    let residual = residual(generator, signal);
    Spot { block: generator.block(), part: generator.part(), scope, residual }
}

impl Spot {
    /// Whether it is of this signal of this generator.
    pub(in crate::diagnosis) fn is_of(&self, generator: Generator, signal: Signal) -> bool {
        let own = wheel(generator, signal);
        own.is_none_or(|wheel| self.scope.contains(wheel))
            && spot((generator, signal), self.scope) == *self
    }
}

/// One signal of one generator, with the wheels that part as its own does where `places` name it.
pub(super) fn unexplained(at: (Generator, Signal), places: &[Place]) -> Spot {
    let own = wheel(at.0, at.1);
    let alone = spot(at, own.map_or(Scope::All, Scope::Wheel));
    let alike = places.iter().map(|place| &place.spot).find(|spot| {
        let is_there = own.is_none_or(|wheel| spot.scope.contains(wheel));
        spot.part == alone.part && spot.residual == alone.residual && is_there
    });
    Spot { scope: alike.map_or(alone.scope, |spot| spot.scope), ..alone }
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
    use xt28_sim::effects::Block;

    use super::*;
    use crate::diagnosis::Generator;

    fn left(wheel: Wheel, square: f64) -> Left {
        Left::evenly(Generator::ArmStroke(wheel), Signal::Stroke, square, 100.0)
    }

    #[test]
    fn an_axle_that_parts_is_one_place() {
        let square = |wheel: Wheel| if wheel.axle() == Axle::Front { 100.0 } else { 1.0 };
        let before: Vec<Left> = Wheel::ALL.into_iter().map(|w| left(w, square(w))).collect();
        let places = places(&before, &before);
        assert_eq!(places[0].spot.scope, Scope::Axle(Axle::Front));
        assert!((places[0].gap_over_noise - 10.0).abs() < 1e-12);
        assert!((places[0].share - 1.0).abs() < 1e-12);
        assert_eq!(places.len(), 5);
    }

    #[test]
    fn what_is_unexplained_has_the_wheels_of_its_place() {
        let square = |wheel: Wheel| if wheel.axle() == Axle::Front { 100.0 } else { 1.0 };
        let before: Vec<Left> = Wheel::ALL.into_iter().map(|w| left(w, square(w))).collect();
        let places = places(&before, &before);
        let of = |wheel| unexplained((Generator::ArmStroke(wheel), Signal::Stroke), &places).scope;
        assert_eq!(of(Wheel::Fl), Scope::Axle(Axle::Front));
        assert_eq!(of(Wheel::Br), Scope::Wheel(Wheel::Br));
    }

    #[test]
    fn wheels_without_a_name_together_stand_alone() {
        let square = |wheel| if matches!(wheel, Wheel::Fr | Wheel::Bl) { 81.0 } else { 1.0 };
        let before: Vec<Left> = Wheel::ALL.into_iter().map(|w| left(w, square(w))).collect();
        assert_eq!(places(&before, &before).len(), 6);
    }

    #[test]
    fn a_wheel_that_seems_to_hang_is_told_alone_whatever_the_others_do() {
        let of = |generator, signal| Left { generator, signal, ..left(Wheel::Fr, 81.0) };
        let signal = Signal::Contact(Wheel::Ml);
        let both = [of(Generator::Stance, signal), of(Generator::Joint(1), Signal::JointAngle)];
        let places_of = places(&both, &both);
        let [one, other] = &places_of[..] else { panic!("two places") };
        let hangs = (Scope::Wheel(Wheel::Ml), "touch of the ground");
        assert_eq!((one.spot.scope, one.spot.residual.as_str()), hangs);
        assert!(one.spot.is_of(Generator::Stance, signal) && one.spot.has_wheels());
        assert!(!one.spot.is_of(Generator::Stance, Signal::Contact(Wheel::Fr)));
        assert_eq!(unexplained((Generator::Stance, signal), &places_of), one.spot);
        assert_eq!(other.spot.residual, "rear joint angle");
        let axle = [Wheel::Fr, Wheel::Fl].map(|w| of(Generator::Stance, Signal::Contact(w)));
        assert_eq!(places(&axle, &axle).len(), 2);
    }

    #[test]
    fn a_gap_of_sixty_floors_comes_before_one_of_two_that_has_more_samples() {
        let of = |generator, signal, floors: f64, samples| {
            Left::evenly(generator, signal, floors * floors, samples)
        };
        let arm = |floors| of(Generator::ArmStroke(Wheel::Fr), Signal::Stroke, floors, 150.0);
        let weight = |floors| of(Generator::Stance, Signal::Weight, floors, 17.0);
        let places = places(&[arm(2.2), weight(60.0)], &[arm(1.0), weight(2.0)]);
        assert_eq!(places[0].spot.block, Block::Payload);
    }

    #[test]
    fn six_wheels_that_are_off_by_little_come_after_one_speed_that_is_off_by_more() {
        let arms = Wheel::ALL.into_iter().map(|wheel| left(wheel, 1.9 * 1.9));
        let speed = Left::evenly(Generator::Travel, Signal::TravelSpeed, 3.0 * 3.0, 40.0);
        let before: Vec<Left> = arms.chain([speed]).collect();
        let places = places(&before, &before);
        assert_eq!(places[0].spot.block, Block::Drive);
        assert_eq!((places[1].spot.block, places[1].spot.scope), (Block::Arms, Scope::All));
    }

    #[test]
    fn what_a_cause_explains_comes_before_a_gap_that_stays() {
        let roll = |square| Left::evenly(Generator::Stance, Signal::Roll, square, 30.0);
        let joint = |square| Left::evenly(Generator::Joint(0), Signal::JointAngle, square, 100.0);
        let places = places(&[roll(1.4), joint(1.2)], &[roll(1.4), joint(0.2)]);
        assert_eq!(places[0].spot.block, Block::Steering);
    }
}
