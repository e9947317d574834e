//! What stands below the gaps: how they were told, what their shares are of, what a small one means, and
//! which causes do not shrink them.

use super::svg::escape;
use crate::diagnosis::{Diagnosis, SHIFT_MAX, ShareOf, Verdict};

/// Gaps below this, in floors, may look like nothing beside a cause that is stood by.
const SMALL: f64 = 1.5;

/// How the verdict's gaps were told, after "Gap over noise".
pub(super) fn gap_over_noise(diagnosis: &Diagnosis) -> String {
    let held = match diagnosis.verdict {
        Verdict::Unknown => {
            "each tolerance where it fits best while no cause is believed, but held to one of its own"
                .to_owned()
        }
        Verdict::Effect | Verdict::None => format!(
            "each tolerance where it fits best beside the cause or pair that fits best, but held to \
             {SHIFT_MAX} of its own"
        ),
    };
    format!(
        "root mean square on the runs that were fitted, of the worst wheel where there are several, in \
         noise floors; {held}"
    )
}

/// What the shares of places are of.
pub(super) const fn share_of(of: ShareOf) -> &'static str {
    match of {
        ShareOf::Squares => {
            "share: of the squares of all gaps on measured inputs, as far as they go beyond noise"
        }
        ShareOf::Machine => {
            "share: of the whole machine's gap 5 s ahead; each block's by Shapley's value, dealt out among its signals by their gaps"
        }
    }
}

/// How to read those shares, where that is not plain.
pub(super) fn how_to_read_shares(of: ShareOf) -> Option<&'static str> {
    (of == ShareOf::Machine).then_some(
        "A block's share is how much smaller the gap is with that block's measured output in its place; the rest is \
         the share of masses, tyres, sensors and bus together. Below a floor a share says little.",
    )
}

/// Why a cause may be certain though no gap is large; `None` where one is, or no cause is stood by.
pub(super) fn small_gaps(diagnosis: &Diagnosis) -> Option<&'static str> {
    let largest = diagnosis.places.iter().map(|place| place.gap_over_noise).fold(0.0, f64::max);
    let is_named = diagnosis.stood_by().next().is_some();
    (is_named && !diagnosis.places.is_empty() && largest < SMALL).then_some(
        "No gap here is large, and the cause may be certain all the same: a gap is the size of a whole signal's \
         error, 1 where it is as large as what two models of one sound machine differ by; a cause is told by the \
         pattern over time of many samples, which can be plain where the error is small.",
    )
}

/// The causes stood by that shrink no gap, a paragraph each.
pub(super) fn unshrunk(diagnosis: &Diagnosis) -> String {
    let paragraph = |said: String| format!("<p>{}</p>", escape(&said));
    diagnosis.unshrunk().into_iter().map(paragraph).collect()
}
