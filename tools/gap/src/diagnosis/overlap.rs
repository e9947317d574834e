//! How much of what a second cause explains another law of the first could not have explained.
//!
//! No machine follows the simulator's law of an effect to the letter. On a signal that a first cause
//! explains, what it leaves is a share of what it explained, and a second cause that bends to that is
//! none. So with tolerances: one that goes far because of the first goes a little way for its law, and
//! one that goes far beside the first alone is a signal that the second could explain.

use super::evidence::Left;
use super::knob::Knob;

/// What another law of the first cause may explain of a signal, as a share of what the first does.
const BENDS_SHARE: f64 = 0.3;

/// What it costs to believe something: what each signal leaves, and where the tolerances go with it, each
/// by how many of its own.
pub(super) struct Paid {
    pub(super) left: Vec<Left>,
    pub(super) shifts: Vec<(Knob, f64)>,
}

impl Paid {
    /// What each signal and each tolerance costs, nats.
    fn costs(&self) -> impl Iterator<Item = f64> {
        let of_shifts = self.shifts.iter().map(|(_, by)| 0.5 * by * by);
        self.left.iter().map(Left::cost).chain(of_shifts)
    }
}

/// Share of the second's gain that is its own. `first` and `second` are what is paid before and after
/// the cause is believed, the second's beside the first.
#[must_use]
pub(super) fn own_share(first: [&Paid; 2], second: [&Paid; 2]) -> f64 {
    let gains = |[before, after]: [&Paid; 2]| -> Vec<f64> {
        before.costs().zip(after.costs()).map(|(b, a)| (b - a).max(0.0)).collect()
    };
    let (first, second) = (gains(first), gains(second));
    let all: f64 = second.iter().sum();
    if all <= 0.0 {
        return 0.0;
    }
    let own = |(second, first): (&f64, &f64)| (second - BENDS_SHARE * first).max(0.0);
    second.iter().zip(&first).map(own).sum::<f64>() / all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis::floor::Signal;
    use crate::diagnosis::generator::Generator;

    /// Two signals and a tolerance.
    fn paid(squares: [f64; 2], shift: f64) -> Paid {
        let signals = [Signal::Stroke, Signal::Weight];
        let of = |(signal, square)| Left::evenly(Generator::Stance, signal, square, 50.0);
        let knob = Knob::all()[0];
        Paid {
            left: signals.into_iter().zip(squares).map(of).collect(),
            shifts: vec![(knob, shift)],
        }
    }

    #[test]
    fn a_second_on_another_signal_is_all_its_own() {
        let all = [paid([90.0, 40.0], 0.0), paid([1.0, 40.0], 0.0), paid([1.0, 1.0], 0.0)];
        let [none, first, both] = all.each_ref();
        assert!(own_share([none, first], [first, both]) > 0.999);
    }

    #[test]
    fn a_second_on_the_rest_of_the_first_is_not() {
        let all = [paid([900.0, 1.0], 0.0), paid([6.0, 1.0], 0.0), paid([2.0, 1.0], 0.0)];
        let [none, first, both] = all.each_ref();
        assert_eq!(own_share([none, first], [first, both]), 0.0);
    }

    #[test]
    fn a_second_that_a_tolerance_stood_in_for_is_its_own() {
        let all = [paid([90.0, 1.0], 4.0), paid([1.0, 1.0], 4.0), paid([1.0, 1.0], 0.0)];
        let [none, first, both] = all.each_ref();
        assert!(own_share([none, first], [first, both]) > 0.999);
        // One that the first had moved twice as far was moved by the first's law.
        let none = paid([90.0, 1.0], 9.0);
        assert_eq!(own_share([&none, first], [first, both]), 0.0);
    }

    #[test]
    fn a_second_that_explains_nothing_owns_nothing() {
        let none = paid([1.0, 1.0], 0.0);
        assert_eq!(own_share([&none, &none], [&none, &none]), 0.0);
    }
}
