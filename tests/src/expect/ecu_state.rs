//! An ECU reaches a state within some periods of the first command that failed to come.

use serde::Deserialize;

use super::Evidence;
use crate::trace::{EcuState, Trace};
use crate::trouble::Trouble;
use crate::{Bound, Finding, Series};

/// After the commands to an ECU stop, it is in a state and stays there to the end.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReachesState {
    /// Whose status frame.
    pub ecu: Ecu,
    /// Which state.
    pub state: EcuState,
    /// Within how many periods of the first missing command.
    pub within_periods: u32,
}

/// One of the two ECUs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Ecu {
    /// Pendulum arms (SMS); listens to ArmTarget.
    Arms,
    /// Transmission and steering (DMS); listens to DriveTarget.
    Drive,
}

impl Ecu {
    /// For people.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Arms => "arm ECU",
            Self::Drive => "drive ECU",
        }
    }

    /// What its status frames say.
    pub(super) const fn states(self, trace: &Trace) -> &Series<EcuState> {
        match self {
            Self::Arms => &trace.arm_state,
            Self::Drive => &trace.drive_state,
        }
    }

    /// What its DM1 say.
    pub(super) const fn trouble(self, trace: &Trace) -> &Series<Trouble> {
        match self {
            Self::Arms => &trace.arm_trouble,
            Self::Drive => &trace.drive_trouble,
        }
    }
}

/// Commands and statuses both come every 10 ms (wire contract).
const PERIOD_S: f64 = 0.010;

impl ReachesState {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let trace = evidence.trace;
        let (name, last_command_s, states) = match self.ecu {
            Ecu::Arms => {
                let last = trace.stroke_target_m.last().map(|s| s.at_s);
                ("arm ECU", last, &trace.arm_state)
            }
            Ecu::Drive => {
                let last = trace.drive_target.last().map(|s| s.at_s);
                ("drive ECU", last, &trace.drive_state)
            }
        };
        let what = format!("{name} in {} after the first missing command", words(self.state));
        let wanted = Bound::AtMost(f64::from(self.within_periods));
        let Some(last_command_s) = last_command_s else {
            return vec![Finding::missing(what, wanted, "periods", "no command frame at all")];
        };
        let finding = match self.periods_until_lasting(states, last_command_s + PERIOD_S) {
            Ok(periods) => Finding::of(what, periods, wanted, "periods")
                .noting(format!("last command at {last_command_s:.3} s")),
            Err(note) => Finding::missing(what, wanted, "periods", note),
        };
        vec![finding]
    }

    /// Whole periods from `missing_s` to the status frame from which on the state lasts. A status
    /// says what was true in its tick, so the time is rounded to ticks: the frame's own way over
    /// the bus is not the ECU's.
    fn periods_until_lasting(
        &self,
        states: &Series<EcuState>,
        missing_s: f64,
    ) -> Result<f64, String> {
        let after = states.samples();
        let after = &after[after.partition_point(|s| s.at_s < missing_s)..];
        let Some(last) = after.last() else {
            return Err("no status frame after the last command".to_owned());
        };
        if last.value != self.state {
            return Err(format!("in {} at the end", words(last.value)));
        }
        let reached =
            after.iter().rposition(|s| s.value != self.state).map_or(0, |other| other + 1);
        Ok(((after[reached].at_s - missing_s) / PERIOD_S).round())
    }
}

pub(super) const fn words(state: EcuState) -> &'static str {
    match state {
        EcuState::Init => "init",
        EcuState::Standby => "standby",
        EcuState::Active => "active",
        EcuState::SafeStop => "safe stop",
        EcuState::Fault => "fault",
    }
}
