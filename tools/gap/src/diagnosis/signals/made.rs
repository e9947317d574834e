//! What generators make of a run once, whatever they believe of its machine.

use std::sync::OnceLock;

use xt28_machine::PerWheel;

use super::{Samples, Signals};
use crate::diagnosis::instant::Instant;
use crate::diagnosis::kinematics::Kinematics;
use crate::diagnosis::wheel_torques::WheelTorques;

/// How tyres are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::diagnosis) enum Make {
    /// Their feet stay where they are.
    Firm,
    /// They creep along the ground in proportion to what they push it with.
    Creeping,
}

/// Made of a run's samples when first asked for.
#[derive(Debug, Default)]
pub(super) struct Made {
    instants: OnceLock<Vec<Instant>>,
    antenna_leans_m: OnceLock<Vec<[f64; 2]>>,
    kinematics: OnceLock<Vec<Kinematics>>,
    scrubs: [OnceLock<(f64, Vec<[f64; 2]>)>; 2],
    yaw_rates: OnceLock<Vec<Option<f64>>>,
    wheel_torques: OnceLock<WheelTorques>,
    travels_m_s: OnceLock<Samples>,
    off_scale: OnceLock<PerWheel<Vec<bool>>>,
}

/// A copy begins with nothing made: who copies a run's signals changes them, or asks of another machine.
impl Clone for Made {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Signals {
    /// The instants at which the stance is judged. They need of a machine only where its axles and
    /// joints are, how large its wheels are and which pump drives which; no knob turns those.
    pub(in crate::diagnosis) fn instants(
        &self,
        first: impl FnOnce() -> Vec<Instant>,
    ) -> &[Instant] {
        self.made.instants.get_or_init(first)
    }

    /// Where the antenna is for the machine's leaning. A machine file says that, and no knob.
    pub(in crate::diagnosis) fn antenna_leans_m(
        &self,
        first: impl FnOnce() -> Vec<[f64; 2]>,
    ) -> &[[f64; 2]] {
        self.made.antenna_leans_m.get_or_init(first)
    }

    /// How wheels move with arms and frames, at each instant at which rolling is judged.
    pub(in crate::diagnosis) fn kinematics(
        &self,
        first: impl FnOnce() -> Vec<Kinematics>,
    ) -> &[Kinematics] {
        self.made.kinematics.get_or_init(first)
    }

    /// How the tyres of a make scrub as joints turn. They need of a machine only its axles, joints and radius, and
    /// how fast they let go, 1/s: none if what was made is of others.
    pub(in crate::diagnosis) fn scrubs(
        &self,
        make: Make,
        lets_go_per_s: f64,
        first: impl FnOnce() -> Vec<[f64; 2]>,
    ) -> Option<&[[f64; 2]]> {
        let (of_per_s, scrubs) =
            self.made.scrubs[make as usize].get_or_init(|| (lets_go_per_s, first()));
        (*of_per_s == lets_go_per_s).then_some(scrubs)
    }

    /// Rates at which the receiver says that the machine turns, rad/s, at each residual; none where it does not. No
    /// machine file, knob or effect changes what was said.
    pub(in crate::diagnosis) fn yaw_rates(
        &self,
        first: impl FnOnce() -> Vec<Option<f64>>,
    ) -> &[Option<f64>] {
        self.made.yaw_rates.get_or_init(first)
    }

    /// What the motors turn the wheels with.
    pub(in crate::diagnosis) fn wheel_torques(
        &self,
        first: impl FnOnce() -> WheelTorques,
    ) -> &WheelTorques {
        self.made.wheel_torques.get_or_init(first)
    }

    /// Speed of the front axle that sound wheels say which hold on to the ground, m/s. That needs of a machine only its
    /// axles, joints and wheels.
    pub(in crate::diagnosis) fn travels_m_s(&self, first: impl FnOnce() -> Samples) -> &Samples {
        self.made.travels_m_s.get_or_init(first)
    }

    /// Where nobody knows the pressures of a cylinder. No knob changes what a frame tells at most.
    pub(in crate::diagnosis) fn off_scale(
        &self,
        first: impl FnOnce() -> PerWheel<Vec<bool>>,
    ) -> &PerWheel<Vec<bool>> {
        self.made.off_scale.get_or_init(first)
    }
}
