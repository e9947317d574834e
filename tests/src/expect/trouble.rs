//! An ECU reports a trouble code on the bus.

use serde::Deserialize;

use super::Evidence;
use super::ecu_state::Ecu;
use crate::{Bound, Finding};

/// A DM1 of an ECU has this code soon after an instant, and none had it before.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReportsTrouble {
    /// Who reports.
    pub ecu: Ecu,
    /// Suspect parameter number.
    pub spn: u32,
    /// Failure mode.
    pub fmi: u8,
    /// When the trouble begins, s.
    pub from_s: f64,
    /// Within how long it is reported, s.
    pub within_s: f64,
}

impl ReportsTrouble {
    pub(super) fn judge(&self, evidence: &Evidence<'_>) -> Vec<Finding> {
        let Self { spn, fmi, from_s, .. } = *self;
        let what = format!("{} reports SPN {spn} FMI {fmi}, after its cause", self.ecu.name());
        let wanted = Bound::Between(0.0, self.within_s);
        let reports = self.ecu.trouble(evidence.trace).samples();
        let first = reports.iter().find(|report| report.value.codes.contains(&(spn, fmi)));
        vec![match first {
            Some(report) => Finding::of(what, report.at_s - from_s, wanted, "s"),
            None => {
                let note = format!("not in {} DM1", reports.len());
                Finding::missing(what, wanted, "s", note)
            }
        }]
    }
}
