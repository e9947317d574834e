//! Whether the pressures of a cylinder are of the chambers that they are named after: bore and rod in each other's
//! place make a load that no frame tells, and an arm that looks broken.

use core::fmt;

use xt28_machine::{Machine, Wheel};

use super::load_scale::made_n;
use crate::diagnosis::signals::Signals;

/// Pressures that miss the load told by less, N, are in their places: loads come at another rate.
const MISSED_N: f64 = 4.0e3;
/// Share of that by which they may miss it in each other's places, if those are theirs.
const MISSED_SHARE: f64 = 0.25;

/// Wheels whose pressures of bore and rod look swapped.
#[derive(Clone, Debug, PartialEq)]
pub struct SwappedChambers {
    /// The wheels.
    pub wheels: Vec<Wheel>,
}

/// The wheels whose pressures make the load that their frame tells only in each other's places. The ECU makes
/// one of the other, so that they agree on every machine, sound or not.
pub(super) fn swapped_chambers(runs: &[Signals], machine: &Machine) -> Option<SwappedChambers> {
    let is_swapped = |wheel: &Wheel| {
        let [as_named_n, swapped_n] = missed_n(runs, machine, *wheel);
        as_named_n > MISSED_N && swapped_n < MISSED_SHARE * as_named_n
    };
    let wheels: Vec<Wheel> = Wheel::ALL.into_iter().filter(is_swapped).collect();
    (!wheels.is_empty()).then_some(SwappedChambers { wheels })
}

/// Root mean squares of what the pressures of `wheel` make less the load told, N: as they are named, and in
/// each other's places; zeros where they are not logged.
#[allow(clippy::cast_precision_loss)]
fn missed_n(runs: &[Signals], machine: &Machine, wheel: Wheel) -> [f64; 2] {
    let (mut squares, mut count) = ([0.0; 2], 0_usize);
    for s in runs {
        let [bore, rod] = &s.chamber_pa[wheel];
        let made = made_n(machine, bore, rod).zip(made_n(machine, rod, bore));
        for ((as_named_n, swapped_n), load_n) in made.zip(&s.cylinder_load_n[wheel]) {
            squares[0] += (as_named_n - load_n).powi(2);
            squares[1] += (swapped_n - load_n).powi(2);
            count += 1;
        }
    }
    squares.map(|square| (square / count.max(1) as f64).sqrt())
}

impl fmt::Display for SwappedChambers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let each = self.wheels.iter().map(|wheel| {
            format!("bore_pressure.{wheel} reads the rod's and rod_pressure.{wheel} the bore's")
        });
        write!(f, "{}", each.collect::<Vec<_>>().join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Channel, Series, Terrain};

    /// A machine whose arms carry `load_n` each, with 0.5 MPa where nothing pushes, and chambers in each other's
    /// places on `swapped`.
    fn carrying(load_n: f64, swapped: &[Wheel]) -> [Signals; 1] {
        let arms = Machine::xt28().arms;
        let ten =
            |value: f64| -> Series { (0..1000).map(|i| (f64::from(i) * 0.01, value)).collect() };
        let rod_pa = 0.5e6;
        let bore_pa = (load_n + rod_pa * arms.area_rod_m2) / arms.area_bore_m2;
        let reads = |channel: Channel| match channel {
            Channel::CylinderLoad(_) => load_n,
            Channel::BorePressure(w) => {
                if swapped.contains(&w) {
                    rod_pa
                } else {
                    bore_pa
                }
            }
            Channel::RodPressure(w) => {
                if swapped.contains(&w) {
                    bore_pa
                } else {
                    rod_pa
                }
            }
            _ => 0.0,
        };
        let all = Channel::all().into_iter().map(|channel| (channel, ten(reads(channel))));
        [Signals::of_series("made up", &all.collect(), 10.0, Terrain::Flat).unwrap()]
    }

    #[test]
    fn chambers_swapped_on_one_wheel_are_told_by_the_channels_to_mend() {
        for wheel in Wheel::ALL {
            let found = swapped_chambers(&carrying(25e3, &[wheel]), &Machine::xt28())
                .expect("they are swapped");
            assert_eq!(found.wheels, [wheel]);
        }
        let told =
            swapped_chambers(&carrying(25e3, &[Wheel::Ml]), &Machine::xt28()).unwrap().to_string();
        assert_eq!(told, "bore_pressure.ML reads the rod's and rod_pressure.ML the bore's");
    }

    #[test]
    fn chambers_in_their_places_are_not_complained_of_whatever_they_carry() {
        for load_n in [-5e3, 0.0, 25e3, 120e3] {
            assert_eq!(swapped_chambers(&carrying(load_n, &[]), &Machine::xt28()), None);
        }
    }

    /// A sensor that reads nothing, or twice as much, makes another load, and not in the other's place either.
    #[test]
    fn a_broken_sensor_is_no_swap() {
        for (bore, rod) in [(0.0, 1.0), (2.0, 1.0), (1.0, 30.0), (0.0, 0.0)] {
            let [mut signals] = carrying(25e3, &[]);
            let [of_bore, of_rod] = &mut signals.chamber_pa[Wheel::Fr];
            of_bore.iter_mut().for_each(|pa| *pa *= bore);
            of_rod.iter_mut().for_each(|pa| *pa *= rod);
            assert_eq!(swapped_chambers(&[signals], &Machine::xt28()), None, "{bore} {rod}");
        }
    }
}
