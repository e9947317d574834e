//! The protocol without a socket: texts of clients in, texts for them and events for the owner out.

use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::time::Duration;

use serde_json::{Value, json};

use crate::catalogue::{Catalogue, Service, Taken, Topic, is_kind, is_name};
use crate::op::{self, Level, Message, Op};
use crate::printable::printable;
use crate::rosapi;
use crate::session::{SUBSCRIPTIONS_MAX, Session};

/// A client, for as long as it is connected; no other ever has the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ClientId(u64);

/// What the owner should know of.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// A client published on a topic that is taken.
    Published {
        /// Who.
        client: ClientId,
        /// From where.
        address: SocketAddr,
        /// On which topic, by its name in the catalogue.
        topic: &'static str,
        /// What its topic distils of it.
        message: Value,
    },
    /// A client called a service, and waits for [`Bridge::respond`].
    Called(Call),
    /// A client that had published something is gone.
    Left(ClientId),
    /// Something is wrong with what a client sent, which was told so; or with the server itself.
    Complained {
        /// Who, if it is about one that has come.
        client: Option<ClientId>,
        /// What is wrong.
        why: String,
    },
}

/// A service call that waits for its answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Call {
    /// Who called.
    pub client: ClientId,
    /// Which service, by its name in the catalogue.
    pub service: &'static str,
    /// What the service distils of the arguments.
    pub args: Value,
    pub(crate) urgent: bool,
    id: Option<Value>,
    spelled: String,
}

/// What came of a client's text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Heard {
    /// To be sent back to it.
    pub reply: Option<String>,
    /// For the owner.
    pub event: Option<Event>,
}

/// The server's side of the protocol.
#[derive(Debug)]
pub struct Bridge {
    catalogue: Catalogue,
    sessions: BTreeMap<ClientId, Session>,
    next: u64,
    /// When the owner last published something: the time that clients are told.
    now: Duration,
    /// What each topic said last, for those who come later.
    last: BTreeMap<&'static str, Value>,
}

impl Bridge {
    /// A bridge without clients.
    #[must_use]
    pub const fn new(catalogue: Catalogue) -> Self {
        Self {
            catalogue,
            sessions: BTreeMap::new(),
            next: 0,
            now: Duration::ZERO,
            last: BTreeMap::new(),
        }
    }

    /// A new client, from `address`.
    pub fn connect(&mut self, address: SocketAddr) -> ClientId {
        let client = ClientId(self.next);
        self.next += 1;
        self.sessions.insert(client, Session::new(address));
        client
    }

    /// A client is gone: what the owner should know of that.
    pub fn disconnect(&mut self, client: ClientId) -> Option<Event> {
        let session = self.sessions.remove(&client)?;
        session.has_published.then_some(Event::Left(client))
    }

    /// A text of a client. One that is no message of the protocol, or asks for what there is not, is answered by
    /// a `status` and changes nothing.
    pub fn hear(&mut self, client: ClientId, text: &str) -> Heard {
        match op::read(text) {
            Ok(Message { id, op }) => {
                let done = self.carry_out(client, id.clone(), op);
                done.unwrap_or_else(|why| self.complain(client, id.as_ref(), why))
            }
            Err(unread) => self.complain(client, unread.id.as_ref(), unread.why),
        }
    }

    /// Texts for all who are to hear what `topic` says at `at`, which is a time since any fixed instant. Who
    /// subscribes later hears it then.
    pub fn publish(
        &mut self,
        at: Duration,
        topic: &'static str,
        message: Value,
    ) -> Vec<(ClientId, String)> {
        self.now = at;
        let mut texts = Vec::new();
        for (client, session) in &mut self.sessions {
            let names = session.due(topic, at);
            texts.extend(names.iter().map(|name| (*client, publication(name, &message))));
        }
        self.last.insert(topic, message);
        texts
    }

    /// The text that answers a call: what the service gave, or why it gave nothing.
    #[must_use]
    pub fn respond(call: &Call, answer: &Result<Value, String>) -> String {
        let result = answer.is_ok();
        let values = match answer {
            Ok(values) => values.clone(),
            Err(why) => Value::from(why.as_str()),
        };
        response(&call.spelled, call.id.as_ref(), &values, result)
    }

    /// Tells a client what is wrong, if it wants to hear of it.
    pub(crate) fn complain(&self, client: ClientId, id: Option<&Value>, why: String) -> Heard {
        let why = printable(&why);
        let wanted = self.sessions.get(&client).is_some_and(|s| s.level <= Level::Error);
        let reply = wanted.then(|| status(id, &why));
        Heard { reply, event: Some(Event::Complained { client: Some(client), why }) }
    }

    fn carry_out(&mut self, client: ClientId, id: Option<Value>, op: Op) -> Result<Heard, String> {
        let catalogue = self.catalogue;
        let Some(session) = self.sessions.get_mut(&client) else { return Ok(Heard::default()) };
        match op {
            Op::Advertise { topic, kind } => {
                ensure_kind(&taken(&catalogue, &topic)?.topic, &kind)?;
            }
            Op::Unadvertise { topic } => {
                taken(&catalogue, &topic)?;
            }
            Op::Publish { topic, msg } => {
                let taken = taken(&catalogue, &topic)?;
                let message = (taken.distil)(&msg)?;
                session.has_published = true;
                let (address, topic) = (session.address, taken.topic.name);
                let event = Event::Published { client, address, topic, message };
                return Ok(Heard { reply: None, event: Some(event) });
            }
            Op::Subscribe { topic, kind, throttle_rate, fragment_size, compression } => {
                if let Some(other) = compression.filter(|way| way != "none") {
                    return Err(format!(
                        "{topic}: no compression {other:?} here; ask for \"none\""
                    ));
                }
                if fragment_size.is_some() {
                    return Err(format!("{topic}: no fragments here; leave out fragment_size"));
                }
                let published = published(&catalogue, &topic)?;
                kind.map_or(Ok(()), |kind| ensure_kind(published, &kind))?;
                let throttle = throttle(throttle_rate).ok_or_else(|| {
                    format!(
                        "{topic}: throttle_rate is the least time between messages in ms, 0 or more"
                    )
                })?;
                let last = self.last.get(published.name).map(|last| publication(&topic, last));
                if !session.subscribe(id, published.name, topic, throttle) {
                    return Err(format!(
                        "no more than {SUBSCRIPTIONS_MAX} subscriptions of a client"
                    ));
                }
                return Ok(Heard { reply: last, event: None });
            }
            Op::Unsubscribe { topic } => {
                let published = published(&catalogue, &topic)?;
                session.unsubscribe(id.as_ref(), published.name);
            }
            Op::SetLevel { level } => session.level = level,
            Op::CallService { service, args } => {
                return Ok(self.call(client, id, service, &args));
            }
        }
        Ok(Heard::default())
    }

    fn call(&self, client: ClientId, id: Option<Value>, spelled: String, args: &Value) -> Heard {
        let named = |service: &&Service| is_name(&spelled, service.name);
        if let Some(service) = rosapi::SERVICES.iter().find(named) {
            let values = rosapi::answer(service.name, args, &self.catalogue, self.now);
            let reply = Some(response(&spelled, id.as_ref(), &values, true));
            return Heard { reply, event: None };
        }
        let found = self.catalogue.services.iter().find(named).ok_or_else(|| {
            let names: Vec<_> =
                self.catalogue.services.iter().map(|service| service.name).collect();
            format!("no service {spelled:?}; there are {}", names.join(", "))
        });
        match found.and_then(|service| Ok((service, (service.distil)(args)?))) {
            Ok((Service { name: service, urgent, .. }, args)) => {
                let call = Call { client, service, args, urgent: *urgent, id, spelled };
                Heard { reply: None, event: Some(Event::Called(call)) }
            }
            Err(why) => {
                let why = printable(&why);
                let values = Value::from(why.as_str());
                let reply = Some(response(&spelled, id.as_ref(), &values, false));
                Heard { reply, event: Some(Event::Complained { client: Some(client), why }) }
            }
        }
    }
}

fn published(catalogue: &Catalogue, asked: &str) -> Result<&'static Topic, String> {
    let topics = catalogue.published;
    let missing = || no_topic(asked, "to subscribe to", topics.iter());
    topics.iter().find(|topic| is_name(asked, topic.name)).ok_or_else(missing)
}

fn taken(catalogue: &Catalogue, asked: &str) -> Result<&'static Taken, String> {
    let topics = catalogue.taken;
    let missing = || no_topic(asked, "to publish on", topics.iter().map(|taken| &taken.topic));
    topics.iter().find(|taken| is_name(asked, taken.topic.name)).ok_or_else(missing)
}

fn no_topic<'a>(asked: &str, to: &str, topics: impl Iterator<Item = &'a Topic>) -> String {
    let names: Vec<_> = topics.map(|topic| topic.name).collect();
    format!("no topic {asked:?} {to}; there are {}", names.join(", "))
}

fn ensure_kind(topic: &Topic, asked: &str) -> Result<(), String> {
    let Topic { name, kind } = topic;
    if is_kind(asked, kind) { Ok(()) } else { Err(format!("{name} is of {kind}, not {asked}")) }
}

/// A day is as good as never; what is no time is none.
fn throttle(ms: Option<f64>) -> Option<Duration> {
    let ms = ms.unwrap_or(0.0);
    (ms >= 0.0).then(|| Duration::from_secs_f64(ms.min(86_400e3) * 1e-3))
}

fn publication(topic: &str, message: &Value) -> String {
    json!({ "op": "publish", "topic": topic, "msg": message }).to_string()
}

fn status(id: Option<&Value>, why: &str) -> String {
    let mut text = json!({ "op": "status", "level": Level::Error.name(), "msg": why });
    if let Some(id) = id {
        text["id"] = id.clone();
    }
    text.to_string()
}

fn response(service: &str, id: Option<&Value>, values: &Value, result: bool) -> String {
    let mut text = json!({
        "op": "service_response", "service": service, "values": values, "result": result,
    });
    if let Some(id) = id {
        text["id"] = id.clone();
    }
    text.to_string()
}
