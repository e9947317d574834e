//! Commands for the arms: two messages, one demand.

use xt28_dbc::Frame;
use xt28_dbc::messages::{ArmTarget, ArmTargetMode, ArmValve};
use xt28_machine::{PerWheel, SimTime};

use crate::Refusal;
use crate::command_stream::CommandStream;
use crate::life::{COMMAND_DEADLINE, Request};

/// Raw 255 at 2 mm a bit holds the arm.
const HOLD_MM: f64 = 510.0;

/// What the arms shall do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ArmDemand {
    /// Nothing.
    Off,
    /// Level the machine at this mean stroke, m; at its own where none is asked for.
    Automatic(Option<f64>),
    /// Go to these strokes, mm; `None` holds the arm.
    Position(PerWheel<Option<f64>>),
    /// Open the valves this far, + extends.
    Valve(PerWheel<f64>),
}

impl ArmDemand {
    pub(crate) const fn request(&self) -> Request {
        match self {
            Self::Off => Request::Rest,
            Self::Automatic(_) | Self::Position(_) | Self::Valve(_) => Request::Move,
        }
    }
}

#[derive(Clone, Copy, Debug)]
enum Target {
    Off,
    Automatic(Option<f64>),
    Position(PerWheel<Option<f64>>),
    /// Openings come in frames of their own, since then.
    Valve {
        since: SimTime,
    },
}

/// Both command streams of the arms.
#[derive(Clone, Debug)]
pub(crate) struct ArmCommands {
    stroke_max_mm: f64,
    target: CommandStream<Target>,
    valve: CommandStream<PerWheel<f64>>,
}

impl ArmCommands {
    pub(crate) fn new(stroke_max_m: f64) -> Self {
        Self {
            stroke_max_mm: stroke_max_m * 1e3,
            target: CommandStream::default(),
            valve: CommandStream::default(),
        }
    }

    /// An `ArmTarget` frame.
    pub(crate) fn on_target(&mut self, now: SimTime, frame: &Frame) -> Result<(), Refusal> {
        let target = ArmTarget::decode(frame)?;
        let content = self.content(now, &target);
        self.target.offer(now, target.counter, content)
    }

    /// An `ArmValve` frame.
    pub(crate) fn on_valve(&mut self, now: SimTime, frame: &Frame) -> Result<(), Refusal> {
        let v = ArmValve::decode(frame)?;
        let percent =
            [v.fr_percent, v.fl_percent, v.mr_percent, v.ml_percent, v.br_percent, v.bl_percent];
        self.valve.offer(now, v.counter, Ok(PerWheel(percent.map(|p| p * 1e-2))))
    }

    /// What is demanded now; `None` once a needed frame is past its deadline.
    pub(crate) fn fresh(&self, now: SimTime) -> Option<ArmDemand> {
        match self.target.fresh(now)? {
            Target::Off => Some(ArmDemand::Off),
            Target::Automatic(height_m) => Some(ArmDemand::Automatic(height_m)),
            Target::Position(target_mm) => Some(ArmDemand::Position(target_mm)),
            Target::Valve { since } => match self.valve.fresh(now) {
                Some(opening) => Some(ArmDemand::Valve(opening)),
                // The first openings may come a little after the mode that asks for them.
                None if now.since(since) <= COMMAND_DEADLINE => {
                    Some(ArmDemand::Valve(PerWheel::splat(0.0)))
                }
                None => None,
            },
        }
    }

    /// `ArmTarget` frames taken since the stream was last lost.
    pub(crate) const fn frames(&self) -> u32 {
        self.target.frames()
    }

    /// Counter of the last `ArmTarget` taken.
    pub(crate) const fn accepted(&self) -> u8 {
        self.target.accepted()
    }

    fn content(&self, now: SimTime, t: &ArmTarget) -> Result<Target, Refusal> {
        match t.mode {
            ArmTargetMode::Off => Ok(Target::Off),
            ArmTargetMode::ManualValve => Ok(match self.target.fresh(now) {
                Some(valve @ Target::Valve { .. }) => valve,
                _ => Target::Valve { since: now },
            }),
            ArmTargetMode::Automatic => self.strokes_mm(t).map(|mm| Target::Automatic(mean_m(&mm))),
            ArmTargetMode::ManualPosition => self.strokes_mm(t).map(Target::Position),
        }
    }

    /// The six targets, mm; `None` holds.
    fn strokes_mm(&self, t: &ArmTarget) -> Result<PerWheel<Option<f64>>, Refusal> {
        let mm = PerWheel([t.fr_mm, t.fl_mm, t.mr_mm, t.ml_mm, t.br_mm, t.bl_mm]);
        let target_mm = mm.map(|mm| (mm < HOLD_MM).then_some(mm));
        let reachable = |mm: &Option<f64>| mm.is_none_or(|mm| mm <= self.stroke_max_mm);
        if target_mm.0.iter().all(reachable) { Ok(target_mm) } else { Err(Refusal::Range) }
    }
}

/// Mean of the strokes that are asked for, m: in automatic mode the height. (Ours: the contract has
/// no field of its own for it.)
fn mean_m(target_mm: &PerWheel<Option<f64>>) -> Option<f64> {
    let (mut sum_mm, mut count) = (0.0, 0.0);
    for mm in target_mm.0.iter().flatten() {
        (sum_mm, count) = (sum_mm + mm, count + 1.0);
    }
    (count > 0.0).then(|| sum_mm / count * 1e-3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_height_is_the_mean_of_the_strokes_that_are_asked_for() {
        assert_eq!(mean_m(&PerWheel::splat(None)), None);
        let two = PerWheel([Some(100.0), None, None, Some(300.0), None, None]);
        assert_eq!(mean_m(&two), Some(0.2));
    }
}
