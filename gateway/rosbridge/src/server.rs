//! The owner's handle of a server, whose thread has the sockets.

use std::io::{self, Write};
use std::net::{SocketAddr, TcpListener};
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::sync::mpsc::{Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use serde_json::Value;

use crate::bridge::{Bridge, Call, ClientId, Event};
use crate::catalogue::Catalogue;
use crate::errand::Errand;
use crate::host::Host;
use crate::queue::Queue;

/// A rosbridge server on a socket of its own. Dropping it says goodbye to all clients.
#[derive(Debug)]
pub struct Server {
    address: SocketAddr,
    errands: Sender<Errand>,
    events: Arc<Queue>,
    /// A byte wakes the thread.
    bell: UnixStream,
    thread: Option<JoinHandle<()>>,
}

impl Server {
    /// Listens on `address`; port 0 is any that is free.
    ///
    /// # Errors
    /// The address cannot be listened on, or the system gives no thread.
    pub fn open(address: SocketAddr, catalogue: Catalogue) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        let address = listener.local_addr()?;
        let (bell, rung) = UnixStream::pair()?;
        // One that has rung often enough to fill the socket need not ring again.
        bell.set_nonblocking(true)?;
        rung.set_nonblocking(true)?;
        let (errands, taken) = channel();
        let events = Arc::new(Queue::default());
        let mut host =
            Host::new(listener, rung, taken, Arc::clone(&events), Bridge::new(catalogue));
        let thread = std::thread::Builder::new().name("rosbridge".to_owned());
        let thread = Some(thread.spawn(move || host.run())?);
        Ok(Self { address, errands, events, bell, thread })
    }

    /// Where it listens.
    #[must_use]
    pub const fn address(&self) -> SocketAddr {
        self.address
    }

    /// Sends a message to all who subscribed to `topic`, as far as they want one already; `at` is a time since any
    /// fixed instant.
    pub fn publish(&self, at: Duration, topic: &'static str, message: Value) {
        self.send(Errand::Publish { at, topic, message });
    }

    /// Answers a call: what the service gave, or why it gave nothing.
    pub fn respond(&self, call: Call, answer: Result<Value, String>) {
        self.send(Errand::Respond { call, answer });
    }

    /// Tells a client that what it published is not taken, and why.
    pub fn complain(&self, client: ClientId, why: String) {
        self.send(Errand::Complain { client, why });
    }

    /// The next event. Where none has come in it is waited for, as long as `patience` says.
    #[must_use]
    pub fn event(&self, patience: Duration) -> Option<Event> {
        self.events.pop(patience)
    }

    fn send(&self, errand: Errand) {
        // A thread that is gone has no clients left to hear it.
        let _ = self.errands.send(errand);
        let _ = (&self.bell).write(&[0]);
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.send(Errand::End);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
