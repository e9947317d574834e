//! Whether pressures and loads of the cylinders are on one scale: a wrong factor in a DBC makes chambers that
//! are never full, of which nothing can be judged.

use core::fmt;

use xt28_machine::{Machine, Wheel};

use super::signals::Signals;

/// Loads below this, as a root mean square, tell no scale, N.
const LOADED_N: f64 = 5.0e3;
/// How many times more or less than what is told the pressures may make: areas of another machine, not another
/// unit.
const TIMES_MAX: f64 = 3.0;

/// Pressures that do not make the loads that a log tells.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadScale {
    /// The wheels, each with what its pressures make of the load told, as a factor.
    pub wheels: Vec<(Wheel, f64)>,
}

/// The wheels whose pressures make another load than the frames tell, beyond any area of a cylinder. The ECU
/// makes one of the other, so that they agree on every machine, sound or not.
#[must_use]
pub fn load_scale(runs: &[Signals]) -> Option<LoadScale> {
    let off = |wheel: Wheel| {
        let times = times(runs, wheel)?;
        let is_off = !(1.0 / TIMES_MAX..=TIMES_MAX).contains(&times);
        is_off.then_some((wheel, times))
    };
    let wheels: Vec<_> = Wheel::ALL.into_iter().filter_map(off).collect();
    (!wheels.is_empty()).then_some(LoadScale { wheels })
}

/// What the pressures of `wheel` make of its load, by least squares; nothing where they are not logged, or
/// where it carries nothing.
#[allow(clippy::cast_precision_loss)]
fn times(runs: &[Signals], wheel: Wheel) -> Option<f64> {
    let arms = Machine::xt28().arms;
    let (mut both, mut told, mut count) = (0.0, 0.0, 0_usize);
    for s in runs {
        let [bore, rod] = &s.chamber_pa[wheel];
        for ((bore, rod), load_n) in bore.iter().zip(rod).zip(&s.cylinder_load_n[wheel]) {
            let made_n = bore * arms.area_bore_m2 - rod * arms.area_rod_m2;
            (both, told, count) = (both + made_n * load_n, told + load_n * load_n, count + 1);
        }
    }
    (told > LOADED_N * LOADED_N * count.max(1) as f64).then(|| both / told)
}

impl fmt::Display for LoadScale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let each = self.wheels.iter().map(|(wheel, times)| format!("{times:.2} on {wheel}"));
        write!(f, "{}", each.collect::<Vec<_>>().join(", "))
    }
}
