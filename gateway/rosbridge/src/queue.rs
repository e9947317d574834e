//! Events that wait for the owner: so many of each client, so that a loud one leaves room for the others' calls.

use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use crate::bridge::{ClientId, Event};

/// Most events of one client that wait.
const WAITING_MAX: usize = 64;

/// A queue between the thread and the owner.
#[derive(Debug, Default)]
pub(crate) struct Queue {
    waiting: Mutex<VecDeque<Event>>,
    news: Condvar,
}

impl Queue {
    /// Adds an event; false, and nothing is added, where its client has too many waiting. That one has left is
    /// always taken.
    pub(crate) fn push(&self, event: Event) -> bool {
        let mut waiting = self.lock();
        let of_client = |other: &&Event| client(other) == client(&event);
        let room = waiting.iter().filter(of_client).count() < WAITING_MAX;
        let taken = room || matches!(event, Event::Left(_));
        if taken {
            waiting.push_back(event);
            self.news.notify_one();
        }
        taken
    }

    /// The oldest event. Where there is none it is waited for, as long as `patience` says.
    pub(crate) fn pop(&self, patience: Duration) -> Option<Event> {
        let waiting = self.lock();
        let waited = self.news.wait_timeout_while(waiting, patience, |waiting| waiting.is_empty());
        waited.unwrap_or_else(PoisonError::into_inner).0.pop_front()
    }

    fn lock(&self) -> MutexGuard<'_, VecDeque<Event>> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

const fn client(event: &Event) -> ClientId {
    match event {
        Event::Published { client, .. }
        | Event::Complained { client, .. }
        | Event::Left(client) => *client,
        Event::Called(call) => call.client,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bridge, Catalogue};

    #[test]
    fn a_loud_client_leaves_room_for_the_others() {
        let mut bridge = Bridge::new(Catalogue { published: &[], taken: &[], services: &[] });
        let [loud, calm] = [(); 2].map(|()| bridge.connect());
        let said = |client| Event::Complained { client, why: String::new() };
        let queue = Queue::default();
        assert_eq!((0..1000).filter(|_| queue.push(said(loud))).count(), WAITING_MAX);
        assert!(queue.push(said(calm)) && queue.push(Event::Left(loud)));
        for _ in 0..WAITING_MAX {
            assert_eq!(queue.pop(Duration::ZERO), Some(said(loud)));
        }
        assert_eq!(queue.pop(Duration::ZERO), Some(said(calm)));
        assert_eq!(queue.pop(Duration::ZERO), Some(Event::Left(loud)));
        assert_eq!(queue.pop(Duration::from_millis(1)), None);
    }
}
