//! A kinematic Xt28: two frames without sideslip, the ECU's steering law, lag and delay.
//! Small enough to be seen right, and not the plant the policy is later run on.

use std::collections::VecDeque;

use gateway::{Action, Attitude, Located, Observation, Pose};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use xt28_machine::{Axle, Machine, PerWheel, Side, SimTime, Wheel};
use xt28_safety::{Arms, Command};

pub(crate) const TICK_S: f64 = 0.01;

/// What the paper leaves open: delays of 0.2 to 0.7 s (throttle) and 0.2 to 0.5 s (steering).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Variant {
    pub(crate) throttle_delay_s: f64,
    pub(crate) steering_delay_s: f64,
    /// True speed over what the machine file says.
    pub(crate) speed_factor: f64,
    pub(crate) noise: bool,
}

pub(crate) struct Vehicle {
    machine: Machine,
    variant: Variant,
    pub(crate) pose: Pose,
    pub(crate) speed_m_s: f64,
    joint_rad: f64,
    joint_integral: f64,
    stroke_m: PerWheel<f64>,
    /// Attitude of the ground under the wheels.
    pub(crate) ground: Attitude,
    throttle_line: VecDeque<f64>,
    angle_line: VecDeque<f64>,
    rng: ChaCha8Rng,
}

impl Vehicle {
    pub(crate) fn new(machine: Machine, variant: Variant, rng: ChaCha8Rng) -> Self {
        let line = |delay_s: f64| VecDeque::from(vec![0.0; (delay_s / TICK_S).round() as usize]);
        Self {
            variant,
            pose: Pose::default(),
            speed_m_s: 0.0,
            joint_rad: 0.0,
            joint_integral: 0.0,
            stroke_m: PerWheel::splat(0.17),
            ground: Attitude::default(),
            throttle_line: line(variant.throttle_delay_s),
            angle_line: line(variant.steering_delay_s),
            machine,
            rng,
        }
    }

    pub(crate) fn attitude(&self) -> Attitude {
        // Heights of the frame above the wheels, by the linkage's slope near the middle.
        let slope = 1.0 / self.machine.linkage().at_stroke(0.17).force_ratio;
        let mean = |pick: &dyn Fn(Wheel) -> bool| {
            let picked: Vec<_> = Wheel::ALL.into_iter().filter(|w| pick(*w)).collect();
            picked.iter().map(|w| self.stroke_m[*w]).sum::<f64>() / picked.len() as f64
        };
        let right_minus_left =
            mean(&|w| w.side() == Side::Right) - mean(&|w| w.side() == Side::Left);
        let front_minus_rear =
            mean(&|w| w.axle() == Axle::Front) - mean(&|w| w.axle() == Axle::Rear);
        Attitude {
            roll_rad: self.ground.roll_rad + slope * right_minus_left / 2.35,
            pitch_rad: self.ground.pitch_rad + slope * front_minus_rear / 6.05,
        }
    }

    pub(crate) fn step(&mut self, command: &Command) {
        self.throttle_line.push_back(if command.brake { 0.0 } else { command.throttle });
        self.angle_line.push_back(command.front_angle_rad);
        let throttle = self.throttle_line.pop_front().unwrap();
        let target_rad = self.angle_line.pop_front().unwrap();

        let drive = &self.machine.drive;
        let wanted = throttle * drive.speed_full_m_s * self.variant.speed_factor;
        self.speed_m_s += (wanted - self.speed_m_s) * TICK_S / drive.speed_time_constant_s;

        let joint_rate = self.joint_rate(target_rad);
        self.joint_rad += joint_rate * TICK_S;
        // Front axle and middle axle run without sideslip; the joint lies between them.
        let (sin, cos) = self.joint_rad.sin_cos();
        let turn_rate = (self.speed_m_s * sin + 1.85 * joint_rate) / (1.85 * cos + 1.85);
        self.pose.heading_rad += turn_rate * TICK_S;
        let (sin, cos) = self.pose.heading_rad.sin_cos();
        self.pose.east_m += self.speed_m_s * cos * TICK_S;
        self.pose.north_m += self.speed_m_s * sin * TICK_S;

        if let Arms::Position(targets) = command.arms {
            let h = &self.machine.hydraulics;
            for (stroke, target) in self.stroke_m.0.iter_mut().zip(targets) {
                let Some(target) = target else { continue };
                let opening = (h.manual_kp_per_mm * 1e3 * (target - *stroke)).clamp(-0.3, 0.3);
                *stroke += opening * h.speed_full_m_s * TICK_S;
            }
        }
    }

    /// The steering law of the transmission ECU, rad/s.
    fn joint_rate(&mut self, target_rad: f64) -> f64 {
        let a = &self.machine.articulation;
        if self.speed_m_s.abs() < a.speed_threshold_m_s {
            self.joint_integral = 0.0;
            return 0.0;
        }
        let error_deg = (target_rad - self.joint_rad).to_degrees();
        self.joint_integral = (self.joint_integral + error_deg * TICK_S).clamp(-40.0, 40.0);
        let opening = a.kp_per_deg * (error_deg + a.ki_per_s * self.joint_integral);
        opening.clamp(-1.0, 1.0) * a.rate_max_deg_s.to_radians()
    }

    pub(crate) fn observe(&mut self, at: SimTime) -> Observation {
        let noise = self.variant.noise;
        let mut of = |sigma: f64| {
            if noise { Normal::new(0.0, sigma).unwrap().sample(&mut self.rng) } else { 0.0 }
        };
        let pose = Pose {
            east_m: self.pose.east_m + of(0.005),
            north_m: self.pose.north_m + of(0.005),
            heading_rad: self.pose.heading_rad + of(0.005),
        };
        let (sin, cos) = self.pose.heading_rad.sin_cos();
        let velocity_m_s =
            [self.speed_m_s * cos + of(0.075), self.speed_m_s * sin + of(0.075), of(0.025)];
        Observation {
            at,
            sensed_at: at,
            since_arming_s: Some(at.as_secs_f64()),
            located: Some(Located { at, pose, velocity_m_s }),
            attitude: self.attitude(),
            stroke_m: self.stroke_m,
            load_n: PerWheel::splat(50e3),
            wheel_speed_rad_s: PerWheel::splat(self.speed_m_s / 0.74),
            wheel_speed_m_s: self.speed_m_s,
            front_joint_rad: self.joint_rad,
            rear_joint_rad: 0.56 * self.joint_rad,
            previous_action: Action::default(),
        }
    }
}
