//! Sensors: what is true, bent by bias, scale, lag and noise, as the ECUs' pins and the receiver see it.

use std::f64::consts::TAU;

use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use xt28_machine::{GRAVITY_M_S2, PerWheel, Wheel};

use crate::ecu::Inertial;
use crate::ecu::TICK_S;
use crate::ecu::arm::ArmPins;
use crate::history::History;
use crate::machine::Instant;
use crate::truth::SensorTruth;

/// Standard deviations of the analogue sensors (assumed; the receiver's are the paper's).
const STROKE_M: f64 = 1.5e-4;
const PRESSURE_PA: f64 = 8.0e3;
const RATE_DEG_S: f64 = 0.05;
const FORCE_M_S2: f64 = 0.02;
const WHEEL_RAD_S: f64 = 2.0e-3;
const JOINT_DEG: f64 = 0.01;
const GNSS_POSITION_M: f64 = 0.005;
const GNSS_VELOCITY_M_S: [f64; 3] = [0.075, 0.075, 0.025];
const GNSS_HEADING_RAD: f64 = 0.005;

/// All sensors.
#[derive(Clone, Debug)]
pub(crate) struct Sensors {
    random: ChaCha8Rng,
    stroke_m: PerWheel<Option<f64>>,
    /// Antenna's position and velocity, cosine and sine of the heading.
    antenna: [History; 8],
    velocity_m_s: Option<[f64; 3]>,
}

/// A fix of the receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fix {
    pub(crate) position_m: [f64; 3],
    pub(crate) velocity_m_s: [f64; 3],
    pub(crate) heading_rad: f64,
}

impl Sensors {
    pub(crate) fn new(random: ChaCha8Rng, here: &Instant, antenna_m: [f64; 3]) -> Self {
        let (p, v) = here.antenna(antenna_m);
        let (sin, cos) = here.yaw_rad().sin_cos();
        let now = [p[0], p[1], p[2], v[0], v[1], v[2], cos, sin];
        Self {
            random,
            stroke_m: PerWheel::splat(None),
            antenna: now.map(|value| History::new(TICK_S, value)),
            velocity_m_s: None,
        }
    }

    fn noise(&mut self, truth: &SensorTruth, sigma: f64) -> f64 {
        let drawn: f64 = StandardNormal.sample(&mut self.random);
        truth.noise * sigma * drawn
    }

    /// The arm ECU's pins; to be read every tick.
    pub(crate) fn arm_pins(&mut self, truth: &SensorTruth, here: &Instant) -> ArmPins {
        let stroke_m = PerWheel::from_fn(|wheel: Wheel| {
            let now = here.stroke_m[wheel];
            let keep = (-TICK_S / truth.stroke_lag_s[wheel].max(1e-9)).exp();
            let seen = now + keep * (self.stroke_m[wheel].unwrap_or(now) - now);
            self.stroke_m[wheel] = Some(seen);
            truth.stroke_scale[wheel] * seen
                + truth.stroke_bias_m[wheel]
                + self.noise(truth, STROKE_M)
        });
        let pressure_pa = PerWheel::from_fn(|wheel: Wheel| {
            let [a, b] = here.pressure_pa[wheel];
            let a = truth.pressure_scale[wheel] * a + truth.pressure_bias_pa[wheel];
            [a, b].map(|pa| pa + self.noise(truth, PRESSURE_PA))
        });
        ArmPins { stroke_m, pressure_pa, inertial: self.inertial(truth, here) }
    }

    fn inertial(&mut self, truth: &SensorTruth, here: &Instant) -> Inertial {
        let before = self.velocity_m_s.replace(here.velocity_m_s).unwrap_or(here.velocity_m_s);
        let felt: [f64; 3] = core::array::from_fn(|i| {
            let gravity = if i == 2 { GRAVITY_M_S2 } else { 0.0 };
            (here.velocity_m_s[i] - before[i]) / TICK_S + gravity
        });
        let into = |v: [f64; 3]| self::mounted(here.in_frame(v), truth.imu_tilt_rad);
        let (rate, force) = (into(here.rate_rad_s), into(felt));
        Inertial {
            rate_deg_s: rate
                .map(|rad| truth.gyro_scale * rad.to_degrees() + self.noise(truth, RATE_DEG_S)),
            force_m_s2: force.map(|f| f + self.noise(truth, FORCE_M_S2)),
        }
    }

    /// Wheel speeds, rad/s, and joints, deg, as the transmission ECU sees them.
    pub(crate) fn drive_pins(
        &mut self,
        truth: &SensorTruth,
        here: &Instant,
    ) -> (PerWheel<f64>, [f64; 2]) {
        let wheels = PerWheel::from_fn(|wheel: Wheel| {
            truth.wheel_speed_scale[wheel] * here.wheel_rad_s[wheel]
                + self.noise(truth, WHEEL_RAD_S)
        });
        let joints = here.joint_rad.map(|rad| {
            let deg = rad.to_degrees() + self.noise(truth, JOINT_DEG);
            (deg * 100.0).round() / 100.0
        });
        (wheels, joints)
    }

    /// Notes where the antenna is; to be done every tick.
    pub(crate) fn watch(&mut self, truth: &SensorTruth, here: &Instant, antenna_m: [f64; 3]) {
        let [x, y, z] = antenna_m;
        let [dx, dy] = truth.antenna_shift_m;
        let (p, v) = here.antenna([x + dx, y + dy, z]);
        let (sin, cos) = here.yaw_rad().sin_cos();
        let now = [p[0], p[1], p[2], v[0], v[1], v[2], cos, sin];
        for (line, value) in self.antenna.iter_mut().zip(now) {
            line.note(value);
        }
    }

    /// A fix of where the antenna was some time ago.
    pub(crate) fn fix(&mut self, truth: &SensorTruth) -> Fix {
        let then: [f64; 8] = core::array::from_fn(|i| self.antenna[i].back(truth.gnss_latency_s));
        Fix {
            position_m: core::array::from_fn(|i| then[i] + self.noise(truth, GNSS_POSITION_M)),
            velocity_m_s: core::array::from_fn(|i| {
                then[3 + i] + self.noise(truth, GNSS_VELOCITY_M_S[i])
            }),
            heading_rad: (then[7].atan2(then[6]) + self.noise(truth, GNSS_HEADING_RAD))
                .rem_euclid(TAU),
        }
    }
}

/// A vector of the frame as a unit sees it that reads these roll and pitch when level.
fn mounted([x, y, z]: [f64; 3], [roll, pitch]: [f64; 2]) -> [f64; 3] {
    let (s, c) = pitch.sin_cos();
    let [x, z] = [c * x + s * z, c * z - s * x];
    let (s, c) = roll.sin_cos();
    [x, c * y - s * z, c * z + s * y]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crooked_unit_reads_its_own_lean() {
        let [x, y, z] = mounted([0.0, 0.0, 9.81], [0.02, -0.03]);
        assert!(((x / z).atan() + 0.03).abs() < 1e-4 && ((-y / z).atan() - 0.02).abs() < 1e-4);
    }
}
