//! The socket: one thread that sleeps until a client says something or the owner does.

use std::collections::BTreeMap;
use std::io::{self, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener};
use std::os::fd::AsFd;
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;
use serde_json::Value;

use crate::bridge::{Bridge, Call, ClientId, Event};
use crate::catalogue::Catalogue;
use crate::connection::{Connection, Ended};
use crate::queue::Queue;

/// Most clients at a time.
const CLIENTS_MAX: usize = 16;

/// Most that are let in before the others have their turn.
const GUESTS_PER_TURN: usize = 8;
/// How long nobody is let in once there was no file for a newcomer, s.
const DEAF_S: i64 = 1;

/// A rosbridge server on a socket of its own. Dropping it says goodbye to all clients.
#[derive(Debug)]
pub struct Server {
    address: SocketAddr,
    orders: Sender<Order>,
    events: Arc<Queue>,
    /// A byte wakes the thread.
    bell: UnixStream,
    thread: Option<JoinHandle<()>>,
}

/// What the owner wants of the thread.
enum Order {
    Publish { at: Duration, topic: &'static str, message: Value },
    Respond { call: Call, answer: Result<Value, String> },
    Complain { client: ClientId, why: String },
    End,
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
        let (orders, taken) = channel();
        let events = Arc::new(Queue::default());
        let mut host = Host {
            listener,
            rung,
            orders: taken,
            events: Arc::clone(&events),
            bridge: Bridge::new(catalogue),
            clients: BTreeMap::new(),
            deaf: false,
        };
        let thread = std::thread::Builder::new().name("rosbridge".to_owned());
        let thread = Some(thread.spawn(move || host.run())?);
        Ok(Self { address, orders, events, bell, thread })
    }

    /// Where it listens.
    #[must_use]
    pub const fn address(&self) -> SocketAddr {
        self.address
    }

    /// Sends a message to all who subscribed to `topic`, as far as they want one already; `at` is a time since any
    /// fixed instant.
    pub fn publish(&self, at: Duration, topic: &'static str, message: Value) {
        self.order(Order::Publish { at, topic, message });
    }

    /// Answers a call: what the service gave, or why it gave nothing.
    pub fn respond(&self, call: Call, answer: Result<Value, String>) {
        self.order(Order::Respond { call, answer });
    }

    /// Tells a client that what it published is not taken, and why.
    pub fn complain(&self, client: ClientId, why: String) {
        self.order(Order::Complain { client, why });
    }

    /// The next event. Where none has come in it is waited for, as long as `patience` says.
    #[must_use]
    pub fn event(&self, patience: Duration) -> Option<Event> {
        self.events.pop(patience)
    }

    fn order(&self, order: Order) {
        // A thread that is gone has no clients left to hear it.
        let _ = self.orders.send(order);
        let _ = (&self.bell).write(&[0]);
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.order(Order::End);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// What the thread has.
struct Host {
    listener: TcpListener,
    rung: UnixStream,
    orders: Receiver<Order>,
    events: Arc<Queue>,
    bridge: Bridge,
    clients: BTreeMap<ClientId, Connection>,
    /// The system has no file left for a newcomer: it is no use to look again at once.
    deaf: bool,
}

impl Host {
    fn run(&mut self) {
        loop {
            let (ready, knocked) = match self.sleep() {
                Ok(happened) => happened,
                Err(error) => {
                    self.tell(format!("the server ends: {error}"));
                    break;
                }
            };
            self.deaf = false;
            if !self.carry_out() {
                break;
            }
            for (client, may_read) in ready {
                self.serve(client, may_read);
            }
            if knocked {
                self.let_in();
            }
        }
        for (_, connection) in std::mem::take(&mut self.clients) {
            connection.close();
        }
    }

    /// Sleeps until something happens: the clients that can be read from or written to, and whether somebody
    /// knocked.
    fn sleep(&self) -> io::Result<(Vec<(ClientId, bool)>, bool)> {
        let reads = PollFlags::IN;
        let knocks = if self.deaf { PollFlags::empty() } else { reads };
        let mut fds = vec![
            PollFd::from_borrowed_fd(self.rung.as_fd(), reads),
            PollFd::from_borrowed_fd(self.listener.as_fd(), knocks),
        ];
        for connection in self.clients.values() {
            let writes = if connection.waits { PollFlags::OUT } else { PollFlags::empty() };
            fds.push(PollFd::from_borrowed_fd(connection.as_fd(), reads | writes));
        }
        let more = self.clients.values().any(|connection| connection.more);
        let longest = Timespec { tv_sec: if more { 0 } else { DEAF_S }, tv_nsec: 0 };
        match poll(&mut fds, (more || self.deaf).then_some(&longest)) {
            Ok(_) | Err(Errno::INTR) => {}
            Err(errno) => return Err(errno.into()),
        }
        // Nothing where it was not the bell. What is left of many rings wakes once more.
        let _ = (&self.rung).read(&mut [0; 256]);
        let happened = |fd: &PollFd<'_>| fd.revents();
        let mut ready = Vec::new();
        for ((client, connection), fd) in self.clients.iter().zip(&fds[2..]) {
            let happened = happened(fd);
            if connection.more || !happened.is_empty() {
                // Also where it hung up or broke: reading says so.
                ready.push((*client, connection.more || happened != PollFlags::OUT));
            }
        }
        Ok((ready, !happened(&fds[1]).is_empty()))
    }

    /// Does what the owner wants; false once that is to end.
    fn carry_out(&mut self) -> bool {
        loop {
            match self.orders.try_recv() {
                Ok(Order::Publish { at, topic, message }) => {
                    for (client, text) in self.bridge.publish(at, topic, message) {
                        self.send(client, text);
                    }
                }
                Ok(Order::Respond { call, answer }) => {
                    self.send(call.client, Bridge::respond(&call, &answer));
                }
                Ok(Order::Complain { client, why }) => {
                    if let Some(text) = self.bridge.complain(client, None, why).reply {
                        self.send(client, text);
                    }
                }
                Ok(Order::End) | Err(TryRecvError::Disconnected) => return false,
                Err(TryRecvError::Empty) => return true,
            }
        }
    }

    fn serve(&mut self, client: ClientId, may_read: bool) {
        let Some(connection) = self.clients.get_mut(&client) else { return };
        let flushed = connection.flush();
        let mut replies = Vec::new();
        let (bridge, events) = (&mut self.bridge, &self.events);
        let served = flushed.and_then(|()| match may_read {
            true => connection.read(
                |address| {
                    events.push(Event::Came { client, address });
                },
                |text| replies.extend(hear(bridge, events, client, text)),
            ),
            false => Ok(()),
        });
        for reply in replies {
            self.send(client, reply);
        }
        if let Err(ended) = served {
            self.lose(client, ended);
        }
    }

    fn send(&mut self, client: ClientId, text: String) {
        if let Some(connection) = self.clients.get_mut(&client)
            && let Err(ended) = connection.send(text)
        {
            self.lose(client, ended);
        }
    }

    fn lose(&mut self, client: ClientId, Ended(why): Ended) {
        self.bridge.disconnect(client);
        let was_open = self.clients.get(&client).is_some_and(Connection::is_open);
        if let Some(connection) = self.clients.remove(&client) {
            connection.close();
        }
        if let Some(why) = why {
            self.events.push(Event::Complained { client: was_open.then_some(client), why });
        }
        if was_open {
            self.events.push(Event::Left(client));
        }
    }

    /// Tells the owner what is about no client that it knows.
    fn tell(&self, why: String) {
        self.events.push(Event::Complained { client: None, why });
    }

    /// Takes in who knocked. Where the house is full somebody who never finished his handshake has to go, or
    /// the newcomer.
    fn let_in(&mut self) {
        for _ in 0..GUESTS_PER_TURN {
            let (stream, address) = match self.listener.accept() {
                Ok(accepted) => accepted,
                Err(error) => {
                    // One that hung up while it waited is no reason.
                    let passes = [
                        ErrorKind::WouldBlock,
                        ErrorKind::Interrupted,
                        ErrorKind::ConnectionAborted,
                    ];
                    self.deaf = !passes.contains(&error.kind());
                    if self.deaf {
                        self.tell(format!("cannot let anybody in: {error}"));
                    }
                    return;
                }
            };
            if self.clients.len() >= CLIENTS_MAX {
                let idle = self.clients.iter().find(|(_, connection)| !connection.is_open());
                let Some((&idle, _)) = idle else {
                    self.tell(format!("turned a client away: {CLIENTS_MAX} are connected already"));
                    continue;
                };
                self.lose(idle, Ended(Some("never finished its handshake".to_owned())));
            }
            if let Ok(connection) = Connection::begin(stream, address) {
                let client = self.bridge.connect();
                self.clients.insert(client, connection);
            }
        }
    }
}

/// What a text of a client comes to; the reply to it.
fn hear(bridge: &mut Bridge, events: &Queue, client: ClientId, text: &str) -> Option<String> {
    let heard = bridge.hear(client, text);
    let call = match &heard.event {
        Some(Event::Called(call)) => Some(call.clone()),
        _ => None,
    };
    if heard.event.is_none_or(|event| events.push(event)) {
        return heard.reply;
    }
    let why = "too much at a time".to_owned();
    match call {
        Some(call) => Some(Bridge::respond(&call, &Err(why))),
        None => bridge.complain(client, None, why).reply,
    }
}
