//! Whether roll and pitch are on the scale of what the strokes say, and of the same sign: a wrong factor in a DBC
//! makes a machine that stands on no ground.

use core::fmt;

use xt28_machine::Machine;
use xt28_sim::Effects;

use super::along::Along;
use crate::diagnosis::floor::Signal;
use crate::diagnosis::generator::{Generator, Residual};
use crate::diagnosis::signals::Signals;

/// The two angles by their names, each with what is left of it within seconds: what stays, as a bracket that is not
/// level or ground that is not, says nothing of a scale.
const ANGLES: [(&str, Signal); 2] = [("roll", Signal::RollSway), ("pitch", Signal::PitchSway)];
/// Root mean square of what the strokes say that is too little to tell a scale by, rad: 0.04 deg.
const SWAYS_RAD: f64 = 7.0e-4;
/// How many times more or less than the strokes a reading may say. Of machines with a fault none had more
/// than 1.4: soft tyres, arms whose strokes are read wrong.
const TIMES_MAX: f64 = 4.0;

/// Angles that are not on the scale of the strokes.
#[derive(Clone, Debug, PartialEq)]
pub struct AttitudeScale {
    /// Each by its name, with how many times what the strokes say it reads; less than zero where it reads the
    /// other way round.
    pub angles: Vec<(&'static str, f64)>,
}

/// The angles of all `runs` that read another scale than how the machine stands on its wheels, where ground that
/// is known and arms that move tell.
pub(super) fn attitude_scale(runs: &[Signals], machine: &Machine) -> Option<AttitudeScale> {
    let all: Vec<[Sways; 2]> = runs.iter().map(|s| sways(s, machine)).collect();
    let off = |(k, (name, _)): (usize, (&'static str, Signal))| {
        let times = times(all.iter().map(|run| &run[k]))?;
        let is_off = !(1.0 / TIMES_MAX..=TIMES_MAX).contains(&times);
        is_off.then_some((name, times))
    };
    let angles: Vec<_> = ANGLES.into_iter().enumerate().filter_map(off).collect();
    (!angles.is_empty()).then_some(AttitudeScale { angles })
}

/// What strokes and reading say of one angle, rad, sample by sample.
type Sways = Vec<[f64; 2]>;

/// Both angles of a run: a block's error is what the strokes say less the reading, so that the error beside a
/// unit that reads nothing is what they say.
fn sways(s: &Signals, machine: &Machine) -> [Sways; 2] {
    let errors = |s: &Signals| Generator::Stance.residuals(s, machine, &Effects::default());
    let (read, mut level) = (s.clone(), s.clone());
    level.roll_rad.fill(0.0);
    level.pitch_rad.fill(0.0);
    let (read, level) = (errors(&read), errors(&level));
    ANGLES.map(|(_, signal)| {
        let of = |all: &[Residual]| {
            let one = all.iter().find(|residual| residual.signal == signal);
            one.map_or_else(Vec::new, |residual| residual.values.clone())
        };
        let sigma_rad = s.floors.sigma(Generator::Stance.key(), signal);
        let each = of(&level).into_iter().zip(of(&read));
        let both = each.filter(|(strokes, error)| strokes.is_finite() && error.is_finite());
        both.map(|(strokes, error)| [strokes, strokes - error].map(|x| x * sigma_rad)).collect()
    })
}

/// How many times what the strokes say a reading is; nothing where little happens or another thing is read.
fn times<'a>(runs: impl Iterator<Item = &'a Sways>) -> Option<f64> {
    let along = Along::of(runs.flatten().copied());
    let [strokes_rad, _] = along.means();
    along.times().filter(|_| strokes_rad > SWAYS_RAD)
}

impl AttitudeScale {
    /// What to look at: both sensors, and the order of wheels where an angle goes the other way.
    #[must_use]
    pub fn to_mend(&self) -> String {
        let turned =
            |angle: &str| self.angles.iter().any(|(name, times)| *name == angle && *times < 0.0);
        let orders = [("roll", "left and right"), ("pitch", "front and rear")];
        let orders = orders.into_iter().filter(|(angle, _)| turned(angle));
        let orders: String =
            orders.map(|(_, wheels)| format!(", or {wheels} are exchanged")).collect();
        format!("check unit, factor and sign of it and of the strokes in DBC and mapping{orders}")
    }
}

impl fmt::Display for AttitudeScale {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let each = self.angles.iter().map(|(name, times)| format!("{name} {times:.2} times"));
        write!(f, "{}", each.collect::<Vec<_>>().join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An arm that swings, and a reading of so many times that, so much later.
    fn swung(times: f64, late_s: f64) -> Sways {
        let at = |at_s: f64| 0.005 * (0.8 * at_s).sin();
        (0..400).map(|k| 0.1 * f64::from(k)).map(|t| [at(t), times * at(t - late_s)]).collect()
    }

    #[test]
    fn a_scale_is_told_of_one_motion_alone() {
        let of = |sways: &Sways| times(std::iter::once(sways));
        let found = of(&swung(10.0, 0.3)).unwrap();
        assert!((found - 10.0).abs() < 0.1, "{found}");
        assert!(of(&swung(0.1, 0.3)).is_some_and(|times| times < 0.11));
        assert_eq!(of(&swung(10.0, 2.0)), None, "it is read of something else");
        let turned = of(&swung(-1.0, 0.1)).unwrap();
        assert!((turned + 1.0).abs() < 0.01, "{turned}: it is read the other way round");
        let still: Sways =
            swung(10.0, 0.0).into_iter().map(|both| both.map(|x| 0.05 * x)).collect();
        assert_eq!(of(&still), None, "nothing moves");
    }
}
