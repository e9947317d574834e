//! Strokes, their rates and the chamber pressures (facts 3.2).

use xt28_machine::{PerWheel, Wheel};

use crate::ArmPins;
use crate::firmware_2016::Quirks;
use crate::firmware_2016::whole::{cut, input_mv, unsigned};

/// Share of the last pressure that a tick keeps: 1 Hz.
const PRESSURE_KEEP: f64 = 0.94088;
/// Stroke rate: v / 1.1 + gain / 1.1 * change, change in whole mm a tick; summed in this order, for
/// the cut is one count off in another.
const RATE_DIVISOR: f64 = 1.1;
/// Gain for a call every 20 ms, and the one that a call every 10 ms needs to read mm/s.
const RATE_GAIN_20_MS: f64 = 5.0;
const RATE_GAIN_10_MS: f64 = 10.0;

/// What the sensors say, whole numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Readings {
    pub(super) stroke_mm: PerWheel<i32>,
    /// About 2 mm/s each.
    pub(super) rate: PerWheel<i32>,
    pub(super) pressure_a_kpa: PerWheel<i32>,
    pub(super) pressure_b_kpa: PerWheel<i32>,
    pub(super) mean_stroke_mm: i32,
    pub(super) mean_rate: i32,
}

/// The filters' memory.
#[derive(Clone, Debug)]
pub(super) struct Sensing {
    quirks: Quirks,
    stroke_mm: Option<PerWheel<i32>>,
    rate: PerWheel<f64>,
    pressure_a: PerWheel<Option<f64>>,
    pressure_b: PerWheel<Option<f64>>,
}

impl Sensing {
    pub(super) fn new(quirks: Quirks) -> Self {
        let start = quirks.filters_start_at_zero.then_some(0.0);
        Self {
            quirks,
            stroke_mm: None,
            rate: PerWheel::splat(0.0),
            pressure_a: PerWheel::splat(start),
            pressure_b: PerWheel::splat(start),
        }
    }

    /// Readings of this tick.
    pub(super) fn step(&mut self, pins: &ArmPins) -> Readings {
        let quirks = self.quirks;
        let stroke_mm = pins.stroke_mv.map(|mv| {
            let mm = f64::from(input_mv(mv) - 500) / 4000.0 * 485.0;
            unsigned(cut(mm), quirks.negative_readings_wrap)
        });
        // The first tick has no change to speak of (assumed).
        let last_mm = self.stroke_mm.replace(stroke_mm).unwrap_or(stroke_mm);
        let gain = if quirks.stroke_rate_for_20_ms { RATE_GAIN_20_MS } else { RATE_GAIN_10_MS };
        self.rate = PerWheel::from_fn(|w| {
            let change_mm = f64::from(stroke_mm[w] - last_mm[w]);
            kept(self.rate[w] / RATE_DIVISOR + gain / RATE_DIVISOR * change_mm, quirks)
        });
        let rate = self.rate.map(cut);
        Readings {
            stroke_mm,
            rate,
            pressure_a_kpa: pressures(&mut self.pressure_a, &pins.pressure_a_mv, quirks),
            pressure_b_kpa: pressures(&mut self.pressure_b, &pins.pressure_b_mv, quirks),
            mean_stroke_mm: mean(&stroke_mm),
            mean_rate: mean(&rate),
        }
    }
}

fn pressures(
    last: &mut PerWheel<Option<f64>>,
    mv: &PerWheel<f64>,
    quirks: Quirks,
) -> PerWheel<i32> {
    PerWheel::from_fn(|w: Wheel| {
        let raw_kpa = cut(6.25 * f64::from(input_mv(mv[w])) - 3125.0);
        let raw_kpa = f64::from(unsigned(raw_kpa, quirks.negative_readings_wrap));
        let kpa = last[w].map_or(raw_kpa, |last_kpa| {
            kept(PRESSURE_KEEP * last_kpa + (1.0 - PRESSURE_KEEP) * raw_kpa, quirks)
        });
        last[w] = Some(kpa);
        cut(kpa)
    })
}

/// What a filter remembers of its value.
pub(super) fn kept(value: f64, quirks: Quirks) -> f64 {
    if quirks.filters_cut_off { value.trunc() } else { value }
}

/// Mean of the six, cut off.
fn mean(values: &PerWheel<i32>) -> i32 {
    values.0.iter().sum::<i32>() / 6
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pins(stroke_mv: f64, pressure_mv: f64) -> ArmPins {
        ArmPins {
            stroke_mv: PerWheel::splat(stroke_mv),
            pressure_a_mv: PerWheel::splat(pressure_mv),
            pressure_b_mv: PerWheel::splat(5000.0 - pressure_mv),
            supply_mv: 24_000.0,
        }
    }

    /// Facts 3.2: 0.12 mm for each mV, cut off; 4.8 V is 521 mm.
    #[test]
    fn strokes_are_cut_to_whole_millimetres() {
        for (mv, mm) in [(500.0, 0), (508.0, 0), (509.0, 1), (2500.0, 242), (4800.0, 521)] {
            let stroke_mm = Sensing::new(Quirks::firmware()).step(&pins(mv, 500.0)).stroke_mm;
            assert_eq!(stroke_mm, PerWheel::splat(mm), "{mv} mV");
        }
    }

    /// Facts 3.2: 50 mm/s read as 18 to 20, 100 as 40, 200 as 90, 300 as 140.
    #[test]
    fn rates_read_less_than_half() {
        for (mm_s, counts) in [(50, 18..=20), (100, 40..=40), (200, 90..=90), (300, 140..=140)] {
            let mut sensing = Sensing::new(Quirks::firmware());
            let rates = (0..150).map(|tick| {
                let mm = f64::from(tick * mm_s / 100) + 0.5;
                sensing.step(&pins((mm / 485.0 * 4000.0 + 500.0).round(), 500.0)).rate.0[0]
            });
            let last: Vec<i32> = rates.skip(148).collect();
            assert!(last.iter().all(|rate| counts.contains(rate)), "{mm_s} mm/s: {last:?}");
        }
    }

    /// Facts 3.2: a rise to 5000 kPa stalls at 4984, a fall comes down exactly.
    #[test]
    fn a_rising_pressure_stalls_and_a_falling_one_settles() {
        let mut sensing = Sensing::new(Quirks::firmware());
        let settle = |sensing: &mut Sensing, mv| {
            (0..600).map(|_| sensing.step(&pins(2500.0, mv))).last().expect("600 ticks")
        };
        assert_eq!(settle(&mut sensing, 1300.0).pressure_a_kpa, PerWheel::splat(4984));
        settle(&mut sensing, 3000.0);
        assert_eq!(settle(&mut sensing, 1300.0).pressure_a_kpa, PerWheel::splat(5000));
    }
}
