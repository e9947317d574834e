//! A controller elsewhere, over rosbridge: observations go out as a topic, actions come in as one.
//!
//! | Topic or service | Type | What |
//! |---|---|---|
//! | `/xt28/observation` | `xt28_msgs/Observation` | at each fix, or each tick |
//! | `/xt28/status` | `xt28_msgs/Status` | the safety kernel's phase and what stands against it, 10 Hz |
//! | `/xt28/action` | `xt28_msgs/Action` | the controller's answer to an observation |
//! | `/xt28/finish` | `std_srvs/SetBool` | the task is over: reached, or given up |
//! | `/xt28/emergency_stop` | `std_srvs/Trigger` | from any client; only a new run releases it |
//!
//! One client drives: the first whose answer is taken. Another one may once that has been silent for twice as long as
//! the safety kernel waits for it, which has stopped the machine by then. Whoever drives lets the gateway arm, as every
//! policy does; nothing that any client can say releases a stop or shifts a limit.

mod complaints;
mod listen;
mod messages;

use core::time::Duration;
use std::io;
use std::net::SocketAddr;

use serde_json::{Value, json};
use xt28_machine::{Machine, SimTime};
use xt28_rosbridge::{Call, Catalogue, ClientId, Event, Server, Service, Taken, Topic, printable};
use xt28_safety::Order;
use xt28_terrain::Terrain;

use crate::heights::read_heights;
use crate::policy::{Account, External, Seat, Seen};
use crate::{GatewayConfig, Outcome, Status};

pub use listen::Listen;

use complaints::Complaints;

const OBSERVATION: &str = "/xt28/observation";
const STATUS: &str = "/xt28/status";
const ACTION: &str = "/xt28/action";
const FINISH: &str = "/xt28/finish";
const EMERGENCY_STOP: &str = "/xt28/emergency_stop";

const CATALOGUE: Catalogue = Catalogue {
    published: &[
        Topic { name: OBSERVATION, kind: "xt28_msgs/Observation" },
        Topic { name: STATUS, kind: "xt28_msgs/Status" },
    ],
    taken: &[Taken {
        topic: Topic { name: ACTION, kind: "xt28_msgs/Action" },
        distil: messages::distil_action,
    }],
    services: &[
        Service {
            name: FINISH,
            kind: "std_srvs/SetBool",
            urgent: false,
            distil: messages::distil_finish,
        },
        Service {
            name: EMERGENCY_STOP,
            kind: "std_srvs/Trigger",
            urgent: true,
            distil: |_| Ok(Value::Null),
        },
    ],
};

/// Most events that are taken at one tick: none of them may wait for the others' sake.
const EVENTS_PER_TICK: usize = 32;
/// How often the status is published.
const STATUS_PERIOD: Duration = Duration::from_millis(100);

/// The gateway's side of the talk with a controller.
#[derive(Debug)]
pub struct Remote {
    server: Server,
    seat: Seat,
    /// What the local height map is cut from.
    map: Option<Terrain>,
    heights_m: Vec<f32>,
    /// Who drives, and when it answered last.
    driver: Option<(ClientId, SimTime)>,
    /// Its silence after which another one may drive.
    handover: Duration,
    /// Somebody has driven, and is gone.
    driver_left: bool,
    told_at: Option<SimTime>,
    complaints: Complaints,
}

/// What to look at where [`Remote::open`] failed.
#[must_use]
pub fn listen_advice(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::AddrNotAvailable => "this machine has no such address",
        io::ErrorKind::PermissionDenied => "ports below 1024 are for the system alone",
        _ => "is the port taken?",
    }
}

/// What clients wanted beyond driving.
#[derive(Debug, Default)]
pub struct Wanted {
    /// To be passed on to the gateway.
    pub order: Option<Order>,
    /// Who drives and what was refused, in words for whoever runs the gateway: one line each, and no flood of them.
    pub news: Vec<String>,
}

/// What came of waiting for a controller.
#[derive(Debug)]
pub enum Waited {
    /// It has answered, or it has left, or there is nothing to answer.
    OwesNothing,
    /// Something was said, which need not be the answer.
    For(Wanted),
    /// Nobody said anything for so long.
    InVain,
}

impl Remote {
    /// Listens; the policy is the gateway's end. With a `map` observations have the heights around the machine.
    ///
    /// # Errors
    /// The address cannot be listened on.
    pub fn open(
        listen: Listen,
        machine: &Machine,
        config: &GatewayConfig,
        map: Option<Terrain>,
    ) -> io::Result<(Self, External)> {
        let server = Server::open(listen.address, CATALOGUE)?;
        let (policy, seat) = External::new(machine, listen.pace);
        let handover = Duration::from_nanos(config.limits.policy.span_ns().saturating_mul(2));
        let remote = Self {
            server,
            seat,
            map,
            heights_m: Vec::new(),
            driver: None,
            handover,
            driver_left: false,
            told_at: None,
            complaints: Complaints::default(),
        };
        Ok((remote, policy))
    }

    /// Where it listens.
    #[must_use]
    pub const fn address(&self) -> SocketAddr {
        self.server.address()
    }

    /// Whether anybody has driven yet.
    #[must_use]
    pub const fn has_driver(&self) -> bool {
        self.driver.is_some()
    }

    /// The newest observation's number, and that of the one answered last; 0 is none.
    #[must_use]
    pub fn owed(&self) -> (u64, u64) {
        self.seat.owed()
    }

    /// How the controller has kept up so far.
    #[must_use]
    pub fn account(&self) -> Account {
        self.seat.account()
    }

    /// Takes what has come in. To be called before each tick of the gateway.
    pub fn hear(&mut self, now: SimTime) -> Wanted {
        let mut wanted = Wanted::default();
        for _ in 0..EVENTS_PER_TICK {
            let Some(event) = self.server.event(Duration::ZERO) else { break };
            self.take(now, event, &mut wanted);
        }
        wanted
    }

    /// Publishes what is new. To be called after each tick of the gateway.
    pub fn tell(&mut self, now: SimTime, status: &Status) {
        let at = now.since(SimTime::ZERO);
        if let Some(seen) = self.seat.take() {
            let mapped = self.read_map(&seen);
            let heights_m = mapped.then_some(&self.heights_m[..]);
            self.server.publish(at, OBSERVATION, messages::observation(&seen, heights_m));
        }
        if self.told_at.is_none_or(|told| now.since(told) >= STATUS_PERIOD) {
            self.told_at = Some(now);
            self.server.publish(at, STATUS, messages::status(now, status));
        }
    }

    /// Waits for what a controller says next, if it owes an answer to what it was shown last: for runs in simulated
    /// time, where the machine can wait. One that has left is not waited for. To be called until it owes nothing.
    pub fn wait(&mut self, now: SimTime, patience: Duration) -> Waited {
        if self.driver_left || self.seat.is_answered() {
            return Waited::OwesNothing;
        }
        let mut wanted = Wanted::default();
        match self.server.event(patience) {
            Some(event) => self.take(now, event, &mut wanted),
            None => return Waited::InVain,
        }
        Waited::For(wanted)
    }

    fn take(&mut self, now: SimTime, event: Event, wanted: &mut Wanted) {
        let done = match event {
            Event::Left(client) => {
                if self.driver.is_some_and(|(driver, _)| driver == client) {
                    self.driver_left = true;
                    wanted.news.push("the controller has left".to_owned());
                }
                Ok(())
            }
            Event::Published { client, address, message, .. } => self
                .drive(now, (client, address), &message, wanted)
                .inspect_err(|why| self.server.complain(client, why.clone())),
            Event::Called(call) => self.serve(call, wanted),
            Event::Complained { why, .. } => Err(why),
        };
        if let Err(why) = done.map_err(|why| printable(&why))
            && self.complaints.admit(now, &why)
        {
            wanted.news.push(why);
        }
    }

    /// An action of a client.
    fn drive(
        &mut self,
        now: SimTime,
        (client, address): (ClientId, SocketAddr),
        message: &Value,
        wanted: &mut Wanted,
    ) -> Result<(), String> {
        let (seq, action) = messages::action(message)?;
        if self.seat.is_over() {
            // It was under way when the task ended.
            return Ok(());
        }
        if let Some((driver, at)) = self.driver
            && driver != client
            && now.since(at) <= self.handover
        {
            return Err("another controller drives".to_owned());
        }
        self.seat.answer(now, seq, action).map_err(|refusal| refusal.to_string())?;
        if self.driver.is_none_or(|(driver, _)| driver != client) {
            wanted.news.push(format!("{address} drives"));
        }
        self.driver = Some((client, now));
        self.driver_left = false;
        Ok(())
    }

    fn serve(&self, call: Call, wanted: &mut Wanted) -> Result<(), String> {
        let done = match call.service {
            FINISH => self.finish(&call),
            EMERGENCY_STOP => {
                wanted.order = Some(Order::EmergencyStop);
                Ok(())
            }
            other => Err(format!("nobody serves {other}")),
        };
        let answer = done.clone().map(|()| json!({ "success": true, "message": "" }));
        self.server.respond(call, answer);
        done
    }

    /// Ends the task, if it is the driver that says so.
    fn finish(&self, call: &Call) -> Result<(), String> {
        if self.driver.is_none_or(|(driver, _)| driver != call.client) {
            let why =
                "only the controller that drives, of which an answer was taken, can end its task";
            return Err(why.to_owned());
        }
        let given_up = || Outcome::Failed("the controller gave up".to_owned());
        let reached = call.args == Value::Bool(true);
        self.seat.conclude(if reached { Outcome::Reached } else { given_up() });
        Ok(())
    }

    /// Cuts the local height map where the machine is known to be; false where there is none.
    fn read_map(&mut self, seen: &Seen) -> bool {
        let (Some(map), Some(located)) = (&self.map, &seen.observation.located) else {
            return false;
        };
        read_heights(map, &located.pose, &mut self.heights_m);
        true
    }
}
