//! The pendulum-arm ECU in manual position: sensors in, solenoid currents and readings out.

use xt28_machine::{Linkage, PerWheel, Wheel};

use super::attitude::{Attitude, Inertial};
use super::channels::{PressureFilter, millimetres, solenoid_ma};
use super::position::Position;
use crate::truth::Truth;

/// Closed cylinder length in the ECU's force estimate, m; the real one is 30 mm longer.
const FORCE_CLOSED_LENGTH_M: f64 = 0.82;
/// Current at which a valve starts to open, and to full opening, mA.
const START_MA: f64 = 400.0;
const SPAN_MA: f64 = 400.0;

/// What its pins see.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ArmPins {
    pub(crate) stroke_m: PerWheel<f64>,
    /// Chambers A and B, Pa.
    pub(crate) pressure_pa: PerWheel<[f64; 2]>,
    pub(crate) inertial: Inertial,
}

/// What it says and does, in the units of the wire.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ArmReport {
    pub(crate) stroke_mm: PerWheel<f64>,
    pub(crate) pressure_kpa: PerWheel<[f64; 2]>,
    pub(crate) load_dan: PerWheel<f64>,
    pub(crate) wheel_force_dan: PerWheel<f64>,
    pub(crate) roll_deg: f64,
    pub(crate) pitch_deg: f64,
    /// Solenoids A (retracts) and B (extends), mA.
    pub(crate) current_ma: PerWheel<[f64; 2]>,
}

/// The ECU.
#[derive(Clone, Debug)]
pub(crate) struct ArmEcu {
    linkage: Linkage,
    position: PerWheel<Position>,
    pressure: PerWheel<[PressureFilter; 2]>,
    attitude: Attitude,
}

impl ArmEcu {
    pub(crate) fn new(truth: &Truth) -> Self {
        Self {
            linkage: truth.machine.linkage().with_closed_length(FORCE_CLOSED_LENGTH_M),
            position: PerWheel::splat(Position::default()),
            pressure: PerWheel::splat([PressureFilter::default(); 2]),
            attitude: Attitude::default(),
        }
    }

    /// One tick towards `target_mm`.
    pub(crate) fn tick(
        &mut self,
        truth: &Truth,
        target_mm: &PerWheel<f64>,
        pins: &ArmPins,
    ) -> ArmReport {
        let mut report = ArmReport::default();
        let arms = &truth.machine.arms;
        for wheel in Wheel::ALL {
            let stroke_mm = millimetres(pins.stroke_m[wheel]);
            let kpa: [f64; 2] = core::array::from_fn(|side| {
                self.pressure[wheel][side].step(pins.pressure_pa[wheel][side])
            });
            // 1 kPa on 1 m² is 100 daN.
            let load_dan =
                (100.0 * (arms.area_bore_m2 * kpa[0] - arms.area_rod_m2 * kpa[1])).trunc();
            let ratio = self.linkage.at_stroke(stroke_mm * 1e-3).force_ratio;
            let gains = [truth.ecu.arm_kp[wheel], truth.ecu.arm_ki[wheel]];
            let error_mm = target_mm[wheel] - stroke_mm;
            let opening = self.position[wheel].step(&truth.machine.hydraulics, gains, error_mm);
            report.stroke_mm[wheel] = stroke_mm;
            report.pressure_kpa[wheel] = kpa;
            report.load_dan[wheel] = load_dan;
            report.wheel_force_dan[wheel] = (ratio * load_dan).trunc();
            report.current_ma[wheel] =
                [-opening, opening].map(|share| solenoid_ma(share, START_MA, SPAN_MA));
        }
        [report.roll_deg, report.pitch_deg] = self.attitude.step(&pins.inertial);
        report
    }
}

/// Opening that a pair of currents holds a spool at, extending > 0.
pub(crate) fn opening([retract_ma, extend_ma]: [f64; 2]) -> f64 {
    let of = |ma: f64| ((ma - START_MA) / SPAN_MA).max(0.0);
    of(extend_ma) - of(retract_ma)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pins(stroke_m: f64, pa: [f64; 2]) -> ArmPins {
        ArmPins {
            stroke_m: PerWheel::splat(stroke_m),
            pressure_pa: PerWheel::splat(pa),
            inertial: Inertial { rate_deg_s: [0.0; 3], force_m_s2: [0.0, 0.0, 9.81] },
        }
    }

    #[test]
    fn an_arm_too_short_is_driven_out_by_solenoid_b() {
        let truth = Truth::nominal();
        let mut ecu = ArmEcu::new(&truth);
        let report = ecu.tick(&truth, &PerWheel::splat(210.0), &pins(0.2004, [7e6, 5e5]));
        assert_eq!(report.stroke_mm[Wheel::Fr], 200.0);
        assert_eq!(report.current_ma[Wheel::Fr], [0.0, 416.0]);
        assert!((opening(report.current_ma[Wheel::Fr]) - 0.04).abs() < 1e-12);
        assert!((opening([450.0, 0.0]) + 0.125).abs() < 1e-12);
    }

    #[test]
    fn loads_come_from_both_chambers_and_the_shorter_linkage() {
        let truth = Truth::nominal();
        let report =
            ArmEcu::new(&truth).tick(&truth, &PerWheel::splat(250.0), &pins(0.25, [7e6, 5e5]));
        assert_eq!(report.load_dan[Wheel::Bl], (785.0_f64 * 7.0 - 589.0 * 0.5).trunc());
        let ratio = report.wheel_force_dan[Wheel::Bl] / report.load_dan[Wheel::Bl];
        assert!((ratio - 0.4991).abs() < 1e-3, "{ratio}");
    }
}
