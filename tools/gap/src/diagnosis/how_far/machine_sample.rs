//! What is compared of the whole machine: ten samples a second of everything that it shows.

use std::ops::Range;

use xt28_machine::Wheel;

use crate::Channel;
use crate::diagnosis::generator::is_off_scale;
use crate::diagnosis::signals::{DT_S, Signals};

/// Ticks of the log's clock, 10 ms each, from one sample of the whole machine to the next.
pub(super) const TICKS_PER_SAMPLE: usize = 10;
/// Numbers in a sample.
pub(super) const WIDTH: usize = 36;
/// A fix older than this says nothing of now, s: the receiver says eight a second.
const FIX_LIFE_S: f64 = 0.15;

/// One sample, SI; `NaN` where nothing is known.
pub(super) type MachineSample = [f64; WIDTH];

/// A signal of the whole machine: what shrinks, and by how much, is averaged over these.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// Strokes as read.
    Stroke,
    /// Loads of the cylinders, from their pressures as read.
    Load,
    /// Joint angles.
    Joint,
    /// Wheel speeds as read.
    WheelSpeed,
    /// Roll of the front frame.
    Roll,
    /// Pitch of the front frame.
    Pitch,
    /// The receiver's fixes.
    Position,
    /// Openings asked of the arms' valves.
    Opening,
    /// Openings asked of the steering valves.
    SteerOpening,
    /// Pump pressures.
    PumpPressure,
}

/// How far ahead the machine is foretold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Horizon {
    /// 5 s, from measured states.
    FiveSeconds,
    /// The whole run, from the first measured state.
    Run,
}

impl Quantity {
    /// All there are, in the order of a sample.
    pub const ALL: [Self; 10] = [
        Self::Stroke,
        Self::Load,
        Self::Joint,
        Self::WheelSpeed,
        Self::Roll,
        Self::Pitch,
        Self::Position,
        Self::Opening,
        Self::SteerOpening,
        Self::PumpPressure,
    ];

    /// Where its numbers are in a sample.
    pub(super) const fn columns(self) -> Range<usize> {
        match self {
            Self::Stroke => 0..6,
            Self::Load => 6..12,
            Self::Joint => 12..14,
            Self::WheelSpeed => 14..20,
            Self::Roll => 20..21,
            Self::Pitch => 21..22,
            Self::Position => 22..24,
            Self::Opening => 24..30,
            Self::SteerOpening => 30..32,
            Self::PumpPressure => 32..36,
        }
    }

    /// Its numbers, each with the channel that shows it; openings have two currents each, and none.
    pub(super) const fn of(channel: Channel) -> Option<usize> {
        Some(match channel {
            Channel::Stroke(w) => Self::Stroke.columns().start + w.index(),
            Channel::CylinderLoad(w) => Self::Load.columns().start + w.index(),
            Channel::FrontJoint => Self::Joint.columns().start,
            Channel::RearJoint => Self::Joint.columns().start + 1,
            Channel::WheelSpeed(w) => Self::WheelSpeed.columns().start + w.index(),
            Channel::Roll => Self::Roll.columns().start,
            Channel::Pitch => Self::Pitch.columns().start,
            Channel::PumpPressure(side) => Self::PumpPressure.columns().start + side as usize,
            _ => return None,
        })
    }

    /// How far two independent models of one sound machine lie apart, root mean square, SI. Measured as
    /// `docs/diagnosis.md` says.
    #[must_use]
    pub const fn floor(self, horizon: Horizon) -> f64 {
        match (self, horizon) {
            (Self::Stroke, _) => 0.55e-3,
            (Self::Load, _) => 0.9e3,
            (Self::Joint, _) => 2.7e-3,
            (Self::WheelSpeed, _) => 0.025,
            (Self::Roll, _) => 1.2e-3,
            (Self::Pitch, _) => 1.6e-3,
            (Self::Position, Horizon::FiveSeconds) => 0.02,
            (Self::Position, Horizon::Run) => 0.05,
            (Self::Opening, _) => 2.0e-3,
            (Self::SteerOpening, _) => 0.021,
            (Self::PumpPressure, _) => 4.0e5,
        }
    }
}

/// Floors of all numbers of a sample.
pub(super) fn floors(horizon: Horizon) -> MachineSample {
    let mut sample = [0.0; WIDTH];
    for quantity in Quantity::ALL {
        sample[quantity.columns()].fill(quantity.floor(horizon));
    }
    sample
}

/// What was measured, sample by sample.
pub(super) fn measured(s: &Signals) -> Vec<MachineSample> {
    (0..s.len).step_by(TICKS_PER_SAMPLE).map(|i| sample(s, i)).collect()
}

fn sample(s: &Signals, i: usize) -> MachineSample {
    let mut sample = [f64::NAN; WIDTH];
    for w in Wheel::ALL {
        let k = w.index();
        sample[Quantity::Stroke.columns().start + k] = s.stroke_reading_m[w][i];
        let is_read = !is_off_scale(s, w, i);
        let load_n = if is_read { s.cylinder_load_n[w][i] } else { f64::NAN };
        sample[Quantity::Load.columns().start + k] = load_n;
        sample[Quantity::WheelSpeed.columns().start + k] = s.wheel_speed_rad_s[w][i];
        sample[Quantity::Opening.columns().start + k] = s.opening[w][i];
    }
    for k in 0..2 {
        sample[Quantity::Joint.columns().start + k] = s.joint_rad[k][i];
        sample[Quantity::SteerOpening.columns().start + k] = s.steer_opening[k][i];
    }
    sample[Quantity::Roll.columns().start] = s.roll_rad[i];
    sample[Quantity::Pitch.columns().start] = s.pitch_rad[i];
    for side in 0..4 {
        sample[Quantity::PumpPressure.columns().start + side] = s.pump_pressure_pa[side][i];
    }
    if let Some([_, east, north]) = fix(s, i) {
        sample[Quantity::Position.columns()].copy_from_slice(&[east, north]);
    }
    sample
}

/// The fix that is in force at sample `i` of the log's clock: its instant, s, and place, m.
#[allow(clippy::cast_precision_loss)]
pub(super) fn fix(s: &Signals, i: usize) -> Option<[f64; 3]> {
    let now_s = i as f64 * DT_S;
    let after = s.fixes.partition_point(|fix| fix[0] <= now_s);
    let fix = s.fixes[after.checked_sub(1)?];
    (now_s - fix[0] < FIX_LIFE_S).then_some(fix)
}
