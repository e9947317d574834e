//! Events that wait for the owner: each client's in their order, all clients in turn, urgent calls first.
//!
//! So a loud client delays nobody but itself, and an urgent call waits for nothing that was said before.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use crate::bridge::{ClientId, Event};

/// Most events of one client that wait, beside its urgent calls.
const EVENTS_MAX: usize = 16;
/// Most urgent calls of one client that wait.
const URGENT_MAX: usize = 4;
/// Most clients that have something waiting when one more leaves, and most with an urgent call. Beside it each of the
/// connected has its place.
const CLIENTS_MAX: usize = 64;
/// Most urgent calls in a row, where something else waits.
const URGENT_IN_A_ROW: u32 = 4;

/// A queue between the thread and the owner.
#[derive(Debug, Default)]
pub(crate) struct Queue {
    waiting: Mutex<Waiting>,
    news: Condvar,
}

#[derive(Debug, Default)]
struct Waiting {
    urgent: Turns,
    others: Turns,
    /// Urgent calls since something else had its turn.
    in_a_row: u32,
}

impl Waiting {
    fn is_empty(&self) -> bool {
        self.urgent.of.is_empty() && self.others.of.is_empty()
    }

    fn pop(&mut self) -> Option<Event> {
        if (self.in_a_row < URGENT_IN_A_ROW || self.others.of.is_empty())
            && let Some(call) = self.urgent.pop()
        {
            self.in_a_row += 1;
            return Some(call);
        }
        self.in_a_row = 0;
        self.others.pop()
    }
}

/// What waits, by client; in the line of nobody what is about no client that the owner knows.
#[derive(Debug, Default)]
struct Turns {
    of: BTreeMap<Option<ClientId>, VecDeque<Event>>,
    /// Whose turn it was last.
    last: Option<ClientId>,
}

impl Turns {
    fn push(&mut self, client: Option<ClientId>, event: Event, most: usize) -> bool {
        let own = self.of.entry(client).or_default();
        let room = own.len() < most;
        if room {
            own.push_back(event);
        }
        room
    }

    /// Adds that one has left, however much it said before; or forgets it, where many have left lately.
    fn leave(&mut self, client: ClientId) -> bool {
        let room = self.of.len() < CLIENTS_MAX;
        if room {
            self.of.entry(Some(client)).or_default().push_back(Event::Left(client));
        } else {
            self.of.remove(&Some(client));
        }
        room
    }

    /// The oldest event of the client whose turn it is.
    fn pop(&mut self) -> Option<Event> {
        let after = self.of.range(self.last..).map(|(client, _)| *client).find(|c| *c != self.last);
        let client = after.or_else(|| self.of.keys().next().copied())?;
        self.last = client;
        let own = self.of.get_mut(&client)?;
        let event = own.pop_front();
        if own.is_empty() {
            self.of.remove(&client);
        }
        event
    }
}

impl Queue {
    /// Adds an event; false, and nothing is added, where its client has too many waiting.
    pub(crate) fn push(&self, event: Event) -> bool {
        let mut waiting = self.lock();
        let taken = match &event {
            Event::Left(client) => waiting.others.leave(*client),
            // Where so many want the same, one more changes nothing.
            Event::Called(call) if call.urgent => {
                waiting.urgent.of.len() < CLIENTS_MAX
                    && waiting.urgent.push(Some(call.client), event, URGENT_MAX)
            }
            Event::Called(call) => waiting.others.push(Some(call.client), event, EVENTS_MAX),
            Event::Published { client, .. } => {
                waiting.others.push(Some(*client), event, EVENTS_MAX)
            }
            Event::Complained { client, .. } => waiting.others.push(*client, event, EVENTS_MAX),
        };
        if taken {
            self.news.notify_one();
        }
        taken
    }

    /// The next event. Where there is none it is waited for, as long as `patience` says.
    pub(crate) fn pop(&self, patience: Duration) -> Option<Event> {
        let waited =
            self.news.wait_timeout_while(self.lock(), patience, |waiting| waiting.is_empty());
        waited.unwrap_or_else(PoisonError::into_inner).0.pop()
    }

    fn lock(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bridge, Catalogue, Service};

    const fn service(name: &'static str, urgent: bool) -> Service {
        Service { name, kind: "std_srvs/Trigger", urgent, distil: |_| Ok(serde_json::Value::Null) }
    }

    fn bridge() -> Bridge {
        const SERVICES: &[Service] = &[service("/halt", true), service("/ask", false)];
        Bridge::new(Catalogue { published: &[], taken: &[], services: SERVICES })
    }

    fn connect(bridge: &mut Bridge) -> ClientId {
        bridge.connect(std::net::SocketAddr::from(([127, 0, 0, 1], 1)))
    }

    fn said(client: ClientId) -> Event {
        Event::Complained { client: Some(client), why: String::new() }
    }

    fn call(bridge: &mut Bridge, client: ClientId, service: &str) -> Event {
        let text = format!(r#"{{"op": "call_service", "service": "{service}"}}"#);
        bridge.hear(client, &text).event.unwrap()
    }

    #[test]
    fn a_loud_client_delays_nobody_but_itself() {
        let mut bridge = bridge();
        let [loud, calm, third] = [(); 3].map(|()| connect(&mut bridge));
        let queue = Queue::default();
        assert_eq!((0..1000).filter(|_| queue.push(said(loud))).count(), EVENTS_MAX);
        assert!(queue.push(said(calm)) && queue.push(said(third)) && queue.push(Event::Left(loud)));
        let next = || queue.pop(Duration::ZERO);
        assert_eq!([(); 4].map(|()| next()), [loud, calm, third, loud].map(|c| Some(said(c))));
        assert!((2..EVENTS_MAX).all(|_| next() == Some(said(loud))));
        assert_eq!((next(), queue.pop(Duration::from_millis(1))), (Some(Event::Left(loud)), None));
    }

    #[test]
    fn many_callers_leave_a_client_its_turn() {
        let mut bridge = bridge();
        let callers: Vec<_> = (0..15).map(|_| connect(&mut bridge)).collect();
        let driver = connect(&mut bridge);
        let queue = Queue::default();
        for caller in callers {
            while queue.push(call(&mut bridge, caller, "/ask")) {}
        }
        assert!(queue.push(said(driver)));
        let before =
            std::iter::from_fn(|| queue.pop(Duration::ZERO)).take_while(|e| *e != said(driver));
        assert_eq!(before.count(), 15);
    }

    #[test]
    fn an_urgent_call_waits_for_nothing_that_was_said_before() {
        let mut bridge = bridge();
        let [client, other] = [(); 2].map(|()| connect(&mut bridge));
        let queue = Queue::default();
        while queue.push(said(client)) || queue.push(said(other)) {}
        assert!(!queue.push(call(&mut bridge, client, "/ask")));
        let halts = (0..100).filter(|_| queue.push(call(&mut bridge, client, "/halt")));
        assert_eq!(halts.count(), URGENT_MAX);
        assert!(
            (0..URGENT_MAX).all(|_| matches!(queue.pop(Duration::ZERO), Some(Event::Called(_))))
        );
        assert_eq!(queue.pop(Duration::ZERO), Some(said(client)));
    }

    #[test]
    fn a_client_has_its_place_however_many_came_and_went() {
        let mut bridge = bridge();
        let driver = connect(&mut bridge);
        let queue = Queue::default();
        for _ in 0..1000 {
            let passer = connect(&mut bridge);
            queue.push(said(passer));
            queue.push(call(&mut bridge, passer, "/halt"));
            queue.push(Event::Left(passer));
            queue.push(Event::Complained { client: None, why: "garbage".to_owned() });
        }
        assert!(queue.push(said(driver)));
        let waiting: Vec<_> = std::iter::from_fn(|| queue.pop(Duration::ZERO)).collect();
        assert!(waiting.len() <= 3 * CLIENTS_MAX + EVENTS_MAX + 1, "{}", waiting.len());
        let before = waiting.iter().position(|event| *event == said(driver));
        assert!(before.is_some_and(|before| before <= 10), "though all would halt: {before:?}");
    }
}
