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
    /// Whether it is to be told.
    pub(super) fn is_news(&mut self, now: SimTime, why: &str) -> bool {
        self.0.retain(|(at, _)| now.since(*at) < AGAIN_AFTER);
        let news = self.0.len() < OTHERS_MAX && self.0.iter().all(|(_, told)| told != why);
        if news {
            self.0.push((now, why.to_owned()));
        }
        news
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flood_is_told_in_drops() {
        let mut complaints = Complaints::default();
        let at = SimTime::from_millis;
        assert!(complaints.is_news(at(0), "a") && complaints.is_news(at(10), "b"));
        assert!(!complaints.is_news(at(4990), "a") && complaints.is_news(at(5000), "a"));
        let told = (0..100).filter(|n| complaints.is_news(at(5010), &n.to_string())).count();
        assert_eq!(told, OTHERS_MAX - 1);
    }
}
