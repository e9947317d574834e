//! What an expectation found: measured, wanted, tolerance, and whether that passes.

use std::fmt;

/// One measured number against what was wanted of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// What was expected, in words.
    pub what: String,
    /// The number measured; `None` when the log does not carry it.
    pub measured: Option<f64>,
    /// What it must be.
    pub wanted: Bound,
    /// Unit of both.
    pub unit: &'static str,
    /// What else a reader needs, such as why nothing was measured; may be empty.
    pub note: String,
}

/// What a measured number must be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// Within `tolerance` of `value`.
    Near {
        /// The value wanted.
        value: f64,
        /// How far off it may be.
        tolerance: f64,
    },
    /// No more than this.
    AtMost(f64),
    /// From the first to the second.
    Between(f64, f64),
}

impl Bound {
    /// True if `measured` satisfies it. Not a number never does.
    #[must_use]
    pub fn admits(&self, measured: f64) -> bool {
        match *self {
            Self::Near { value, tolerance } => (measured - value).abs() <= tolerance,
            Self::AtMost(limit) => measured <= limit,
            Self::Between(low, high) => (low..=high).contains(&measured),
        }
    }
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Near { value, tolerance } => {
                write!(f, "{} ± {}", significant(value), significant(tolerance))
            }
            Self::AtMost(limit) => write!(f, "≤ {}", significant(limit)),
            Self::Between(low, high) => {
                write!(f, "{} to {}", significant(low), significant(high))
            }
        }
    }
}

impl Finding {
    /// A finding of `measured`.
    pub(crate) fn of(
        what: impl Into<String>,
        measured: f64,
        wanted: Bound,
        unit: &'static str,
    ) -> Self {
        Self { what: what.into(), measured: Some(measured), wanted, unit, note: String::new() }
    }

    /// A finding of nothing, because of `note`.
    pub(crate) fn missing(
        what: impl Into<String>,
        wanted: Bound,
        unit: &'static str,
        note: impl Into<String>,
    ) -> Self {
        Self { what: what.into(), measured: None, wanted, unit, note: note.into() }
    }

    /// The same with a remark.
    pub(crate) fn noting(self, note: impl Into<String>) -> Self {
        Self { note: note.into(), ..self }
    }

    /// True if something was measured and it is what was wanted.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.measured.is_some_and(|measured| self.wanted.admits(measured))
    }
}

/// `value` with four significant digits and no trailing zeros.
pub(crate) fn significant(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value:.0}");
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped just before
    let decimals = (3.0 - value.abs().log10().floor()).clamp(0.0, 9.0) as usize;
    let text = format!("{value:.decimals$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_admit_their_edges_and_never_nan() {
        let near = Bound::Near { value: 2.0, tolerance: 0.5 };
        assert!(near.admits(2.5) && near.admits(1.5) && !near.admits(2.51));
        assert!(Bound::AtMost(3.0).admits(3.0) && !Bound::AtMost(3.0).admits(3.01));
        assert!(Bound::Between(-1.0, 1.0).admits(-1.0) && !Bound::Between(-1.0, 1.0).admits(1.1));
        for bound in [near, Bound::AtMost(3.0), Bound::Between(-1.0, 1.0)] {
            assert!(!bound.admits(f64::NAN));
        }
    }

    #[test]
    fn nothing_measured_is_no_pass() {
        let finding = Finding::missing("x", Bound::AtMost(f64::INFINITY), "m", "no frame");
        assert!(!finding.passed());
    }

    #[test]
    fn numbers_read_well() {
        let texts = [0.063_61, 166_770.0, 9.0, 0.0, -0.3, 12.345].map(significant);
        assert_eq!(texts, ["0.06361", "166770", "9", "0", "-0.3", "12.35"]);
    }
}
