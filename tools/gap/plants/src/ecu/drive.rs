//! The transmission ECU: throttle to speed demand, steering, trim of wheels that run away.

use std::f64::consts::TAU;

use xt28_machine::{PerWheel, Wheel};

use super::TICK_S;
use super::channels::solenoid_ma;
use super::steering::Steering;
use crate::drive::DriveDemand;
use crate::truth::Truth;

/// A wheel may be this far off its circuit's mean, rad/s.
const SLIP_FREE_RAD_S: f64 = 4.0 * TAU / 60.0;
/// What it is pulled back with beyond, Nm s.
const SLIP_NMS: f64 = 6_000.0;
/// Steering solenoids: current at which they start, and to full opening, mA; nothing below this
/// opening.
const STEER_START_MA: f64 = 415.0;
const STEER_SPAN_MA: f64 = 315.0;
const STEER_LEAST: f64 = 0.004;
/// Pump solenoids, mA: read off logs of another machine.
const PUMP_START_MA: f64 = 196.0;
const PUMP_SPAN_MA: f64 = 408.0;

/// What its pins and the gateway tell it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DrivePins {
    /// -1 to 1.
    pub(crate) throttle: f64,
    /// Front joint's target, deg; left > 0.
    pub(crate) target_deg: f64,
    /// Front and rear joint, deg.
    pub(crate) joint_deg: [f64; 2],
    /// Wheel speeds as the sensors have them, rad/s.
    pub(crate) wheel_rad_s: PerWheel<f64>,
}

/// What it does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct DriveReport {
    pub(crate) demand: DriveDemand,
    /// Openings of the front and the rear steering valve, left > 0, as their currents hold them.
    pub(crate) steer: [f64; 2],
    /// Front A, B, rear A, B, mA; A is left.
    pub(crate) steer_ma: [f64; 4],
    /// Pumps 1A 1B 2A 2B, mA; B is forward.
    pub(crate) pump_ma: [f64; 4],
}

/// The ECU.
#[derive(Clone, Debug)]
pub(crate) struct DriveEcu {
    circuits: [[Wheel; 3]; 2],
    target_rad_s: f64,
    steering: Steering,
}

impl DriveEcu {
    /// # Panics
    /// For circuits that no machine file can have.
    pub(crate) fn new(truth: &Truth) -> Self {
        let circuits = truth.machine.circuits().expect("checked when the machine was read");
        Self { circuits, target_rad_s: 0.0, steering: Steering::default() }
    }

    /// One tick.
    pub(crate) fn tick(&mut self, truth: &Truth, pins: &DrivePins) -> DriveReport {
        let (d, w) = (&truth.machine.drive, &truth.machine.wheels);
        let asked = pins.throttle.clamp(-1.0, 1.0) * d.speed_full_m_s / w.radius_m;
        let keep = (-TICK_S / d.speed_time_constant_s).exp();
        self.target_rad_s = asked + keep * (self.target_rad_s - asked);
        let speed_m_s = pins.wheel_rad_s.mean() * w.radius_m;
        let steer = self.steering.step(
            &truth.machine.articulation,
            &truth.ecu,
            pins.target_deg,
            pins.joint_deg,
            speed_m_s,
        );
        let steer = steer.map(|opening| if opening.abs() < STEER_LEAST { 0.0 } else { opening });
        let current = |share| solenoid_ma(share, STEER_START_MA, STEER_SPAN_MA);
        let throttle = self.target_rad_s * w.radius_m / d.speed_full_m_s;
        let pump = |share| solenoid_ma(share, PUMP_START_MA, PUMP_SPAN_MA);
        let [reverse, forward] = [pump(-throttle), pump(throttle)];
        DriveReport {
            demand: DriveDemand {
                speed_rad_s: [self.target_rad_s; 2],
                trim_nm: self.trim_nm(&pins.wheel_rad_s),
            },
            steer: steer.map(|opening| (opening * STEER_SPAN_MA).round() / STEER_SPAN_MA),
            steer_ma: [
                current(steer[0]),
                current(-steer[0]),
                current(steer[1]),
                current(-steer[1]),
            ],
            pump_ma: [reverse, forward, reverse, forward],
        }
    }

    fn trim_nm(&self, speed: &PerWheel<f64>) -> PerWheel<f64> {
        let mut trim = PerWheel::splat(0.0);
        for wheels in &self.circuits {
            let mean = wheels.iter().map(|&w| speed[w]).sum::<f64>() / 3.0;
            for &wheel in wheels {
                let off = speed[wheel] - mean;
                trim[wheel] = SLIP_NMS * (off - off.clamp(-SLIP_FREE_RAD_S, SLIP_FREE_RAD_S));
            }
        }
        trim
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pins(throttle: f64, wheel: f64) -> DrivePins {
        DrivePins {
            throttle,
            target_deg: 10.0,
            joint_deg: [0.0; 2],
            wheel_rad_s: PerWheel::splat(wheel),
        }
    }

    #[test]
    fn the_target_follows_the_throttle_in_its_time() {
        let truth = Truth::nominal();
        let mut ecu = DriveEcu::new(&truth);
        let report = (0..15).map(|_| ecu.tick(&truth, &pins(0.6, 1.0))).last().unwrap();
        let full = 0.6 * 1.5 / 0.74;
        assert!((report.demand.speed_rad_s[0] / full - 0.632).abs() < 1e-3);
        let report = (0..500).map(|_| ecu.tick(&truth, &pins(0.6, 1.0))).last().unwrap();
        assert_eq!(report.pump_ma, [0.0, 441.0, 0.0, 441.0]);
        assert!(report.steer_ma[0] > 415.0 && report.steer_ma[1] == 0.0);
    }

    #[test]
    fn a_wheel_that_runs_away_is_pulled_back() {
        let truth = Truth::nominal();
        let mut pins = pins(0.5, 1.0);
        pins.wheel_rad_s[Wheel::Ml] = 3.0;
        let trim = DriveEcu::new(&truth).tick(&truth, &pins).demand.trim_nm;
        let off = 3.0 - 5.0 / 3.0 - SLIP_FREE_RAD_S;
        assert!((trim[Wheel::Ml] - 6000.0 * off).abs() < 1e-6);
        assert_eq!(trim[Wheel::Mr], 0.0);
    }
}
