//! How attitude and strokes part within seconds.
//!
//! Where they part for good says how a unit is mounted, how level the ground is and how strokes are read, and
//! arms that lift wheels change that. A filter that follows late or does not believe its gyroscopes parts from the
//! strokes with every turn and comes back to them in seconds: that is left once the error's own recent
//! mean is taken off it.

use super::instants::STEP_S;
use crate::diagnosis::signals::Samples;

/// Time over which the mean is taken, s: somewhat longer than the firmware's filter follows in (2 s for roll, 1 s
/// for pitch; facts 5).
const RECENT_S: f64 = 3.0;
/// Time over which an error counts as one of now, s. A machine that rocks on its arms, at one or two hertz, shakes
/// the unit, which takes that for leaning to and fro.
const NOW_S: f64 = 0.5;

/// How errors of an angle change within seconds, rad: each beside whether the machine is calm, one an instant.
///
/// `NaN` where there is none, and while the machine gains or loses speed, which the unit takes for a lean:
/// what comes then is no part of the mean. Where that lasts longer than the mean reaches back, as under a controller
/// that never holds its speed, what was before is not recent any more.
pub(super) fn sways_rad(errors: impl Iterator<Item = (f64, bool)>) -> Samples {
    let mut means_rad: Option<[f64; 2]> = None;
    let mut uneasy_s = 0.0;
    let sway = |(error_rad, is_calm): (f64, bool)| {
        uneasy_s = if is_calm { 0.0 } else { uneasy_s + STEP_S };
        if !error_rad.is_finite() || uneasy_s > RECENT_S {
            means_rad = None;
        }
        if !error_rad.is_finite() || !is_calm {
            return f64::NAN;
        }
        let [now, recent] = means_rad.unwrap_or([error_rad; 2]);
        let follow = |mean_rad: f64, time_s: f64| {
            error_rad + (mean_rad - error_rad) * (-STEP_S / time_s).exp()
        };
        let (now, recent) = (follow(now, NOW_S), follow(recent, RECENT_S));
        means_rad = Some([now, recent]);
        now - recent
    };
    errors.map(sway).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sways(errors: &[f64], is_calm: impl Fn(usize) -> bool) -> Samples {
        sways_rad(errors.iter().enumerate().map(|(k, error)| (*error, is_calm(k))))
    }

    #[test]
    fn what_stays_is_no_sway_and_what_comes_is_one_for_seconds() {
        let sways = sways(&[[0.01; 40], [0.03; 40]].concat(), |_| true);
        assert!(sways[..40].iter().all(|sway| sway.abs() < 1e-12));
        assert!((0.010..0.020).contains(&sways[44]), "{}", sways[44]);
        assert!((0.004..0.010).contains(&sways[52]), "{}", sways[52]);
        assert!(sways[79].abs() < 0.001);
    }

    #[test]
    fn rocking_is_none() {
        let rocks: Vec<f64> = (0..80).map(|k| [0.0, 0.01, 0.0, -0.01][k % 4]).collect();
        assert!(sways(&rocks, |_| true).iter().all(|sway| sway.abs() < 0.004));
    }

    #[test]
    fn what_a_machine_that_speeds_up_feels_is_forgotten() {
        let felt = [[0.01; 10], [0.05; 10], [0.01; 10]].concat();
        let sways = sways(&felt, |k| !(10..20).contains(&k));
        assert!(sways[10..20].iter().all(|sway| sway.is_nan()));
        assert!(sways[20..].iter().all(|sway| sway.abs() < 1e-12));
    }

    #[test]
    fn what_was_before_seconds_of_unease_is_no_recent_mean() {
        let after = |instants: usize| {
            let errors = [vec![0.01; 10], vec![f64::MAX; instants], vec![0.03; 10]].concat();
            let sways = sways(&errors, |k| !(10..10 + instants).contains(&k));
            sways[10 + instants]
        };
        assert!(after(8) > 0.003, "{}", after(8));
        assert_eq!(after(16), 0.0);
    }

    #[test]
    fn after_what_is_not_known_it_begins_anew() {
        let sways = sways(&[0.01, f64::NAN, 0.05], |_| true);
        assert!(sways[1].is_nan() && sways[2] == 0.0);
    }
}
