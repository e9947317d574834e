//! What a satellite receiver tells: fixes and headings, each at its own instants.
//!
//! They come in two frames, and either may be lost alone.

use std::f64::consts::TAU;

use super::{AllSeries, Signals};
use crate::{Channel, Series, Terrain};

/// Time between two headings beyond which nothing is said in between, s: a machine that steers has turned
/// by some degrees meanwhile (a receiver tells eight a second).
const HEADING_GAP_S: f64 = 1.0;

impl Signals {
    /// Heading and its rate at `at_s`, rad and rad/s; none without a receiver that says them, before its
    /// first word, after its last, and where it was silent for long.
    #[must_use]
    pub fn heading_at(&self, at_s: f64) -> Option<[f64; 2]> {
        between(&self.headings, at_s)
    }

    /// Whether the ground is known to slope while nobody says which way the machine heads on it.
    #[must_use]
    pub(in crate::diagnosis) fn heads_unknown_on_slope(&self) -> bool {
        let slopes = matches!(&self.terrain, Terrain::Plane(plane) if plane.rise != [0.0; 2]);
        slopes && self.headings.is_empty()
    }

    /// Heading at `at_s` or, where none is known, the one told nearest to it, rad; none without any.
    #[must_use]
    pub fn heading_near(&self, at_s: f64) -> Option<f64> {
        if let Some([heading, _]) = self.heading_at(at_s) {
            return Some(heading);
        }
        let away = |heading: &&[f64; 3]| (heading[0] - at_s).abs();
        let nearest = self.headings.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
        nearest.map(|heading| heading[1])
    }
}

/// Between the two of `headings` around `at_s`: heading and rate.
fn between(headings: &[[f64; 3]], at_s: f64) -> Option<[f64; 2]> {
    let k = headings.partition_point(|heading| heading[0] < at_s);
    let [from_s, before, _] = *headings.get(k.checked_sub(1)?)?;
    let [to_s, after, rate] = *headings.get(k)?;
    let share = (at_s - from_s) / (to_s - from_s);
    (to_s - from_s <= HEADING_GAP_S).then_some([before + share * (after - before), rate])
}

/// Fixes, east and north, with their instants: s, m, m.
pub(super) fn fixes(all: &AllSeries) -> Vec<[f64; 3]> {
    let (Some(east), Some(north)) = (all.get(&Channel::East), all.get(&Channel::North)) else {
        return Vec::new();
    };
    east.iter().filter_map(|(at_s, x)| Some([at_s, x, north.at(at_s)?])).collect()
}

/// A heading's series without its jumps by a full turn.
pub(in crate::diagnosis) fn unwound(series: &Series) -> Series {
    let (mut turned, mut last) = (0.0, None);
    let unwind = |(at_s, heading): (f64, f64)| {
        let step = heading - last.replace(heading).unwrap_or(0.0);
        turned += step - TAU * (step / TAU).round();
        (at_s, turned)
    };
    series.iter().map(unwind).collect()
}

/// Headings unwound, with their instants and their slope over a second: s, rad, rad/s.
pub(super) fn headings(all: &AllSeries) -> Vec<[f64; 3]> {
    const SPAN: usize = 4;
    let Some(series) = all.get(&Channel::Heading) else { return Vec::new() };
    let unwound: Vec<[f64; 2]> =
        unwound(series).iter().map(|(at_s, heading)| [at_s, heading]).collect();
    let end = unwound.len().saturating_sub(1);
    (0..unwound.len())
        .map(|k| {
            let (a, b) = (unwound[k.saturating_sub(SPAN)], unwound[(k + SPAN).min(end)]);
            let rate = if b[0] > a[0] { (b[1] - a[1]) / (b[0] - a[0]) } else { 0.0 };
            [unwound[k][0], unwound[k][1], rate]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A machine that turns by a tenth of a radian a second past north, without what `lost` names.
    fn turning(lost: impl Fn(f64) -> bool) -> Vec<[f64; 3]> {
        let mut series = Series::default();
        let instants = (0..160).map(|k| 0.125 * f64::from(k)).filter(|at_s| !lost(*at_s));
        instants.for_each(|at_s| {
            series.push(at_s, (6.0 + 0.1 * at_s) % TAU);
        });
        headings(&AllSeries::from([(Channel::Heading, series)]))
    }

    #[test]
    fn a_heading_is_told_at_its_own_instant_whatever_was_lost_before() {
        for lost in [0.0..0.0, 1.0..1.4, 1.0..3.0] {
            let told = turning(|at_s| lost.contains(&at_s));
            let [heading, rate] = between(&told, 11.3).unwrap();
            assert!((heading - (6.0 - TAU + 1.13)).abs() < 1e-9, "{lost:?}: {heading}");
            assert!((rate - 0.1).abs() < 1e-9, "{lost:?}: {rate}");
        }
    }

    #[test]
    fn nothing_is_told_where_the_receiver_was_silent_for_long() {
        let told = turning(|at_s| (1.0..3.0).contains(&at_s));
        assert!(between(&told, 2.0).is_none() && between(&told, 0.9).is_none());
        assert!(between(&told, 0.8).is_some() && between(&told, 3.2).is_some());
        assert!(between(&told, -1.0).is_none() && between(&told, 30.0).is_none());
    }
}
