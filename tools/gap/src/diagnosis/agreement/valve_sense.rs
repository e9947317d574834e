//! Whether each arm goes the way that its valve's currents ask: the two solenoids of a valve in each other's place
//! make an ECU that looks wrong, and, on all arms, wheels that look swapped.

use core::fmt;

use xt28_machine::Wheel;

use super::along::Along;
use crate::diagnosis::signals::Signals;

/// Opening beyond which a valve moves its arm, whatever its dead band and its leaks (assumed).
const OPENS: f64 = 0.15;
/// Samples of a log from one that is looked at to the next: an arm's valve is wide open for seconds of a drive.
const LOOKED_EVERY: usize = 4;
/// Rate of an arm that hardly moves, m/s.
const MOVES_M_S: f64 = 0.004;

/// Arms that go against their valves.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TurnedValves {
    /// Their wheels.
    pub wheels: Vec<Wheel>,
    /// Whether no arm goes along with its valve.
    pub are_all: bool,
}

/// The arms of all `runs` that go in where their valve is open outward and out where it is open inward, as no valve
/// lets them.
pub(super) fn turned_valves(runs: &[Signals]) -> Option<TurnedValves> {
    let times = Wheel::ALL.map(|wheel| (wheel, times(runs, wheel)));
    let turned = times.iter().filter(|(_, times)| times.is_some_and(|times| times < 0.0));
    let wheels: Vec<Wheel> = turned.map(|(wheel, _)| *wheel).collect();
    let are_all = !times.iter().any(|(_, times)| times.is_some_and(|times| times > 0.0));
    (!wheels.is_empty()).then_some(TurnedValves { wheels, are_all })
}

/// How fast the arm of a wheel goes for a valve that is wide open, m/s; less than zero where it goes the other way,
/// nothing where it is hardly asked to go or goes anyhow.
fn times(runs: &[Signals], wheel: Wheel) -> Option<f64> {
    let asked = runs.iter().flat_map(|s| {
        let samples = (0..s.len).step_by(LOOKED_EVERY);
        let pairs = samples.map(|i| [s.opening[wheel][i], s.stroke_rate_m_s[wheel][i]]);
        pairs.filter(|[opening, _]| opening.abs() > OPENS)
    });
    let along = Along::of(asked);
    let [_, rate_m_s] = along.means();
    along.times().filter(|_| rate_m_s > MOVES_M_S)
}

impl fmt::Display for TurnedValves {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let wheels: Vec<String> = self.wheels.iter().map(Wheel::to_string).collect();
        write!(f, "retract_current and extend_current of {} are exchanged", wheels.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::generator::still;
    use super::*;

    /// Arms that go to and fro at 0.2 m/s for an open valve, FR's at so many `times` that, and the others'.
    fn swinging(times: f64, others: f64) -> [Signals; 1] {
        let mut s = still::still(20);
        for wheel in Wheel::ALL {
            let times = if wheel == Wheel::Fr { times } else { others };
            for i in 0..s.len {
                let opening = 0.4 * f64::from(u32::try_from(i).unwrap() / 200 % 2) - 0.2;
                s.opening[wheel][i] = opening;
                s.stroke_rate_m_s[wheel][i] = 0.2 * times * opening;
            }
        }
        [s]
    }

    #[test]
    fn a_valve_with_its_solenoids_exchanged_is_told() {
        let turned = |times, others| turned_valves(&swinging(times, others));
        assert_eq!(turned(1.0, 1.0), None);
        let one = turned(-1.0, 1.0).unwrap();
        assert_eq!((&one.wheels[..], one.are_all), (&[Wheel::Fr][..], false));
        assert!(one.to_string().ends_with("extend_current of FR are exchanged"), "{one}");
        let all = turned(-1.0, -1.0).unwrap();
        assert_eq!((all.wheels.len(), all.are_all), (6, true));
        assert_eq!(turned(-0.05, 1.0), None, "an arm that creeps goes where its load has it");
    }

    #[test]
    fn an_arm_that_sinks_under_its_valves_correction_is_none() {
        let mut runs = swinging(1.0, 1.0);
        runs[0].opening[Wheel::Ml].fill(0.1);
        runs[0].stroke_rate_m_s[Wheel::Ml].fill(-0.02);
        assert_eq!(turned_valves(&runs), None);
    }
}
