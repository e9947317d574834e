//! What the headline names, and so what one looks for in the picture and the table.

use xt28_machine::{PerWheel, Wheel};
use xt28_sim::effects::{Block, Scope};

use super::headline::{BESIDE_ABOVE, spot_of, told_scopes};
use crate::diagnosis::{Cause, Diagnosis, Spot, Verdict};

/// Parts of the picture that a verdict names.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Named {
    pub(super) wheels: PerWheel<bool>,
    pub(super) joints: bool,
    pub(super) drive: bool,
    pub(super) frames: bool,
    pub(super) bus: bool,
}

impl Named {
    /// By the causes or the signal in the headline of `diagnosis`.
    pub(super) fn of(diagnosis: &Diagnosis) -> Self {
        let mut named = Self::default();
        for cause in causes(diagnosis) {
            match &told_scopes(cause)[..] {
                _ if !cause.effect.has_scope() => named.part(cause.effect.block),
                [] => named.at(cause.scope),
                [one, other] => [*one, *other].into_iter().for_each(|scope| named.at(scope)),
                [first, ..] => named.at(*first),
            }
        }
        if let Some(spot) = signal(diagnosis) {
            if spot.has_wheels() { named.at(spot.scope) } else { named.part(spot.block) }
        }
        named
    }

    /// Whether it names nothing that has a place in the picture.
    pub(super) fn is_none(&self) -> bool {
        *self == Self::default()
    }

    fn at(&mut self, scope: Scope) {
        for wheel in Wheel::ALL.into_iter().filter(|wheel| scope.contains(*wheel)) {
            self.wheels[wheel] = true;
        }
    }

    fn part(&mut self, block: Block) {
        match block {
            Block::Arms => self.at(Scope::All),
            Block::Steering => self.joints = true,
            Block::Drive => self.drive = true,
            // What has no wheel of the sensors sits on a frame.
            Block::Tyre | Block::Payload | Block::Ground | Block::Sensor => self.frames = true,
            Block::Bus => self.bus = true,
        }
    }
}

/// The signal that the headline names; `None` where it names none.
pub(super) fn signal(diagnosis: &Diagnosis) -> Option<&Spot> {
    let is_unknown = diagnosis.verdict == Verdict::Unknown;
    let is_told = is_unknown || diagnosis.probability_unknown > BESIDE_ABOVE;
    spot_of(diagnosis).filter(|_| is_told)
}

/// The causes that the headline names.
fn causes(diagnosis: &Diagnosis) -> Vec<&Cause> {
    let stood: Vec<&Cause> = diagnosis.stood_by().collect();
    match diagnosis.verdict {
        Verdict::Effect if stood.is_empty() => diagnosis.causes.iter().take(2).collect(),
        Verdict::Effect => stood,
        Verdict::None | Verdict::Unknown => {
            let likely = |cause: &&Cause| cause.probability > BESIDE_ABOVE;
            diagnosis.causes.first().filter(likely).into_iter().collect()
        }
    }
}
