//! Physical dimensions of channels, and the factor from a wire unit to SI.

/// What kind of quantity a channel is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// m.
    Length,
    /// Pa.
    Pressure,
    /// N.
    Force,
    /// A.
    Current,
    /// rad.
    Angle,
    /// rad/s.
    AngularSpeed,
    /// 1; a percentage on the wire becomes a share of one.
    Ratio,
    /// A number without unit: a mode, a flag.
    Plain,
}

impl Dimension {
    /// What a value in `unit`, as a DBC spells it, is multiplied by to be in SI. `None` if the
    /// unit is not one of this dimension, or not one this bench knows.
    #[must_use]
    pub fn si_per(self, unit: &str) -> Option<f64> {
        use std::f64::consts::{PI, TAU};
        Some(match (self, unit.trim()) {
            (Self::Length, "m") | (Self::Pressure, "Pa") | (Self::Force, "N") => 1.0,
            (Self::Length, "cm") => 1e-2,
            (Self::Length, "mm") => 1e-3,
            (Self::Pressure, "kPa") => 1e3,
            (Self::Pressure, "bar") => 1e5,
            (Self::Pressure, "MPa") => 1e6,
            (Self::Force, "daN") => 10.0,
            (Self::Force, "kN") => 1e3,
            (Self::Current, "A") | (Self::Angle, "rad") | (Self::AngularSpeed, "rad/s") => 1.0,
            (Self::Current, "mA") => 1e-3,
            (Self::Angle, "deg" | "°") => PI / 180.0,
            (Self::AngularSpeed, "rpm" | "1/min") => TAU / 60.0,
            (Self::Ratio, "%") => 1e-2,
            (Self::Ratio | Self::Plain, "" | "1" | "-") => 1.0,
            _ => return None,
        })
    }

    /// Its SI unit.
    #[must_use]
    pub const fn si(self) -> &'static str {
        match self {
            Self::Length => "m",
            Self::Pressure => "Pa",
            Self::Force => "N",
            Self::Current => "A",
            Self::Angle => "rad",
            Self::AngularSpeed => "rad/s",
            Self::Ratio | Self::Plain => "",
        }
    }

    /// The units [`Dimension::si_per`] knows, for an error message.
    #[must_use]
    pub const fn units(self) -> &'static str {
        match self {
            Self::Length => "m, cm, mm",
            Self::Pressure => "Pa, kPa, bar, MPa",
            Self::Force => "N, daN, kN",
            Self::Current => "A, mA",
            Self::Angle => "rad, deg",
            Self::AngularSpeed => "rad/s, rpm",
            Self::Ratio => "%, none",
            Self::Plain => "none",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wire_units_become_si_and_others_are_refused() {
        let close = |a: Option<f64>, b: f64| (a.unwrap() - b).abs() < 1e-15;
        assert!(close(Dimension::Length.si_per("mm"), 0.001));
        assert!(close(Dimension::Force.si_per("daN"), 10.0));
        assert!(close(Dimension::AngularSpeed.si_per("rpm"), 0.104_719_755_119_659_77));
        assert!(close(Dimension::Ratio.si_per("%"), 0.01));
        assert_eq!(Dimension::Length.si_per("kPa"), None);
        assert_eq!(Dimension::Length.si_per("furlong"), None);
        assert_eq!(Dimension::Force.si_per(""), None);
    }

    #[test]
    fn every_unit_named_in_a_message_is_known() {
        use Dimension::{Angle, AngularSpeed, Current, Force, Length, Plain, Pressure, Ratio};
        for dimension in [Length, Pressure, Force, Current, Angle, AngularSpeed, Ratio, Plain] {
            for unit in dimension.units().split(", ") {
                let unit = if unit == "none" { "" } else { unit };
                assert!(dimension.si_per(unit).is_some(), "{dimension:?} {unit}");
            }
        }
    }
}
