//! What is said while a run goes on: each change of the safety kernel's phase, and what keeps it from arming.

use core::time::Duration;

use gateway::{Phase, Reason, Status};

/// What stands against arming for so long is said; it comes and goes while everything starts.
const WAITED: Duration = Duration::from_secs(2);

/// What has been said.
#[derive(Debug)]
pub(crate) struct News {
    phase: Phase,
    /// What stands against arming, since when, and whether that was said.
    waits: Option<(Reason, Duration, bool)>,
}

impl News {
    /// Nothing was: disarmed.
    pub(crate) const fn new() -> Self {
        Self { phase: Phase::Disarmed, waits: None }
    }

    /// What is new at `now`.
    pub(crate) fn of(&mut self, now: Duration, status: &Status) -> Option<String> {
        let (was, is) = (self.phase, status.phase);
        self.phase = is;
        let same = core::mem::discriminant(&was) == core::mem::discriminant(&is);
        // Another reason is another stop; a handshake counts on and is the same.
        if same && !matches!(is, Phase::Blocked(_) if was != is) {
            return self.waiting(now, status);
        }
        self.waits = None;
        Some(match is {
            Phase::Disarmed => "disarmed".to_owned(),
            Phase::Handshake { .. } => "handshake with both ECUs".to_owned(),
            Phase::Armed => "armed".to_owned(),
            Phase::Blocked(reason) => format!("stopped: {}", status.told(reason)),
        })
    }

    /// What has stood against arming for a while, once.
    fn waiting(&mut self, now: Duration, status: &Status) -> Option<String> {
        let reason = status.blocked.filter(|reason| {
            matches!(status.phase, Phase::Disarmed) && *reason != Reason::Disarmed
        });
        let Some(reason) = reason else {
            self.waits = None;
            return None;
        };
        match &mut self.waits {
            Some((waited_for, since, said)) if *waited_for == reason => {
                let is_news = !*said && now.saturating_sub(*since) >= WAITED;
                *said |= is_news;
                is_news.then(|| format!("not armed yet: {}", status.told(reason)))
            }
            other => {
                *other = Some((reason, now, false));
                None
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use gateway::policy::Hold;
    use gateway::{Gateway, GatewayConfig};
    use xt28_machine::Machine;

    use super::*;

    fn status(phase: Phase, blocked: Reason) -> Status {
        let machine = Machine::xt28();
        let gateway = Gateway::new(&machine, GatewayConfig::new(&machine), Box::new(Hold));
        Status { phase, blocked: Some(blocked), ..gateway.status() }
    }

    fn said(news: &mut News, seconds: u64, phase: Phase, blocked: Reason) -> Option<String> {
        news.of(Duration::from_secs(seconds), &status(phase, blocked))
    }

    #[test]
    fn what_keeps_it_from_arming_is_said_once_it_lasts() {
        let mut news = News::new();
        let wait = |news: &mut News, seconds, reason| said(news, seconds, Phase::Disarmed, reason);
        assert_eq!(wait(&mut news, 0, Reason::NotAlone), None);
        assert_eq!(wait(&mut news, 1, Reason::BusFault), None);
        assert_eq!(wait(&mut news, 2, Reason::BusFault), None);
        assert_eq!(wait(&mut news, 3, Reason::BusFault).unwrap(), "not armed yet: bus fault");
        assert_eq!(wait(&mut news, 9, Reason::BusFault), None);
    }

    #[test]
    fn another_stop_is_said_and_the_same_is_not() {
        let mut news = News::new();
        let stop = |news: &mut News, reason| said(news, 1, Phase::Blocked(reason), reason);
        assert_eq!(stop(&mut news, Reason::Roll).unwrap(), "stopped: roll above its limit");
        assert_eq!(stop(&mut news, Reason::Roll), None);
        let stopped = stop(&mut news, Reason::EmergencyStop).unwrap();
        assert_eq!(stopped, "stopped: emergency stop");
    }
}
