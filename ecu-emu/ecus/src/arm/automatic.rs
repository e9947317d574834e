//! Mode automatic: the paper's cascade (2.3.2) from attitude and loads to solenoid currents.
//!
//! Top: four controllers, each with a force request for every arm, and their weighted sum. Middle:
//! a PID an arm from force to valve opening. Bottom: the current controller of each solenoid.
//!
//! Six arms under three stiff frames have three ways to move the chassis (height, roll, pitch) and
//! three that only shift load between wheels. In the first three the forces are given by the weight
//! whatever the valves do, so a request there is a speed until its controller is content; in the
//! other three the ground-pressure controller closes a true force loop. Without it the split of the
//! load would drift: one millimetre of stroke is 2 kN.

mod force_control;
mod ground_pressure;
mod levelling;
mod solenoid;

use xt28_machine::{Machine, PerWheel, Wheel};

use self::force_control::{ForceControl, ForceGains};
use self::ground_pressure::{GroundPressure, even};
use self::levelling::{Levelling, Pose};
use self::solenoid::Solenoids;
use super::sensing::ArmReadings;
use super::stroke_limit::StrokeLimit;
use crate::pins;

const N_PER_DAN: f64 = 10.0;

/// Currents `[A, B]` of every valve's solenoids, mA.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Currents {
    /// Asked for.
    pub(crate) wanted_ma: PerWheel<[f64; 2]>,
    /// Flowing.
    pub(crate) actual_ma: PerWheel<[f64; 2]>,
}

impl Currents {
    /// Currents that flow as soon as they are asked for.
    pub(crate) const fn immediate(wanted_ma: PerWheel<[f64; 2]>) -> Self {
        Self { wanted_ma, actual_ma: wanted_ma }
    }
}

/// The cascade.
#[derive(Clone, Debug)]
pub(crate) struct Automatic {
    levelling: Levelling,
    weights: [f64; 4],
    ground: GroundPressure,
    gains: ForceGains,
    control: PerWheel<ForceControl>,
    solenoids: PerWheel<Solenoids>,
    solenoid_share: f64,
    height_m: f64,
}

impl Automatic {
    pub(crate) fn new(machine: &Machine) -> Self {
        Self {
            levelling: Levelling::new(&machine.levelling),
            weights: machine.levelling.weights,
            ground: GroundPressure::new(machine),
            gains: ForceGains::new(&machine.levelling),
            control: PerWheel::splat(ForceControl::default()),
            solenoids: PerWheel::splat(Solenoids::default()),
            solenoid_share: solenoid::share(machine.levelling.solenoid_s),
            height_m: machine.levelling.height_m,
        }
    }

    /// Forgets what the controllers remember, for a mode that was left.
    pub(crate) const fn reset(&mut self) {
        self.control = PerWheel::splat(ForceControl::RESTING);
        self.solenoids = PerWheel::splat(Solenoids::RESTING);
    }

    /// One tick: level, mean stroke at `height_m` (the machine's own where none is asked for), load
    /// spread evenly. `angles_deg` are pitch and roll.
    pub(crate) fn step(
        &mut self,
        height_m: Option<f64>,
        readings: &ArmReadings,
        angles_deg: [f64; 2],
        limit: &StrokeLimit,
    ) -> Currents {
        let request_n = self.requests(height_m, readings, angles_deg);
        let mut currents = Currents::default();
        for wheel in Wheel::ALL {
            let (request_n, force_n) = (request_n[wheel], force_n(readings, wheel));
            let free = |opening: f64| limit.hold(opening, readings.stroke_mm[wheel]);
            let opening = self.control[wheel].step(&self.gains, request_n, force_n, free);
            let wanted_ma = pins::valve_ma(opening);
            currents.wanted_ma[wheel] = wanted_ma;
            currents.actual_ma[wheel] = self.solenoids[wheel].step(wanted_ma, self.solenoid_share);
        }
        currents
    }

    /// Force that each arm shall have, N at the wheel: the weighted sum of the four requests.
    fn requests(
        &self,
        height_m: Option<f64>,
        readings: &ArmReadings,
        [pitch_deg, roll_deg]: [f64; 2],
    ) -> PerWheel<f64> {
        let force_n = PerWheel::from_fn(|w| force_n(readings, w));
        let stroke_m = readings.stroke_mm.map(|mm| mm * 1e-3);
        let pose = Pose {
            height_m: stroke_m.mean(),
            roll_rad: roll_deg.to_radians(),
            pitch_rad: pitch_deg.to_radians(),
        };
        let even_n = even(&self.ground.places(&stroke_m), &force_n);
        let [height_n, roll_n, pitch_n] =
            self.levelling.requests(height_m.unwrap_or(self.height_m), &pose);
        let [height, roll, pitch, ground] = self.weights;
        PerWheel::from_fn(|w| {
            // The ground-pressure controller says where the force should be, the others by how much
            // to leave that; the force itself is what stays when all are silent.
            force_n[w]
                + height * height_n[w]
                + roll * roll_n[w]
                + pitch * pitch_n[w]
                + ground * (even_n[w] - force_n[w])
        })
    }
}

/// Vertical force on a wheel as the ECU estimates it, N.
fn force_n(readings: &ArmReadings, wheel: Wheel) -> f64 {
    N_PER_DAN * readings.wheel_force_dan[wheel]
}
