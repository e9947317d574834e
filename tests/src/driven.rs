//! What a gateway says of its run: when it armed, what stopped it, and what came of its policy.

use std::fmt;

use gateway::{Outcome, Status};
use serde::{Deserialize, Serialize};

/// A gateway's own account, by the names of its `--json`.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Driven {
    /// When it was armed last, s; none if it never was.
    pub armed_at_s: Option<f64>,
    /// The first hazard that stopped it.
    pub safety_stop: Option<SafetyStop>,
    /// How its policy's task stood: endless, running, reached or failed.
    pub outcome: String,
    /// Why the policy failed, or what stood against arming.
    pub reason: Option<String>,
}

/// What stopped a gateway that was armed or arming.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct SafetyStop {
    /// When, s.
    pub at_s: f64,
    /// Why.
    pub reason: String,
}

impl Driven {
    /// From what a gateway says of itself.
    #[must_use]
    pub fn new(status: &Status) -> Self {
        let failed = match &status.outcome {
            Outcome::Failed(why) => Some(why.clone()),
            Outcome::Endless | Outcome::Running | Outcome::Reached => None,
        };
        let unarmed = status.blocked.filter(|_| status.armed_at.is_none());
        let safety_stop = status
            .stops
            .first
            .map(|(at, reason)| SafetyStop { at_s: at.as_secs_f64(), reason: reason.to_string() });
        Self {
            armed_at_s: status.armed_at.map(|at| at.as_secs_f64()),
            safety_stop,
            outcome: status.outcome.name().to_owned(),
            reason: failed.or_else(|| unarmed.map(|reason| reason.to_string())),
        }
    }
}

/// One line: `armed at 0.32 s, policy reached`.
impl fmt::Display for Driven {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let stopped_at_s = self.safety_stop.as_ref().map(|stop| stop.at_s);
        // Armed again after the first stop.
        let again = self.armed_at_s > stopped_at_s && stopped_at_s.is_some();
        let [last, first] = if again { ["last ", "first "] } else { ["", ""] };
        match self.armed_at_s {
            Some(at_s) => write!(f, "armed {last}at {at_s:.2} s")?,
            None => f.write_str("never armed")?,
        }
        if let Some(SafetyStop { at_s, reason }) = &self.safety_stop {
            write!(f, ", {first}safety stop at {at_s:.2} s: {reason}")?;
        }
        write!(f, ", policy {}", self.outcome)?;
        self.reason.as_ref().map_or(Ok(()), |reason| write!(f, ": {reason}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gateways_json_reads_as_its_account() {
        let json = r#"{"pass": false, "reason": "no forward path", "outcome": "failed",
                       "armed_at_s": 0.31, "safety_stop": {"at_s": 2.5, "reason": "roll"},
                       "seconds": 3.0}"#;
        let driven: Driven = serde_json::from_str(json).unwrap();
        let line = "armed at 0.31 s, safety stop at 2.50 s: roll, policy failed: no forward path";
        assert_eq!(driven.to_string(), line);
        let again = Driven { armed_at_s: Some(5.0), ..driven.clone() }.to_string();
        assert!(again.starts_with("armed last at 5.00 s, first safety stop at 2.50 s"), "{again}");
        assert_eq!(serde_json::to_value(&driven).unwrap()["safety_stop"]["at_s"], 2.5);
    }
}
