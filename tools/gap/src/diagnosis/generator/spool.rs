//! Where the spool of a valve with play rests as a log begins.
//!
//! No log says it. A spool that rests off its command lets oil through, and as an automatic mode answers with
//! commands that do not cross the play, the arm it belongs to may carry less and less for the whole of a run.

use xt28_sim::effects::ValveHysteresis;

use super::arm_drive::ArmDrive;
use crate::diagnosis::signals::{DT_S, Samples};

/// A play below this is within what makers state, share of full opening: it is not worth a look.
const PLAY_MIN: f64 = 0.02;
/// How long a spool must lie where it began for that to matter, s.
const LIES_S: f64 = 0.5;
/// Places in the play that are tried first, shares of half of it off the command.
const PLACES: [f64; 5] = [-1.0, -0.5, 0.0, 0.5, 1.0];
/// How often the places to either side of the best are then closed in on it.
const ROUNDS: usize = 2;

/// What an arm's block says, by the place at which its spool began.
struct Tried {
    place: f64,
    errors_m: Samples,
    softness_m_n: Samples,
}

/// [`ArmDrive::stroke_errors_m`] with the spool's first place where it leaves least.
pub(super) fn stroke_errors_m(
    drive: &ArmDrive<'_>,
    hysteresis: ValveHysteresis,
    share: &[f64],
) -> (Samples, Samples) {
    let shut = drive.stroke_errors_m(share, None);
    if hysteresis.width < PLAY_MIN || drive.plays_late() || !lies_where_it_began(drive) {
        return shut;
    }
    let at = |place: f64| {
        let (errors_m, softness_m_n) = drive.stroke_errors_m(share, Some(place));
        Tried { place, errors_m, softness_m_n }
    };
    let mut tried: Vec<Tried> = PLACES.into_iter().map(at).collect();
    for _ in 0..ROUNDS {
        let best = best_of(&tried);
        let beside = tried[best.saturating_sub(1)..(best + 2).min(tried.len())].windows(2);
        let between: Vec<Tried> = beside.filter_map(between).map(at).collect();
        tried.extend(between);
        tried.sort_by(|a, b| a.place.total_cmp(&b.place));
    }
    let best = best_of(&tried);
    let best = tried.swap_remove(best);
    if square(&best.errors_m) < square(&shut.0) { (best.errors_m, best.softness_m_n) } else { shut }
}

/// Which of `tried` leaves least.
fn best_of(tried: &[Tried]) -> usize {
    let squares = tried.iter().map(|one| square(&one.errors_m)).enumerate();
    squares.min_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(0, |(best, _)| best)
}

/// Whether the valve asks for another speed by where its spool began, for some time.
fn lies_where_it_began(drive: &ArmDrive<'_>) -> bool {
    let [one, other] = [-1.0, 1.0].map(|place| drive.speeds_asked_m_s(Some(place)));
    let apart = one.iter().zip(&other).take_while(|(one, other)| one != other);
    apart.count() as f64 * DT_S > LIES_S
}

/// Sum of the squares of errors, where there are any.
pub(super) fn square(errors: &[f64]) -> f64 {
    errors.iter().filter(|e| e.is_finite()).map(|e| e * e).sum()
}

/// The place between two at which errors are least, if it is at neither: what comes in past the spool adds up alike
/// from either, so errors lie between.
fn between(pair: &[Tried]) -> Option<f64> {
    let [one, other] = pair else { return None };
    let both = one.errors_m.iter().zip(&other.errors_m);
    let (along, squares) = both
        .filter(|(a, b)| a.is_finite() && b.is_finite())
        .fold((0.0, 0.0), |sums, (a, b)| (sums.0 - a * (b - a), sums.1 + (b - a).powi(2)));
    let part = along / squares;
    (part > 0.0 && part < 1.0).then_some(one.place + part * (other.place - one.place))
}

#[cfg(test)]
mod tests {
    use xt28_machine::{Machine, Wheel};
    use xt28_sim::Effects;

    use super::super::still::still;
    use super::*;
    use crate::diagnosis::signals::Signals;

    /// An arm whose spool rests `place` off a command that stays within its play, so that it goes out or in.
    fn resting_at(place: f64, effects: &Effects) -> Signals {
        let (machine, mut s, w) = (Machine::xt28(), still(15), Wheel::Fl);
        s.chamber_pa[w] = [Vec::new(), Vec::new()];
        s.cylinder_load_n[w].fill(6.0e4);
        s.opening[w].fill(0.01);
        let asked_m_s = ArmDrive::new(&s, &machine, effects, w).speeds_asked_m_s(Some(place));
        let mut stroke_m = 0.25;
        for (at_m, m_s) in s.stroke_m[w].iter_mut().zip(&asked_m_s) {
            *at_m = stroke_m;
            stroke_m += m_s * DT_S;
        }
        s
    }

    #[test]
    fn an_arm_says_where_its_spool_rests() {
        let (machine, mut effects) = (Machine::xt28(), Effects::default());
        effects.arms[Wheel::Fl].hysteresis.width = 0.07;
        let largest_m = |errors: &Samples| errors.iter().fold(0.0_f64, |most, m| most.max(m.abs()));
        for place in [-0.93, -0.41, 0.2, 0.66] {
            let s = resting_at(place, &effects);
            let drive = ArmDrive::new(&s, &machine, &effects, Wheel::Fl);
            let found = stroke_errors_m(&drive, effects.arms[Wheel::Fl].hysteresis, &[]).0;
            let shut = drive.stroke_errors_m(&[], None).0;
            let [found_m, shut_m] = [&found, &shut].map(largest_m);
            assert!(found_m < 2.0e-4 && shut_m > 1.5e-3, "{place}: {found_m} m, shut {shut_m} m");
        }
    }

    #[test]
    fn a_valve_without_play_has_no_spool_to_look_for() {
        let (machine, effects) = (Machine::xt28(), Effects::default());
        let s = resting_at(0.0, &effects);
        let drive = ArmDrive::new(&s, &machine, &effects, Wheel::Fl);
        let found = stroke_errors_m(&drive, ValveHysteresis::default(), &[]);
        assert!(found == drive.stroke_errors_m(&[], None) && !lies_where_it_began(&drive));
    }
}
