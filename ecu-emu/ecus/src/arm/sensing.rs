//! The arm ECU's sensors as the firmware stores them: whole numbers, truncated (facts 3.2, 3.3).

use xt28_machine::{Linkage, Machine, PerWheel, Wheel};

use super::ArmPins;
use crate::input_check::in_range;
use crate::pins::{self, Calibration};

/// Coefficient of the pressure filter: 1 Hz at 100 Hz (facts 3.2).
const PRESSURE_KEEP: f64 = 0.94088;
/// Stroke rate filter: v = trunc(v / 1.1 + 5 / 1.1 * change), change in whole mm a tick.
const RATE_DIVISOR: f64 = 1.1;
const RATE_GAIN: f64 = 5.0;
/// What a closed cylinder is shorter in the force code than in the height code, m (facts 1.4).
const FORCE_SHORTER_M: f64 = 0.03;
/// What a signed 16-bit signal can say.
const WORD_MAX: f64 = 32_767.0;
/// Keeps a value that should be whole from falling one short by the rounding of its sums.
const WHOLE_EPSILON: f64 = 1e-6;

/// What the sensors say, in the firmware's units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ArmReadings {
    pub(crate) stroke_mm: PerWheel<f64>,
    /// Stroke rate in the firmware's counts, about 2 mm/s each.
    pub(crate) stroke_rate: PerWheel<f64>,
    pub(crate) pressure_a_kpa: PerWheel<f64>,
    pub(crate) pressure_b_kpa: PerWheel<f64>,
    /// Load of each cylinder, daN; under weight > 0.
    pub(crate) load_dan: PerWheel<f64>,
    /// Vertical force of the ground on each wheel, daN.
    pub(crate) wheel_force_dan: PerWheel<f64>,
    pub(crate) mean_stroke_mm: f64,
    /// Mean of the six stroke rates, counts.
    pub(crate) mean_stroke_rate: f64,
}

/// Filters and estimates.
#[derive(Clone, Debug)]
pub(crate) struct ArmSensing {
    sensors: Calibration,
    linkage: Linkage,
    area_bore_m2: f64,
    area_rod_m2: f64,
    /// The filters start from the first tick's values: the machine stood before. (The firmware's
    /// start from zero, and need a second.)
    last: Option<ArmReadings>,
}

impl ArmSensing {
    pub(crate) fn new(machine: &Machine) -> Self {
        let closed_length_m = machine.arms.closed_length_m - FORCE_SHORTER_M;
        Self {
            sensors: Calibration::of(machine),
            linkage: machine.linkage().with_closed_length(closed_length_m),
            area_bore_m2: machine.arms.area_bore_m2,
            area_rod_m2: machine.arms.area_rod_m2,
            last: None,
        }
    }

    /// Readings of this tick.
    pub(crate) fn step(&mut self, pins: &ArmPins) -> ArmReadings {
        let stroke_mm = pins.stroke_mv.map(|mv| whole(self.sensors.stroke_m(mv) * 1e3));
        let raw_a_kpa = pins.pressure_a_mv.map(|mv| whole(pins::pressure_pa(mv) * 1e-3));
        let raw_b_kpa = pins.pressure_b_mv.map(|mv| whole(pins::pressure_pa(mv) * 1e-3));
        let last = self.last.unwrap_or(ArmReadings {
            stroke_mm,
            pressure_a_kpa: raw_a_kpa,
            pressure_b_kpa: raw_b_kpa,
            ..ArmReadings::default()
        });
        let stroke_rate = PerWheel::from_fn(|w| {
            let change_mm = stroke_mm[w] - last.stroke_mm[w];
            whole((last.stroke_rate[w] + RATE_GAIN * change_mm) / RATE_DIVISOR)
        });
        // A false pressure would outlast its cause by half a second in a filter of 1 Hz.
        let taken = |last_kpa, raw_kpa, mv| {
            if in_range(mv) { filtered(last_kpa, raw_kpa) } else { last_kpa }
        };
        let pressure_a_kpa = PerWheel::from_fn(|w| {
            taken(last.pressure_a_kpa[w], raw_a_kpa[w], pins.pressure_a_mv[w])
        });
        let pressure_b_kpa = PerWheel::from_fn(|w| {
            taken(last.pressure_b_kpa[w], raw_b_kpa[w], pins.pressure_b_mv[w])
        });
        let load_dan = PerWheel::from_fn(|w| self.load_dan(pressure_a_kpa[w], pressure_b_kpa[w]));
        let readings = ArmReadings {
            stroke_mm,
            stroke_rate,
            pressure_a_kpa,
            pressure_b_kpa,
            load_dan,
            wheel_force_dan: PerWheel::from_fn(|w: Wheel| {
                let pose = self.linkage.at_stroke(stroke_mm[w] * 1e-3);
                word((pose.force_ratio * load_dan[w]).trunc())
            }),
            mean_stroke_mm: whole(stroke_mm.mean()),
            mean_stroke_rate: whole(stroke_rate.mean()),
        };
        self.last = Some(readings);
        readings
    }

    /// Load of a cylinder from its chambers: each side's force truncated, then their difference.
    fn load_dan(&self, pressure_a_kpa: f64, pressure_b_kpa: f64) -> f64 {
        // Plainly cut off, without the epsilon of `whole`: so a recorded machine does it.
        let force_a_dan = (100.0 * pressure_a_kpa * self.area_bore_m2).trunc();
        let force_b_dan = (100.0 * pressure_b_kpa * self.area_rod_m2).trunc();
        word(force_a_dan - force_b_dan)
    }
}

fn filtered(last_kpa: f64, raw_kpa: f64) -> f64 {
    whole(PRESSURE_KEEP * last_kpa + (1.0 - PRESSURE_KEEP) * raw_kpa)
}

/// Truncated towards zero, as the firmware's storage does.
fn whole(value: f64) -> f64 {
    (value + WHOLE_EPSILON.copysign(value)).trunc()
}

const fn word(value: f64) -> f64 {
    value.clamp(-WORD_MAX, WORD_MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pins_at(stroke_m: f64, pressure_a_pa: f64, pressure_b_pa: f64) -> ArmPins {
        ArmPins {
            stroke_mv: PerWheel::splat(pins::stroke_mv(stroke_m)),
            pressure_a_mv: PerWheel::splat(pins::pressure_mv(pressure_a_pa)),
            pressure_b_mv: PerWheel::splat(pins::pressure_mv(pressure_b_pa)),
            supply_mv: 24_000.0,
        }
    }

    fn sensing() -> ArmSensing {
        ArmSensing::new(&Machine::xt28())
    }

    #[test]
    fn strokes_are_whole_millimetres_cut_off() {
        for (stroke_m, stroke_mm) in [(0.25, 250.0), (0.1709, 170.0), (0.0, 0.0), (-0.02, 0.0)] {
            let readings = sensing().step(&pins_at(stroke_m, 0.0, 0.0));
            assert_eq!(readings.stroke_mm, PerWheel::splat(stroke_mm));
            assert_eq!(readings.mean_stroke_mm, stroke_mm);
        }
    }

    /// Facts 3.2: the filter settles 16 kPa short of a rising 5000 kPa, on a falling one exactly.
    #[test]
    fn the_pressure_filter_stalls_below_a_rise() {
        let mut sensing = sensing();
        sensing.step(&pins_at(0.25, 0.0, 9e6));
        let settle =
            |s: &mut ArmSensing| (0..500).map(|_| s.step(&pins_at(0.25, 5e6, 5e6))).last().unwrap();
        let readings = settle(&mut sensing);
        assert_eq!(readings.pressure_a_kpa[Wheel::Fr], 4984.0);
        assert_eq!(readings.pressure_b_kpa[Wheel::Fr], 5000.0);
    }

    /// Facts 3.2: 100 mm/s read as 40, 200 as 90; 300 mm/s as 140.
    #[test]
    fn the_stroke_rate_reads_less_than_half() {
        for (mm_per_tick, counts) in [(1.0, 40.0), (2.0, 90.0), (3.0, 140.0)] {
            let mut sensing = sensing();
            let mut rate = 0.0;
            for tick in 0..150 {
                let stroke_m = f64::from(tick) * mm_per_tick * 1e-3;
                rate = sensing.step(&pins_at(stroke_m, 0.0, 0.0)).stroke_rate[Wheel::Bl];
            }
            assert_eq!(rate, counts);
        }
    }

    /// 7201 kPa on 78.5 cm2 less 500 kPa on 58.9 cm2, and the ratio of facts 1.4 for 0.82 m.
    #[test]
    fn loads_and_wheel_forces_follow_the_force_code() {
        let readings = sensing().step(&pins_at(0.25, 7.201e6, 0.5e6));
        assert_eq!(readings.load_dan[Wheel::Mr], 5652.0 - 294.0);
        let force_dan = readings.wheel_force_dan[Wheel::Mr];
        assert!((force_dan - 0.4991 * 5358.0).abs() < 1.0, "{force_dan}");
    }

    /// Another machine's cylinders are read over their own stroke, and weighed by their own linkage.
    #[test]
    fn another_machines_cylinders_are_its_own() {
        let mut machine = Machine::xt28();
        (machine.arms.stroke_max_m, machine.arms.closed_length_m) = (0.7, 0.9);
        let sensors = Calibration::of(&machine);
        let pins = ArmPins {
            stroke_mv: PerWheel::splat(sensors.stroke_mv(0.65)),
            ..pins_at(0.0, 7.201e6, 0.5e6)
        };
        let readings = ArmSensing::new(&machine).step(&pins);
        assert_eq!(readings.stroke_mm, PerWheel::splat(650.0));
        let ratio = machine.linkage().with_closed_length(0.87).at_stroke(0.65).force_ratio;
        let force_dan = readings.wheel_force_dan[Wheel::Mr];
        assert!((force_dan - ratio * 5358.0).abs() < 1.0, "{force_dan}");
    }
}
