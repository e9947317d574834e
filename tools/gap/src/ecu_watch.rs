//! Whether our ECUs followed the commands at all: an ECU in safe stop makes every comparison void.

use xt28_dbc::Frame;
use xt28_dbc::messages::{ArmStatus, ArmStatusState, DriveStatus, DriveStatusState};

/// When each ECU first left its work, and for how many ticks.
#[derive(Debug, Default)]
pub(crate) struct EcuWatch {
    arm: Absence,
    drive: Absence,
}

#[derive(Debug, Default)]
struct Absence {
    since_s: Option<f64>,
    ticks: u32,
}

impl EcuWatch {
    /// Takes in a frame that an ECU sent at `at_s`.
    pub(crate) fn see(&mut self, at_s: f64, frame: &Frame) {
        if let Ok(status) = ArmStatus::decode(frame) {
            use ArmStatusState::{Fault, SafeStop};
            self.arm.note(at_s, matches!(status.state, SafeStop | Fault));
        } else if let Ok(status) = DriveStatus::decode(frame) {
            use DriveStatusState::{Fault, SafeStop};
            self.drive.note(at_s, matches!(status.state, SafeStop | Fault));
        }
    }

    /// One line for each ECU that did not follow.
    pub(crate) fn notes(&self) -> Vec<String> {
        let note = |name: &str, absence: &Absence| {
            let (since_s, s) = (absence.since_s?, f64::from(absence.ticks) * 0.01);
            Some(format!(
                "our {name} ECU stood in safe stop or fault for {s:.2} s, first at {since_s:.2} s, as its commands stopped coming or came wrong"
            ))
        };
        note("arm", &self.arm).into_iter().chain(note("drive", &self.drive)).collect()
    }
}

impl Absence {
    fn note(&mut self, at_s: f64, away: bool) {
        if away {
            self.since_s.get_or_insert(at_s);
            self.ticks += 1;
        }
    }
}
