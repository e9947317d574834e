//! Events that wait for the owner: each client's in their order, all clients in turn, calls first.
//!
//! So a loud client delays nobody but itself, and a call to a service is heard before what else was said.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use crate::bridge::{ClientId, Event};

/// Most events of one client that wait, beside its calls.
const EVENTS_MAX: usize = 16;
/// Most calls of one client that wait.
const CALLS_MAX: usize = 8;
/// Most clients that have something waiting: also those are told apart that come and go.
const CLIENTS_MAX: usize = 64;

/// A queue between the thread and the owner.
#[derive(Debug, Default)]
pub(crate) struct Queue {
    waiting: Mutex<Waiting>,
    news: Condvar,
}

#[derive(Debug, Default)]
struct Waiting {
    calls: Line,
    events: Line,
}

/// What waits, by client.
#[derive(Debug, Default)]
struct Line {
    of: BTreeMap<ClientId, VecDeque<Event>>,
    /// Who had his turn last.
    last: Option<ClientId>,
}

impl Line {
    fn push(&mut self, client: ClientId, event: Event, most: usize) -> bool {
        if self.of.len() >= CLIENTS_MAX && !self.of.contains_key(&client) {
            return false;
        }
        let own = self.of.entry(client).or_default();
        let room = own.len() < most || matches!(event, Event::Left(_));
        if room {
            own.push_back(event);
        }
        room
    }

    /// The oldest event of the client whose turn it is.
    fn pop(&mut self) -> Option<Event> {
        let beyond = |last| self.of.range(last..).map(|(client, _)| *client).find(|c| *c != last);
        let client = self.last.and_then(beyond).or_else(|| self.of.keys().next().copied())?;
        self.last = Some(client);
        let own = self.of.get_mut(&client)?;
        let event = own.pop_front();
        if own.is_empty() {
            self.of.remove(&client);
        }
        event
    }
}

impl Queue {
    /// Adds an event; false, and nothing is added, where its client or all together have too many waiting. That one
    /// has left is taken however much it said before.
    pub(crate) fn push(&self, event: Event) -> bool {
        let mut waiting = self.lock();
        let taken = match &event {
            Event::Called(call) => waiting.calls.push(call.client, event, CALLS_MAX),
            Event::Published { client, .. }
            | Event::Complained { client, .. }
            | Event::Left(client) => waiting.events.push(*client, event, EVENTS_MAX),
        };
        if taken {
            self.news.notify_one();
        }
        taken
    }

    /// The next event. Where there is none it is waited for, as long as `patience` says.
    pub(crate) fn pop(&self, patience: Duration) -> Option<Event> {
        let none =
            |waiting: &mut Waiting| waiting.calls.of.is_empty() && waiting.events.of.is_empty();
        let waited = self.news.wait_timeout_while(self.lock(), patience, none);
        let mut waiting = waited.unwrap_or_else(PoisonError::into_inner).0;
        waiting.calls.pop().or_else(|| waiting.events.pop())
    }

    fn lock(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bridge, Catalogue, Service};

    const HALT: &[Service] = &[Service {
        name: "/halt",
        kind: "std_srvs/Trigger",
        distil: |_| Ok(serde_json::Value::Null),
    }];

    fn bridge() -> Bridge {
        Bridge::new(Catalogue { published: &[], taken: &[], services: HALT })
    }

    fn said(client: ClientId) -> Event {
        Event::Complained { client, why: String::new() }
    }

    #[test]
    fn a_loud_client_delays_nobody_but_itself() {
        let mut bridge = bridge();
        let [loud, calm, third] = [(); 3].map(|()| bridge.connect());
        let queue = Queue::default();
        assert_eq!((0..1000).filter(|_| queue.push(said(loud))).count(), EVENTS_MAX);
        assert!(queue.push(said(calm)) && queue.push(said(third)) && queue.push(Event::Left(loud)));
        let next = || queue.pop(Duration::ZERO);
        assert_eq!([(); 4].map(|()| next()), [loud, calm, third, loud].map(|c| Some(said(c))));
        assert!((2..EVENTS_MAX).all(|_| next() == Some(said(loud))));
        assert_eq!((next(), queue.pop(Duration::from_millis(1))), (Some(Event::Left(loud)), None));
    }

    #[test]
    fn a_call_is_heard_first_however_much_its_own_client_said_before() {
        let mut bridge = bridge();
        let client = bridge.connect();
        let queue = Queue::default();
        assert!((0..1000).any(|_| !queue.push(said(client))));
        let call = r#"{"op": "call_service", "service": "/halt"}"#;
        let mut called = || bridge.hear(client, call).event.unwrap();
        assert_eq!((0..100).filter(|_| queue.push(called())).count(), CALLS_MAX);
        assert!(
            (0..CALLS_MAX).all(|_| matches!(queue.pop(Duration::ZERO), Some(Event::Called(_))))
        );
        assert_eq!(queue.pop(Duration::ZERO), Some(said(client)));
    }
}
