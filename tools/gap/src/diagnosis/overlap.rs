//! How much of what a second cause explains another law of the first could not have explained.
//!
//! No machine follows the simulator's law of an effect to the letter. On a signal that a first cause
//! explains, what it leaves is a share of what it explained, and a second cause that bends to that is
//! none.

use super::evidence::Left;

/// What another law of the first cause may explain of a signal, as a share of what the first does.
const BENDS_SHARE: f64 = 0.3;

/// Share of the second's gain that is its own. `first` and `second` are what each signal leaves before
/// and after the cause is believed, the second's beside the first.
#[must_use]
pub(super) fn own_share(first: [&[Left]; 2], second: [&[Left]; 2]) -> f64 {
    let gains = |[before, after]: [&[Left]; 2]| -> Vec<f64> {
        before.iter().zip(after).map(|(b, a)| (b.cost() - a.cost()).max(0.0)).collect()
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

    fn left(squares: [f64; 2]) -> Vec<Left> {
        let signals = [Signal::Stroke, Signal::Weight];
        let of = |(signal, square)| Left::evenly(Generator::Stance, signal, square, 50.0);
        signals.into_iter().zip(squares).map(of).collect()
    }

    #[test]
    fn a_second_on_another_signal_is_all_its_own() {
        let [none, first, both] = [left([90.0, 40.0]), left([1.0, 40.0]), left([1.0, 1.0])];
        assert!(own_share([&none, &first], [&first, &both]) > 0.999);
    }

    #[test]
    fn a_second_on_the_rest_of_the_first_is_not() {
        let [none, first, both] = [left([900.0, 1.0]), left([6.0, 1.0]), left([2.0, 1.0])];
        assert_eq!(own_share([&none, &first], [&first, &both]), 0.0);
    }

    #[test]
    fn a_second_that_explains_nothing_owns_nothing() {
        let none = left([1.0, 1.0]);
        assert_eq!(own_share([&none, &none], [&none, &none]), 0.0);
    }
}
