//! Which gaps are listed: those that say something, the one that the headline names, and the rest in one line.

use super::named::signal;
use super::words::{percent, short};
use crate::diagnosis::{Diagnosis, Place};

/// Places listed.
const MOST: usize = 8;
/// Below so many floors a gap is of no more interest than what any model errs by.
const LEAST: f64 = 0.5;

/// The places that are listed, in their order, and the others.
pub(super) struct Rows<'a> {
    pub(super) shown: Vec<&'a Place>,
    rest: Vec<&'a Place>,
}

impl<'a> Rows<'a> {
    pub(super) fn of(diagnosis: &'a Diagnosis) -> Self {
        let named = signal(diagnosis);
        let (mut shown, mut rest) = (Vec::new(), Vec::new());
        for place in &diagnosis.places {
            let is_large = place.gap_over_noise >= LEAST && shown.len() < MOST;
            let is_named = named.is_some_and(|spot| place.spot == *spot);
            if is_large || is_named { shown.push(place) } else { rest.push(place) }
        }
        Self { shown, rest }
    }

    /// What the others are, how large the largest of their gaps is, and the share of all; `None` without any.
    pub(super) fn rest(&self) -> Option<[String; 3]> {
        let gap = self.rest.iter().map(|place| place.gap_over_noise).fold(0.0, f64::max);
        let share: f64 = self.rest.iter().map(|place| place.share).sum();
        let count = match self.rest.len() {
            0 => return None,
            1 => "all else: 1 signal".to_owned(),
            count => format!("all else: {count} signals"),
        };
        Some([count, format!("up to {}", short(gap)), percent(share)])
    }
}
