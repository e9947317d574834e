//! What clients were refused, for whoever runs the gateway: each once, and no flood of them.

use core::time::Duration;

use xt28_machine::SimTime;

/// How long the same complaint is not repeated.
const AGAIN_AFTER: Duration = Duration::from_secs(5);
/// How many others are told within that time.
const OTHERS_MAX: usize = 8;

/// What was told lately.
#[derive(Debug, Default)]
pub(super) struct Complaints(Vec<(SimTime, String)>);

impl Complaints {
    /// Whether it is to be told, which it then was.
    pub(super) fn admit(&mut self, now: SimTime, why: &str) -> bool {
        self.0.retain(|(at, _)| now.since(*at) < AGAIN_AFTER);
        let told = self.0.len() < OTHERS_MAX && self.0.iter().all(|(_, other)| other != why);
        if told {
            self.0.push((now, why.to_owned()));
        }
        told
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flood_is_told_in_drops() {
        let mut complaints = Complaints::default();
        let at = SimTime::from_millis;
        assert!(complaints.admit(at(0), "a") && complaints.admit(at(10), "b"));
        assert!(!complaints.admit(at(4990), "a") && complaints.admit(at(5000), "a"));
        let told = (0..100).filter(|n| complaints.admit(at(5010), &n.to_string())).count();
        assert_eq!(told, OTHERS_MAX - 1);
    }
}
