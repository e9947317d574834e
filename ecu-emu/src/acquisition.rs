//! From a sensor's voltage to a number in the ECU: noise on the line, and the converter's steps.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use xt28_machine::PerWheel;

use crate::ecus::Pins;
use crate::sensor_faults::gaussian;

/// Full scale of the converter, mV, and its steps: 12 bits (assumed; the facts name neither).
const FULL_SCALE_MV: f64 = 5_500.0;
const STEPS: f64 = 4_095.0;
/// Standard deviation of the noise on a line behind its low-pass, mV (assumed).
const NOISE_MV: f64 = 0.5;
/// Step of a frequency input, Hz (facts 4.8).
const FREQUENCY_STEP_HZ: f64 = 0.1;

/// The inputs' front end. Without a seed it is exact, as the sensors are.
#[derive(Clone, Debug)]
pub(crate) struct Acquisition {
    random: Option<ChaCha8Rng>,
}

impl Acquisition {
    pub(crate) fn new(seed: Option<u64>) -> Self {
        let random = seed.map(|seed| {
            // A stream of its own: others draw from the same seed.
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            random.set_stream(2);
            random
        });
        Self { random }
    }

    /// What the ECUs read of what is on the lines.
    pub(crate) fn read(&mut self, pins: &mut Pins) {
        let Some(random) = &mut self.random else { return };
        let mut each = |mv: &mut f64| *mv = converted(*mv + NOISE_MV * gaussian(random));
        let Pins { arm, drive, .. } = pins;
        for PerWheel(six) in [&mut arm.stroke_mv, &mut arm.pressure_a_mv, &mut arm.pressure_b_mv] {
            six.iter_mut().for_each(&mut each);
        }
        each(&mut drive.joint_front_mv);
        each(&mut drive.joint_rear_mv);
        drive.pump_mv.iter_mut().for_each(each);
        for hz in &mut drive.wheel_hz.0 {
            *hz = (*hz / FREQUENCY_STEP_HZ).round() * FREQUENCY_STEP_HZ;
        }
    }
}

/// The nearest step of the converter.
fn converted(mv: f64) -> f64 {
    let step = FULL_SCALE_MV / STEPS;
    (mv / step).round().clamp(0.0, STEPS) * step
}

#[cfg(test)]
mod tests {
    use xt28_ecus::pins::Calibration;

    use super::*;
    use crate::{Cab, wiring};

    fn pins() -> Pins {
        let readings = xt28_sim::Readings::default();
        Pins {
            arm: wiring::arm_pins(&readings, &Calibration::default()),
            drive: wiring::drive_pins(&readings, &Calibration::default()),
            cab: Cab::default().pins(),
        }
    }

    #[test]
    fn readings_stand_on_the_converters_steps() {
        assert_eq!(converted(-3.0), 0.0);
        assert_eq!(converted(9_999.0), FULL_SCALE_MV);
        let mut acquisition = Acquisition::new(Some(4));
        let mut sum = 0.0;
        for _ in 0..500 {
            let mut read = pins();
            acquisition.read(&mut read);
            for mv in read.arm.stroke_mv.0 {
                let steps = mv / FULL_SCALE_MV * STEPS;
                assert!((steps - steps.round()).abs() < 1e-6, "{mv}");
                sum += (mv - 500.0).powi(2);
            }
        }
        // Noise and a step's own uniform error, added.
        let expected_mv = NOISE_MV.hypot(FULL_SCALE_MV / STEPS / 12_f64.sqrt());
        let deviation_mv = (sum / 3000.0_f64).sqrt();
        assert!((deviation_mv - expected_mv).abs() < 0.1, "{deviation_mv} {expected_mv}");
    }

    /// Facts 4.8: frequency inputs give tenths of Hz.
    #[test]
    fn frequencies_come_in_tenths() {
        let mut read = pins();
        read.drive.wheel_hz.0 = [0.0, 0.04, 0.06, 696.34, 696.36, 9_999.96];
        Acquisition::new(Some(4)).read(&mut read);
        let tenths = read.drive.wheel_hz.0.map(|hz| (hz * 1e6).round() / 1e6);
        assert_eq!(tenths, [0.0, 0.0, 0.1, 696.3, 696.4, 10_000.0]);
    }

    #[test]
    fn without_a_seed_the_pins_stay_as_they_are() {
        let mut read = pins();
        Acquisition::new(None).read(&mut read);
        assert_eq!(read.arm, pins().arm);
        assert_eq!(read.drive, pins().drive);
    }
}
