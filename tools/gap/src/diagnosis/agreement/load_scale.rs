//! Whether pressures and loads of the cylinders are on one scale: a wrong factor in a DBC makes chambers that
//! are never full, of which nothing can be judged.

use core::fmt;

use xt28_machine::{Machine, Wheel};

use crate::diagnosis::signals::{Samples, Signals};

/// Loads below this, as they are told and as pressures make them, tell no scale, root mean squares, N: a sensor with a
/// bias of 1 MPa makes 8 kN.
const LOADED_N: f64 = 1.0e4;
/// How many times more or less than what is told the pressures may make: areas of another machine or a sensor
/// that is off, not another unit.
const TIMES_MAX: f64 = 5.0;
/// Wheels that are off where a database is to blame: a frame has the pressures of two.
const WHEELS_MIN: usize = 2;

/// Pressures that do not make the loads that a log tells.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadScale {
    /// The wheels, each with what its pressures make of the load told, as a factor.
    pub wheels: Vec<(Wheel, f64)>,
}

/// The wheels whose pressures make another load than the frames tell, beyond any area of a cylinder, where it
/// is more than one. The ECU makes one of the other, so that they agree on every machine, sound or not.
pub(super) fn load_scale(runs: &[Signals], machine: &Machine) -> Option<LoadScale> {
    let off = |wheel: Wheel| {
        let times = times(runs, machine, wheel)?;
        let is_off = !(1.0 / TIMES_MAX..=TIMES_MAX).contains(&times);
        is_off.then_some((wheel, times))
    };
    let wheels: Vec<_> = Wheel::ALL.into_iter().filter_map(off).collect();
    (wheels.len() >= WHEELS_MIN).then_some(LoadScale { wheels })
}

/// What the pressures of `wheel` make of its load, by least squares; nothing where they are not logged, or
/// where it carries nothing.
#[allow(clippy::cast_precision_loss)]
fn times(runs: &[Signals], machine: &Machine, wheel: Wheel) -> Option<f64> {
    let (mut both, mut told, mut made, mut count) = (0.0, 0.0, 0.0, 0_usize);
    for s in runs {
        for (made_n, load_n) in pressed_n(s, machine, wheel).zip(&s.cylinder_load_n[wheel]) {
            (both, told) = (both + made_n * load_n, told + load_n * load_n);
            (made, count) = (made + made_n * made_n, count + 1);
        }
    }
    let is_loaded = told.max(made) > LOADED_N * LOADED_N * count.max(1) as f64;
    (is_loaded && told > 0.0).then(|| both / told)
}

/// What the pressures of `wheel` make, N, sample by sample; nothing where they are not logged.
pub(super) fn pressed_n(s: &Signals, machine: &Machine, wheel: Wheel) -> impl Iterator<Item = f64> {
    let [bore, rod] = &s.chamber_pa[wheel];
    made_n(machine, bore, rod)
}

/// What these pressures of a cylinder's two chambers make, N, sample by sample.
pub(super) fn made_n(
    machine: &Machine,
    bore_pa: &Samples,
    rod_pa: &Samples,
) -> impl Iterator<Item = f64> {
    let [area_bore_m2, area_rod_m2] = [machine.arms.area_bore_m2, machine.arms.area_rod_m2];
    let both = bore_pa.iter().zip(rod_pa);
    both.map(move |(bore, rod)| bore * area_bore_m2 - rod * area_rod_m2)
}

impl fmt::Display for LoadScale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let each = self.wheels.iter().map(|(wheel, times)| format!("{times:.2} on {wheel}"));
        write!(f, "{}", each.collect::<Vec<_>>().join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Channel, Series, Terrain};

    /// A machine whose arms carry 30 kN each, on pressures that make so many times that on some wheels.
    fn carrying(off: &[Wheel], times: f64) -> [Signals; 1] {
        let ten =
            |value: f64| -> Series { (0..1000).map(|i| (f64::from(i) * 0.01, value)).collect() };
        let bore_pa = 30e3 / Machine::xt28().arms.area_bore_m2;
        let reads = |channel: Channel| match channel {
            Channel::CylinderLoad(_) => 30e3,
            Channel::BorePressure(wheel) if off.contains(&wheel) => times * bore_pa,
            Channel::BorePressure(_) => bore_pa,
            _ => 0.0,
        };
        let all = Channel::all().into_iter().map(|channel| (channel, ten(reads(channel))));
        [Signals::of_series("made up", &all.collect(), 10.0, Terrain::Flat).unwrap()]
    }

    #[test]
    fn another_unit_is_told_and_a_sensor_or_another_cylinder_is_not() {
        let (front, machine) = ([Wheel::Fr, Wheel::Fl], Machine::xt28());
        let scale = |off: &[Wheel], times: f64| load_scale(&carrying(off, times), &machine);
        let found = scale(&front, 0.1).expect("a factor of ten");
        assert_eq!(found.to_string(), "0.10 on FR, 0.10 on FL");
        assert!(scale(&front, 14.5).is_some(), "psi for bar");
        assert_eq!(scale(&front, 0.5), None, "a cylinder of half the area");
        assert_eq!(scale(&front[..1], 0.0), None, "one sensor is dead");
        assert_eq!(scale(&[], 1.0), None);
        // Loads in tens of newtons look like those of arms that carry nothing.
        let mut tens = carrying(&[], 1.0);
        tens[0].cylinder_load_n.0.iter_mut().for_each(|load_n| load_n.fill(3e3));
        assert_eq!(load_scale(&tens, &machine).expect("a factor of ten").wheels.len(), 6);
    }

    #[test]
    fn what_pressures_make_is_told_by_the_cylinders_of_the_machine_that_was_logged() {
        let mut slender = Machine::xt28();
        slender.arms.area_bore_m2 *= 0.16;
        let logged = carrying(&Wheel::ALL, 1.0 / 0.16);
        assert_eq!(load_scale(&logged, &slender), None);
        assert!(load_scale(&logged, &Machine::xt28()).is_some());
    }
}
