//! Analogue inputs as the firmware stores them: whole numbers, cut off.

/// Share of its own value that the pressure filter keeps in a tick: 1 Hz.
const PRESSURE_KEEP: f64 = 0.94088;
/// What should be whole must not fall one short by rounding.
const WHOLE: f64 = 1e-9;

/// Whole millimetres of a position sensor, not below zero.
pub(super) fn millimetres(stroke_m: f64) -> f64 {
    (stroke_m * 1e3 + WHOLE).trunc().max(0.0)
}

/// The pressure filter of one chamber, whole kPa.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PressureFilter {
    kpa: Option<f64>,
}

impl PressureFilter {
    /// One tick with `pressure_pa` at the sensor.
    pub(super) fn step(&mut self, pressure_pa: f64) -> f64 {
        let raw = (pressure_pa * 1e-3 + WHOLE).trunc().clamp(0.0, 25_000.0);
        let kpa = match self.kpa {
            None => raw,
            Some(kpa) => (PRESSURE_KEEP * kpa + (1.0 - PRESSURE_KEEP) * raw + WHOLE).trunc(),
        };
        self.kpa = Some(kpa);
        kpa
    }
}

/// Current of a solenoid for a share of full opening, whole mA: `start` at once, `span` for the rest.
pub(super) fn solenoid_ma(share: f64, start: f64, span: f64) -> f64 {
    let above = (span * share.clamp(0.0, 1.0)).round();
    if above == 0.0 { 0.0 } else { start + above }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn falling_pressure_arrives_and_rising_pressure_stalls_short() {
        let mut filter = PressureFilter::default();
        filter.step(6.0e6);
        assert_eq!((0..1000).map(|_| filter.step(5.0e6)).last(), Some(5000.0));
        filter = PressureFilter::default();
        filter.step(4.0e6);
        assert_eq!((0..1000).map(|_| filter.step(5.0e6)).last(), Some(4984.0));
    }

    #[test]
    fn one_second_after_a_step_it_has_gone_almost_all_the_way() {
        let mut filter = PressureFilter::default();
        filter.step(0.0);
        let after = (0..16).map(|_| filter.step(1.0e7)).last().unwrap();
        assert!((after / 1e4 - 0.62).abs() < 0.02, "{after}");
    }

    #[test]
    fn currents_start_at_their_dead_band() {
        assert_eq!(solenoid_ma(0.0, 400.0, 400.0), 0.0);
        assert_eq!(solenoid_ma(0.001, 400.0, 400.0), 0.0);
        assert_eq!(solenoid_ma(0.0025, 400.0, 400.0), 401.0);
        assert_eq!(solenoid_ma(0.3, 400.0, 400.0), 520.0);
        assert_eq!(millimetres(0.1999), 199.0);
        assert_eq!(millimetres(0.2), 200.0);
    }
}
