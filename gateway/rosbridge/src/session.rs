//! One client: what it subscribed to, and how much it wants to be told.

use std::net::SocketAddr;
use std::time::Duration;

use serde_json::Value;

use crate::op::Level;

/// Most subscriptions of one client.
pub(crate) const SUBSCRIPTIONS_MAX: usize = 64;

/// What a client asked for and has not taken back.
#[derive(Debug)]
pub(crate) struct Session {
    pub(crate) address: SocketAddr,
    pub(crate) level: Level,
    pub(crate) has_published: bool,
    subscriptions: Vec<Subscription>,
}

/// One request for a topic.
#[derive(Debug)]
struct Subscription {
    id: Option<Value>,
    /// The topic's name in the catalogue.
    topic: &'static str,
    /// The name as the client wrote it, by which it will know the messages.
    spelled: String,
    throttle: Duration,
    /// When a message of the topic by this spelling was sent last.
    sent: Option<Duration>,
}

impl Session {
    pub(crate) const fn new(address: SocketAddr) -> Self {
        Self { address, level: Level::Error, has_published: false, subscriptions: Vec::new() }
    }

    /// Adds a subscription; one of the same identifier and topic is replaced. False if there are too many.
    pub(crate) fn subscribe(
        &mut self,
        id: Option<Value>,
        topic: &'static str,
        spelled: String,
        throttle: Duration,
    ) -> bool {
        self.subscriptions.retain(|old| old.id != id || old.spelled != spelled);
        let room = self.subscriptions.len() < SUBSCRIPTIONS_MAX;
        if room {
            let sent = None;
            self.subscriptions.push(Subscription { id, topic, spelled, throttle, sent });
        }
        room
    }

    /// Takes back a subscription, or without an identifier all of the topic.
    pub(crate) fn unsubscribe(&mut self, id: Option<&Value>, topic: &str) {
        self.subscriptions
            .retain(|old| old.topic != topic || id.is_some_and(|id| old.id.as_ref() != Some(id)));
    }

    /// The names by which the client gets a message that `topic` has at `at`: each once, as often as the most
    /// eager of its subscriptions wants it.
    pub(crate) fn due(&mut self, topic: &str, at: Duration) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for old in self.subscriptions.iter_mut().filter(|old| old.topic == topic) {
            // A clock that was set back throttles nobody for long.
            let soon = old.sent.is_some_and(|sent| sent <= at && at - sent < old.throttle);
            if !soon && !names.contains(&old.spelled) {
                names.push(old.spelled.clone());
            }
        }
        for old in self.subscriptions.iter_mut().filter(|old| old.topic == topic) {
            if names.contains(&old.spelled) {
                old.sent = Some(at);
            }
        }
        names
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: fn(u64) -> Duration = Duration::from_millis;

    #[test]
    fn a_throttled_topic_comes_no_more_often_than_the_most_eager_subscription_wants() {
        let mut session = Session::new(SocketAddr::from(([127, 0, 0, 1], 1)));
        assert!(session.subscribe(Some(1.into()), "/a", "a".to_owned(), MS(300)));
        assert!(session.subscribe(Some(2.into()), "/a", "a".to_owned(), MS(100)));
        assert!(session.subscribe(Some(3.into()), "/b", "/b".to_owned(), MS(0)));
        let heard = |session: &mut Session| {
            (0..10).filter(|n| !session.due("/a", MS(50 * n)).is_empty()).count()
        };
        assert_eq!(heard(&mut session), 5);
        session.unsubscribe(Some(&2.into()), "/a");
        assert_eq!((0..10).filter(|n| !session.due("/a", MS(900 + 50 * n)).is_empty()).count(), 2);
        session.unsubscribe(None, "/a");
        assert!(session.due("/a", MS(9000)).is_empty());
        assert_eq!(session.due("/b", MS(9000)), ["/b"]);
    }

    #[test]
    fn subscriptions_have_an_end_and_one_asked_for_again_is_no_second() {
        let mut session = Session::new(SocketAddr::from(([127, 0, 0, 1], 1)));
        let mut ask = |id: u64| session.subscribe(Some(id.into()), "/a", "/a".to_owned(), MS(0));
        assert!((0..1000).all(|_| ask(0)));
        assert!((1..64).all(&mut ask));
        assert!(!ask(64));
    }
}
