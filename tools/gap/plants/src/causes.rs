//! Everything that can be wrong with a foreign machine, a file each.
//!
//! Names are those of the simulator's catalogue where it has the effect; the physics here are this
//! crate's own. Eight causes are in no catalogue: data made with them must come back as unknown.

mod accumulator_gas;
mod arm_delay;
mod arm_gain;
mod bearing_binding;
mod com_shift;
mod command_jitter;
mod drive_lag;
mod engine_droop;
mod frame_loss;
mod gnss_latency;
mod gnss_lever_arm;
mod gyro_scale;
mod imu_offset;
mod leakage_drift;
mod load_dependent_speed;
mod lock_damping;
mod oil_heating;
mod output_stuck;
mod payload;
mod pressure_bias;
mod pressure_scale;
mod pump_flow_limit;
mod pump_hunting;
mod rear_follower_lag;
mod rolling_resistance;
mod seal_stiction;
mod slippery_ground;
mod soft_tyres;
mod speed_asymmetry;
mod standstill_drag;
mod steer_backlash;
mod steer_creep;
mod steer_delay;
mod steer_gain;
mod steer_lag;
mod steer_rate;
mod stroke_bias;
mod stroke_scale;
mod stroke_sensor_lag;
mod terrain_slope;
mod throttle_delay;
mod unsupported_sag;
mod valve_cross_talk;
mod valve_deadband;
mod valve_gain;
mod valve_hysteresis;
mod valve_lag;
mod wheel_speed_scale;

use rand::Rng;
use rand_chacha::ChaCha8Rng;

use crate::manoeuvre::Manoeuvre;
use crate::scope::Scope;
use crate::truth::Truth;

/// Where on the machine a cause sits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Block {
    Arms,
    Steering,
    Drive,
    Tyre,
    Payload,
    Ground,
    Sensor,
    Bus,
}

/// What a cause can be on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scopes {
    /// The machine: it has no wheel.
    Whole,
    /// Any group of wheels.
    Any,
    /// Any group but all of them: alike on all, nothing would show it.
    Part,
}

/// A range that a parameter is drawn from, evenly: from noticeable to strong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span(pub f64, pub f64);

/// A number that says how bad it is; its unit is in its name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// As in an answer.
    pub name: &'static str,
    /// One of these is picked, each as often.
    pub spans: &'static [Span],
}

/// Something that can be wrong.
#[derive(Clone, Copy, Debug)]
pub struct Cause {
    /// As in an answer.
    pub name: &'static str,
    /// Where it sits.
    pub block: Block,
    /// Whether a catalogue of the bench has it.
    pub is_known: bool,
    /// The signal that it shows in first: stroke, load, opening, joint, steer, wheel, pump, position,
    /// att (roll and pitch), or bus (when frames come).
    pub signal: &'static str,
    /// What it can be on.
    pub scopes: Scopes,
    /// Whether it can begin in the middle of a run.
    pub may_begin_late: bool,
    /// The manoeuvre that shows it best.
    pub shown_by: Manoeuvre,
    /// How bad it is.
    pub parameters: &'static [Parameter],
    pub(crate) apply: fn(&mut Truth, Scope, &[f64]),
}

/// All causes: first those of the catalogue, in its order, then the unknown ones.
pub static CAUSES: &[Cause] = &[
    arm_delay::CAUSE,
    valve_lag::CAUSE,
    valve_deadband::CAUSE,
    valve_hysteresis::CAUSE,
    valve_gain::CAUSE,
    speed_asymmetry::CAUSE,
    load_dependent_speed::CAUSE,
    pump_flow_limit::CAUSE,
    leakage_drift::CAUSE,
    unsupported_sag::CAUSE,
    seal_stiction::CAUSE,
    accumulator_gas::CAUSE,
    lock_damping::CAUSE,
    arm_gain::CAUSE,
    steer_delay::CAUSE,
    steer_lag::CAUSE,
    steer_backlash::CAUSE,
    steer_rate::CAUSE,
    steer_gain::CAUSE,
    rear_follower_lag::CAUSE,
    throttle_delay::CAUSE,
    drive_lag::CAUSE,
    rolling_resistance::CAUSE,
    standstill_drag::CAUSE,
    slippery_ground::CAUSE,
    engine_droop::CAUSE,
    soft_tyres::CAUSE,
    payload::CAUSE,
    com_shift::CAUSE,
    terrain_slope::CAUSE,
    stroke_bias::CAUSE,
    stroke_scale::CAUSE,
    pressure_bias::CAUSE,
    pressure_scale::CAUSE,
    imu_offset::CAUSE,
    wheel_speed_scale::CAUSE,
    gnss_latency::CAUSE,
    gnss_lever_arm::CAUSE,
    frame_loss::CAUSE,
    command_jitter::CAUSE,
    valve_cross_talk::CAUSE,
    pump_hunting::CAUSE,
    oil_heating::CAUSE,
    output_stuck::CAUSE,
    bearing_binding::CAUSE,
    steer_creep::CAUSE,
    stroke_sensor_lag::CAUSE,
    gyro_scale::CAUSE,
];

impl Block {
    /// Its name in an answer.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Arms => "arms",
            Self::Steering => "steering",
            Self::Drive => "drive",
            Self::Tyre => "tyre",
            Self::Payload => "payload",
            Self::Ground => "ground",
            Self::Sensor => "sensor",
            Self::Bus => "bus",
        }
    }
}

impl Cause {
    /// The cause of this name.
    #[must_use]
    pub fn find(name: &str) -> Option<&'static Self> {
        CAUSES.iter().find(|cause| cause.name == name)
    }

    /// Its parameters, drawn.
    pub(crate) fn draw(&self, random: &mut ChaCha8Rng) -> Vec<f64> {
        let mut one = |parameter: &Parameter| {
            let Span(low, high) = parameter.spans[random.random_range(0..parameter.spans.len())];
            random.random_range(low..=high)
        };
        self.parameters.iter().map(&mut one).collect()
    }

    /// Each parameter at the strong end of its last span.
    #[must_use]
    pub fn strongest(&self) -> Vec<f64> {
        let end = |parameter: &Parameter| {
            let Span(low, high) = parameter.spans[parameter.spans.len() - 1];
            if low.abs() > high.abs() { low } else { high }
        };
        self.parameters.iter().map(end).collect()
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use rand::SeedableRng;

    use super::*;

    #[test]
    fn names_differ_and_every_cause_changes_something() {
        let names: BTreeSet<_> = CAUSES.iter().map(|cause| cause.name).collect();
        assert_eq!(names.len(), CAUSES.len());
        assert_eq!(CAUSES.iter().filter(|cause| cause.is_known).count(), 40);
        for cause in CAUSES {
            let drawn = cause.draw(&mut ChaCha8Rng::seed_from_u64(1));
            assert_eq!(drawn.len(), cause.parameters.len());
            for values in [drawn, cause.strongest()] {
                let mut truth = Truth::nominal();
                (cause.apply)(&mut truth, Scope::All, &values);
                assert_ne!(truth, Truth::nominal(), "{}", cause.name);
            }
        }
    }

    #[test]
    fn a_scope_spares_the_other_wheels() {
        let scope = Scope::Axle(xt28_machine::Axle::Middle);
        for cause in CAUSES.iter().filter(|cause| cause.scopes != Scopes::Whole) {
            let (mut all, mut some) = (Truth::nominal(), Truth::nominal());
            (cause.apply)(&mut all, Scope::All, &cause.strongest());
            (cause.apply)(&mut some, scope, &cause.strongest());
            assert!(all != some && some != Truth::nominal(), "{}", cause.name);
        }
    }

    #[test]
    fn spans_run_upwards() {
        for Span(low, high) in CAUSES.iter().flat_map(|c| c.parameters).flat_map(|p| p.spans) {
            assert!(low < high);
        }
    }
}
