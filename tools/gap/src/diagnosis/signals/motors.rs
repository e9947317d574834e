//! How the displacements of the wheel motors part, by their currents: an ECU takes some off a wheel that spins.

use xt28_ecus::pins;
use xt28_machine::{PerWheel, Wheel};

use super::{Samples, Signals};

/// Displacement of each motor as a share of the largest of the six, from their currents in A; empty where those
/// of a motor are not there. What all have in common goes with the throttle, whose law is known.
pub(super) fn shares(current_a: &PerWheel<Samples>) -> PerWheel<Samples> {
    let len = current_a.iter().map(|(_, samples)| samples.len()).min().unwrap_or(0);
    let mut shares = PerWheel::from_fn(|_| Samples::with_capacity(len));
    for i in 0..len {
        let own = PerWheel::from_fn(|w| pins::motor_displacement(current_a[w][i] * 1e3));
        let largest = own.iter().map(|(_, displacement)| *displacement).fold(0.0, f64::max);
        for w in Wheel::ALL {
            shares[w].push(if largest > 0.0 { own[w] / largest } else { 1.0 });
        }
    }
    shares
}

impl Signals {
    /// Shares of the motors' displacements at sample `i`, all one where nothing is known of them.
    pub(in crate::diagnosis) fn motor_shares(&self, i: usize) -> PerWheel<f64> {
        PerWheel::from_fn(|w| self.motor_share[w].get(i).copied().unwrap_or(1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motor_that_gives_way_has_less_than_the_others_at_any_throttle() {
        for displacement in [1.0, 0.5, 1.0 / 3.0] {
            let ma = |w: Wheel| {
                let share = if w == Wheel::Br { 0.4 } else { 1.0 };
                pins::motor_ma(share * displacement)
            };
            let shares = shares(&PerWheel::from_fn(|w| vec![ma(w) * 1e-3; 3]));
            assert!((shares[Wheel::Br][2] - 0.4).abs() < 1e-3, "{:?}", shares[Wheel::Br]);
            assert!((shares[Wheel::Fl][2] - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn nothing_is_known_of_motors_one_of_which_is_not_logged() {
        let mut current_a = PerWheel::from_fn(|_| vec![0.4; 3]);
        current_a[Wheel::Ml].clear();
        assert!(shares(&current_a).iter().all(|(_, samples)| samples.is_empty()));
    }
}
