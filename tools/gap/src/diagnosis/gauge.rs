//! What the sensors of a cylinder make of its load and its stroke.

use xt28_machine::{Machine, Wheel};
use xt28_sim::effects::WheelEffects;

use super::blend::Blend;
use super::signals::Signals;

/// The sensors of one cylinder, as believed.
///
/// A load is what the bore chamber's pressure makes less what the rod chamber's does, so a sensor that reads
/// too much is told from another load only beside what the rod chamber reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Gauge {
    bias_n: f64,
    bore: f64,
    /// What the rod chamber's reading counts for beside the bore's error.
    by_rod: f64,
}

impl Gauge {
    /// The sensors of a cylinder whose bore has `area_bore_m2`.
    pub(super) fn new(area_bore_m2: f64, sensors: &WheelEffects) -> Self {
        let scale = &sensors.pressure_scale;
        Self {
            bias_n: sensors.pressure_bias.bias_pa * area_bore_m2,
            bore: scale.factor,
            by_rod: 1.0 / scale.factor - 1.0 / scale.rod_factor(),
        }
    }

    /// Load that shows as `reading_n` while the rod chamber shows `rod_n` against it, N.
    pub(super) fn load_n(&self, reading_n: f64, rod_n: f64) -> f64 {
        (reading_n - self.bias_n) / self.bore + rod_n * self.by_rod
    }

    /// What a load of `load_n` shows as while the rod chamber shows `rod_n` against it, N.
    pub(super) fn reading_n(&self, load_n: f64, rod_n: f64) -> f64 {
        self.bore * (load_n - rod_n * self.by_rod) + self.bias_n
    }
}

/// All sensors of one cylinder, as believed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sensing {
    /// Those of its pressures.
    pub(super) gauge: Gauge,
    stroke_bias_m: f64,
    /// How far the reading of the stroke goes for the stroke.
    pub(super) stroke_scale: f64,
}

impl Sensing {
    /// The sensors of a cylinder whose bore has `area_bore_m2`.
    pub(super) fn new(area_bore_m2: f64, sensors: &WheelEffects) -> Self {
        Self {
            gauge: Gauge::new(area_bore_m2, sensors),
            stroke_bias_m: sensors.stroke_bias.bias_m,
            stroke_scale: sensors.stroke_scale.factor,
        }
    }

    /// Stroke that shows as `reading_m`, m.
    pub(super) fn stroke_m(&self, reading_m: f64) -> f64 {
        (reading_m - self.stroke_bias_m) / self.stroke_scale
    }
}

impl Blend for Gauge {
    fn toward(self, other: &Self, share: f64) -> Self {
        Self {
            bias_n: self.bias_n.toward(&other.bias_n, share),
            bore: self.bore.toward(&other.bore, share),
            by_rod: self.by_rod.toward(&other.by_rod, share),
        }
    }
}

impl Blend for Sensing {
    fn toward(self, other: &Self, share: f64) -> Self {
        Self {
            gauge: self.gauge.toward(&other.gauge, share),
            stroke_bias_m: self.stroke_bias_m.toward(&other.stroke_bias_m, share),
            stroke_scale: self.stroke_scale.toward(&other.stroke_scale, share),
        }
    }
}

/// Force against the rod that the sensor of its chamber shows at sample `i`, N; the return line's where no
/// such reading is logged.
pub(super) fn rod_n(signals: &Signals, machine: &Machine, wheel: Wheel, i: usize) -> f64 {
    let [_, rod_pa] = &signals.chamber_pa[wheel];
    let pa = rod_pa.get(i).copied().unwrap_or(machine.hydraulics.return_pressure_pa);
    pa * machine.arms.area_rod_m2
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use xt28_sim::{Effects, Sensors, VehicleState};

    use super::*;

    proptest! {
        /// The load of a cylinder comes back from what the plant's own sensors make of its chambers.
        #[test]
        fn the_load_comes_back_from_the_sensors(
            factor in 0.5..1.5_f64,
            rod_share in 0.0..1.0_f64,
            bias_pa in -1e6..1e6_f64,
            [bore_pa, rod_pa] in [0.0..2e7_f64, 0.0..2e7_f64],
        ) {
            let machine = Machine::xt28();
            let mut effects = Effects::default();
            let sensors: &mut WheelEffects = &mut effects.wheels[Wheel::Ml];
            sensors.pressure_bias.bias_pa = bias_pa;
            (sensors.pressure_scale.factor, sensors.pressure_scale.rod_share) = (factor, rod_share);
            let mut state = VehicleState::default();
            (state.pressure_a_pa[Wheel::Ml], state.pressure_b_pa[Wheel::Ml]) = (bore_pa, rod_pa);
            let read = Sensors::new(&effects).read(&state);
            let [a, b] = [machine.arms.area_bore_m2, machine.arms.area_rod_m2];
            let rod_n = b * read.pressure_b_pa[Wheel::Ml];
            let reading_n = a * read.pressure_a_pa[Wheel::Ml] - rod_n;
            let gauge = Gauge::new(a, &effects.wheels[Wheel::Ml]);
            let load_n = gauge.load_n(reading_n, rod_n);
            prop_assert!((load_n - (a * bore_pa - b * rod_pa)).abs() < 1e-6, "{load_n} N");
            prop_assert!((gauge.reading_n(load_n, rod_n) - reading_n).abs() < 1e-6);
        }
    }

    /// Sensors that share their error need no second reading, to the last bit.
    #[test]
    fn one_error_for_both_is_a_scale_of_the_load() {
        let mut effects = Effects::default();
        effects.wheels[Wheel::Fr].pressure_scale.factor = 1.1;
        let gauge = Gauge::new(7.85e-3, &effects.wheels[Wheel::Fr]);
        assert_eq!(gauge.load_n(33e3, 7e3), 33e3 / 1.1);
    }
}
