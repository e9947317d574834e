//! The thread of a server: it sleeps until a client says something or the owner does.

use std::collections::BTreeMap;
use std::io::{self, ErrorKind, Read};
use std::net::TcpListener;
use std::os::fd::AsFd;
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;
use tungstenite::protocol::frame::coding::CloseCode;

use crate::bridge::{Bridge, ClientId, Event};
use crate::connection::{Connection, Ended};
use crate::errand::Errand;
use crate::queue::Queue;

/// Most clients at a time.
const CLIENTS_MAX: usize = 16;
/// Most that are let in before the others have their turn.
const GUESTS_PER_TURN: usize = 8;
/// How many turns nobody is let in once there was no file for a newcomer; a turn is a second at most.
const DEAF_TURNS: u32 = 100;
const TURN_S: i64 = 1;

/// What the thread has.
pub(crate) struct Host {
    listener: TcpListener,
    rung: UnixStream,
    errands: Receiver<Errand>,
    events: Arc<Queue>,
    bridge: Bridge,
    clients: BTreeMap<ClientId, Connection>,
    /// Turns until newcomers are looked for again: the system had no file left for one.
    deaf: u32,
}

impl Host {
    pub(crate) const fn new(
        listener: TcpListener,
        rung: UnixStream,
        errands: Receiver<Errand>,
        events: Arc<Queue>,
        bridge: Bridge,
    ) -> Self {
        Self { listener, rung, errands, events, bridge, clients: BTreeMap::new(), deaf: 0 }
    }

    /// Serves until the owner wants it to end.
    pub(crate) fn run(&mut self) {
        loop {
            let (ready, knocked) = match self.sleep() {
                Ok(happened) => happened,
                Err(error) => {
                    self.tell(format!("the server ends: {error}"));
                    break;
                }
            };
            self.deaf = self.deaf.saturating_sub(1);
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
            connection.close(&Ended(None));
        }
    }

    /// Sleeps until something happens: the clients that can be read from or written to, and whether somebody
    /// knocked.
    fn sleep(&self) -> io::Result<(Vec<(ClientId, bool)>, bool)> {
        let reads = PollFlags::IN;
        let knocks = if self.deaf > 0 { PollFlags::empty() } else { reads };
        let mut fds = vec![
            PollFd::from_borrowed_fd(self.rung.as_fd(), reads),
            PollFd::from_borrowed_fd(self.listener.as_fd(), knocks),
        ];
        for connection in self.clients.values() {
            let writes = if connection.unsent { PollFlags::OUT } else { PollFlags::empty() };
            fds.push(PollFd::from_borrowed_fd(connection.as_fd(), reads | writes));
        }
        let more = self.clients.values().any(|connection| connection.unread);
        let longest = Timespec { tv_sec: if more { 0 } else { TURN_S }, tv_nsec: 0 };
        match poll(&mut fds, (more || self.deaf > 0).then_some(&longest)) {
            Ok(_) | Err(Errno::INTR) => {}
            Err(errno) => return Err(errno.into()),
        }
        // Nothing where it was not the bell. What is left of many rings wakes once more.
        let _ = (&self.rung).read(&mut [0; 256]);
        let happened = |fd: &PollFd<'_>| fd.revents();
        let mut ready = Vec::new();
        for ((client, connection), fd) in self.clients.iter().zip(&fds[2..]) {
            let happened = happened(fd);
            if connection.unread || !happened.is_empty() {
                // Also where it hung up or broke: reading says so.
                ready.push((*client, connection.unread || happened != PollFlags::OUT));
            }
        }
        Ok((ready, !happened(&fds[1]).is_empty()))
    }

    /// Does what the owner wants; false once that is to end.
    fn carry_out(&mut self) -> bool {
        loop {
            match self.errands.try_recv() {
                Ok(Errand::Publish { at, topic, message }) => {
                    for (client, text) in self.bridge.publish(at, topic, message) {
                        self.send(client, text);
                    }
                }
                Ok(Errand::Respond { call, answer }) => {
                    self.send(call.client, Bridge::respond(&call, &answer));
                }
                Ok(Errand::Complain { client, why }) => {
                    if let Some(text) = self.bridge.complain(client, None, why).reply {
                        self.send(client, text);
                    }
                }
                Ok(Errand::End) | Err(TryRecvError::Disconnected) => return false,
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
            true => connection.read(|text| replies.extend(hear(bridge, events, client, text))),
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

    fn lose(&mut self, client: ClientId, ended: Ended) {
        let left = self.bridge.disconnect(client);
        let was_open = self.clients.get(&client).is_some_and(Connection::is_open);
        if let Some(connection) = self.clients.remove(&client) {
            connection.close(&ended);
        }
        if let Ended(Some((_, why))) = ended {
            self.events.push(Event::Complained { client: was_open.then_some(client), why });
        }
        if let Some(left) = left {
            self.events.push(left);
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
                    if !passes.contains(&error.kind()) {
                        self.deaf = DEAF_TURNS;
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
                let ended = Ended::by_us(CloseCode::Policy, "never finished its handshake");
                self.lose(idle, ended);
            }
            if let Ok(connection) = Connection::begin(stream) {
                let client = self.bridge.connect(address);
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
