//! Whether the logs can tell that a cause was not there before it is said to set in.

use crate::diagnosis::generator::{Generator, Residual};
use crate::diagnosis::hypothesis::Hypothesis;
use crate::diagnosis::inquiry::Inquiry;
use crate::diagnosis::onset::Onset;
use crate::diagnosis::signals::Signals;
use crate::diagnosis::verdict::Cause;

/// What a cause must change of some residual before it sets in, in floors: less is no word of the logs.
const SHOWS: f64 = 1.0;
/// Samples of a residual a second.
const RATE_HZ: f64 = 10.0;

/// Whether `cause`, had it been there from the start, would have shown before it sets in at `onset`. A play shows
/// nothing before the first bend: it may always have been there.
pub(super) fn is_told(inquiry: &Inquiry, cause: &Cause, onset: Onset) -> bool {
    let hypothesis = Hypothesis { effect: cause.effect, scope: cause.scope };
    let values: Vec<f64> = cause.parameters.iter().map(|estimate| estimate.value[0]).collect();
    let always = hypothesis.applied(&inquiry.believed, &values);
    let shows = |generator: Generator, s: &Signals| {
        let [without, with] = [&inquiry.believed, &always]
            .map(|effects| generator.residuals(s, &inquiry.machine, effects));
        without.iter().zip(&with).any(|pair| part_before(onset.in_run(s.began_s), pair))
    };
    let mut heard = Generator::all().into_iter().filter(|g| g.hears(cause.effect, cause.scope));
    heard.any(|generator| {
        let mut fitted = inquiry.runs.iter().filter(|run| run.fit);
        fitted.any(|run| shows(generator, &run.signals))
    })
}

fn part_before(at_s: f64, (without, with): (&Residual, &Residual)) -> bool {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let before = (at_s * RATE_HZ) as usize;
    let mut pairs = without.values.iter().zip(&with.values).take(before);
    pairs.any(|(a, b)| (a - b).abs() > SHOWS)
}
