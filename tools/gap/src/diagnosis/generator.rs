//! Residual generators: each drives one block with measured inputs and says where it parts from the log.

mod antenna;
mod arm_drive;
mod arms;
mod axles;
mod bus;
mod circuits;
mod controllers;
mod current_step;
mod driving;
mod grade;
mod joints;
mod lifted;
mod loads;
mod position_control;
mod press;
mod pump;
mod rolling;
mod scrub;
mod side_slip;
mod spool;
mod stance;
#[cfg(test)]
pub(super) mod still;
mod summed;
mod traction;
mod travel;
mod turning;

use core::fmt;

use xt28_machine::{Machine, Wheel};
use xt28_sim::Effects;
use xt28_sim::effects::{Block, Effect, Scope};

use super::belief::EffectSchedule;
use super::floor::Signal;
use super::floors::BlockKey;
use super::signals::{DT_S, Samples, Signals};
pub(super) use circuits::{PRESSURE_AT_TORQUE_MAX_PA, weights};
pub(super) use controllers::STEER_WINDUP_DEG_S;
pub(super) use loads::is_off_scale;
pub use rolling::share_resistance;

/// Samples of a log that make one sample of a residual: residuals come ten times a second.
pub(super) const SAMPLES_PER_RESIDUAL: usize = 10;
/// Time from one sample of a residual to the next, s.
#[allow(clippy::cast_precision_loss)]
pub(super) const STEP_S: f64 = SAMPLES_PER_RESIDUAL as f64 * DT_S;

/// Effects that show in how the machine stands, beside masses, ground, tyres and their sensors. How hard a wheel
/// rolls is not among them, though the stance reckons with it: whether its arm feels that is another law on each
/// make (a tyre that flexes, a bearing that rubs).
const STANDING: [&str; 3] = ["imu-offset", "seal-stiction", "standstill-drag"];

/// Effects that show in how the wheels roll, beside the receiver's.
const ROLLING: [&str; 6] = [
    "rolling-resistance",
    "slippery-ground",
    "soft-tyres",
    "standstill-drag",
    "stroke-scale",
    "wheel-speed-scale",
];

/// Effects that show in how the machine turns beside what its joints read: others turn the joints as well. A mast that
/// is bent does where it jumps.
const TURNING: [&str; 3] = ["gnss-latency", "gnss-lever-arm", "slippery-ground"];

/// Whether fixes jump where an effect sets in: a receiver that is late from then on tells once more where it was.
#[must_use]
pub(super) fn moves_fixes(effect: &Effect) -> bool {
    effect.name.starts_with("gnss-")
}

/// One residual generator.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Generator {
    /// Opening and load to stroke, one arm.
    ArmStroke(Wheel),
    /// Command and stroke to opening, one arm.
    ArmEcu(Wheel),
    /// Opening and angle to the torque between them, front (0) or rear (1) joint.
    Joint(usize),
    /// Command and angle to opening, front (0) or rear (1) joint.
    SteerEcu(usize),
    /// Throttle and wheel speeds to pressures, pressures to motion.
    Drive,
    /// Strokes and loads to attitude and weight.
    Stance,
    /// Wheel speeds, arms and joints to one another and to the receiver's fixes.
    Travel,
    /// Joints and speed over ground to how the receiver says that the machine turns.
    Turning,
    /// What commands come, and when.
    Bus,
}

/// One residual: what a block predicts less what was measured, in units of its floor.
#[derive(Clone, Debug)]
pub struct Residual {
    /// Who made it.
    pub generator: Generator,
    /// Which of its signals.
    pub signal: Signal,
    /// Ten samples a second; `NaN` where nothing can be said.
    pub values: Samples,
}

impl Generator {
    /// All there are.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let mut all = Vec::new();
        all.extend(Wheel::ALL.map(Self::ArmStroke));
        all.extend(Wheel::ALL.map(Self::ArmEcu));
        all.extend([Self::Joint(0), Self::Joint(1), Self::SteerEcu(0), Self::SteerEcu(1)]);
        all.extend([Self::Drive, Self::Stance, Self::Travel, Self::Turning, Self::Bus]);
        all
    }

    /// Whether it can tell anything of an effect, at a scope.
    #[must_use]
    pub fn hears(self, effect: &Effect, scope: Scope) -> bool {
        let name = effect.name;
        match self {
            Self::ArmStroke(w) => {
                let here = !effect.has_scope() || scope.contains(w);
                let arms = effect.block == Block::Arms && name != "arm-gain";
                here && (arms || name.starts_with("stroke-") || name.starts_with("pressure-"))
            }
            Self::ArmEcu(w) => name == "arm-gain" && scope.contains(w),
            Self::SteerEcu(joint) => {
                name == "steer-gain" || (joint == 1 && name == "rear-follower-lag")
            }
            // The controllers' laws too: they tell what its currents leave open of a valve. And ground on which
            // tyres take less of a joint.
            Self::Joint(joint) => {
                let steers = effect.block == Block::Steering;
                let scrubs = name == "slippery-ground";
                scrubs || (steers && (joint == 1 || name != "rear-follower-lag"))
            }
            Self::Drive => {
                effect.block == Block::Drive
                    || matches!(name, "payload" | "terrain-slope" | "wheel-speed-scale")
            }
            Self::Stance => {
                matches!(effect.block, Block::Payload | Block::Ground | Block::Tyre)
                    || STANDING.contains(&name)
                    || name.starts_with("pressure-")
                    || name.starts_with("stroke-")
            }
            Self::Travel => ROLLING.contains(&name) || moves_fixes(effect),
            Self::Turning => TURNING.contains(&name),
            Self::Bus => effect.block == Block::Bus,
        }
    }

    /// When the last was read of which it says `signal` at `at_s` of a run, s.
    pub(super) fn read_at_s(self, signal: Signal, at_s: f64) -> f64 {
        match self {
            Self::Stance => stance::read_at_s(signal, at_s),
            Self::Turning => at_s + turning::HALF_S,
            _ => at_s,
        }
    }

    /// The wheel that it looks at, where it looks at one alone.
    #[must_use]
    pub const fn wheel(self) -> Option<Wheel> {
        match self {
            Self::ArmStroke(wheel) | Self::ArmEcu(wheel) => Some(wheel),
            _ => None,
        }
    }

    /// What it is called, and which of several alike it is.
    #[must_use]
    pub const fn key(self) -> BlockKey {
        let number = match self {
            Self::ArmStroke(wheel) | Self::ArmEcu(wheel) => wheel.index(),
            Self::Joint(joint) | Self::SteerEcu(joint) => joint,
            Self::Drive | Self::Stance | Self::Travel | Self::Turning | Self::Bus => 0,
        };
        (self.part(), number)
    }

    /// The block it watches.
    #[must_use]
    pub const fn block(self) -> Block {
        match self {
            Self::ArmStroke(_) | Self::ArmEcu(_) => Block::Arms,
            Self::Joint(_) | Self::SteerEcu(_) | Self::Turning => Block::Steering,
            Self::Drive | Self::Travel => Block::Drive,
            Self::Stance => Block::Payload,
            Self::Bus => Block::Bus,
        }
    }

    /// What it is called, without its wheel or joint.
    #[must_use]
    pub const fn part(self) -> &'static str {
        match self {
            Self::ArmStroke(_) => "arm",
            Self::ArmEcu(_) => "arm controller",
            Self::Joint(_) => "joint",
            Self::SteerEcu(_) => "steering controller",
            Self::Drive => "drive",
            Self::Stance => "stance",
            Self::Travel => "travel",
            Self::Turning => "turning",
            Self::Bus => "bus",
        }
    }

    /// Its residuals on one run, in units of their floors.
    #[must_use]
    pub fn residuals(self, s: &Signals, machine: &Machine, effects: &Effects) -> Vec<Residual> {
        self.residuals_over(s, machine, effects.into())
    }

    /// The same over a `schedule` of effects, as far as its own memory reaches back over the instant at which
    /// they set in: a reading that jumps leaves an arm's stroke in doubt for seconds. What is before
    /// the instant is as if they had always been there.
    #[must_use]
    pub(super) fn residuals_over(
        self,
        s: &Signals,
        machine: &Machine,
        schedule: EffectSchedule<'_>,
    ) -> Vec<Residual> {
        let mut all = self.all_residuals_over(s, machine, schedule);
        // What a command's place in time is does not hang on what was before.
        if self != Self::Bus {
            let settles_s = s.settles_s();
            all.iter_mut().for_each(|residual| unsettled(&mut residual.values, settles_s));
        }
        all
    }

    /// The same from the log's first instant on, where blocks may not have settled.
    fn all_residuals_over(
        self,
        s: &Signals,
        machine: &Machine,
        schedule: EffectSchedule<'_>,
    ) -> Vec<Residual> {
        let effects = schedule.effects;
        let one = |signal: Signal, raw: Samples| Residual {
            generator: self,
            signal,
            values: thin(&raw, s.floors.sigma(self.key(), signal)),
        };
        let thinned = |signal: Signal, raw: Samples| {
            let sigma = s.floors.sigma(self.key(), signal);
            let values = raw.into_iter().map(|value| value / sigma).collect();
            Residual { generator: self, signal, values }
        };
        match self {
            Self::ArmStroke(w) => {
                vec![one(Signal::Stroke, arms::stroke_error_m(s, machine, schedule, w))]
            }
            Self::ArmEcu(w) => {
                let error = position_control::arm_opening_error(s, machine, effects, w);
                vec![one(Signal::ArmOpening, error)]
            }
            Self::Joint(j) => {
                let errors = joints::joint_errors(s, machine, schedule, j).by_signal();
                errors.map(|(signal, raw)| one(signal, raw)).to_vec()
            }
            Self::SteerEcu(j) => {
                let error = controllers::steer_opening_error(s, machine, schedule, j);
                vec![one(Signal::SteerOpening, error)]
            }
            Self::Drive => {
                let errors = driving::drive_errors(s, machine, effects);
                vec![
                    one(Signal::DrivePressure, errors.pressure_pa),
                    one(Signal::DriveDifference, errors.difference_pa),
                    one(Signal::DriveForce, errors.force_nm),
                ]
            }
            Self::Stance => {
                let errors = stance::stance_errors(s, machine, schedule).by_signal();
                errors.map(|(signal, raw)| thinned(signal, raw)).collect()
            }
            Self::Travel => {
                let e = travel::travel_errors(s, machine, schedule);
                let mut all = vec![one(Signal::TravelSpeed, e.speed_m_s)];
                all.push(one(Signal::TravelCourse, e.course_rad));
                all.extend(
                    e.wheel_rad_s
                        .0
                        .into_iter()
                        .zip(Wheel::ALL)
                        .map(|(raw, w)| one(Signal::WheelSpeed(w), raw)),
                );
                all
            }
            Self::Turning => {
                let error = turning::yaw_rate_error_rad_s(s, machine, schedule);
                vec![thinned(Signal::YawRate, error)]
            }
            Self::Bus => {
                let e = bus::bus_errors(s, effects);
                vec![
                    one(Signal::BusMissing, e.missing),
                    one(Signal::BusPlace, e.out_of_place),
                    one(Signal::BusUneven, e.uneven),
                ]
            }
        }
    }
}

/// Has nothing said of the first `settles_s` of a run.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn unsettled(values: &mut Samples, settles_s: f64) {
    let unknown = (settles_s / STEP_S).ceil() as usize;
    values.iter_mut().take(unknown).for_each(|value| *value = f64::NAN);
}

/// Means of ten samples, over the floor; `NaN` where one of them is.
#[allow(clippy::cast_precision_loss)]
fn thin(raw: &Samples, sigma: f64) -> Samples {
    raw.chunks_exact(SAMPLES_PER_RESIDUAL)
        .map(|c| c.iter().sum::<f64>() / (SAMPLES_PER_RESIDUAL as f64 * sigma))
        .collect()
}

impl fmt::Display for Generator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const JOINT: [&str; 2] = ["front", "rear"];
        let part = self.part();
        match self {
            Self::ArmStroke(w) | Self::ArmEcu(w) => write!(f, "{part} {w}"),
            Self::Joint(j) | Self::SteerEcu(j) => write!(f, "{part} {}", JOINT[*j]),
            Self::Drive | Self::Stance | Self::Travel | Self::Turning | Self::Bus => {
                f.write_str(part)
            }
        }
    }
}
