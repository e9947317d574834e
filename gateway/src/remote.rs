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
//! One controller drives. Whoever else publishes actions is refused until that one has been silent for as long as
//! the safety kernel waits for it. Nothing a client can say arms the machine, or shifts a limit.

mod listen;
mod messages;

use core::time::Duration;
use std::io;
use std::net::SocketAddr;

use serde_json::{Value, json};
use xt28_machine::{Machine, SimTime};
use xt28_rosbridge::{Call, Catalogue, ClientId, Event, Server, Service, Topic};
use xt28_safety::Order;
use xt28_terrain::{LocalMap, MapPose, Terrain};

use crate::policy::{External, Seat, Seen};
use crate::{GatewayConfig, Outcome, Status};

pub use listen::Listen;

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
    taken: &[Topic { name: ACTION, kind: "xt28_msgs/Action" }],
    services: &[
        Service { name: FINISH, kind: "std_srvs/SetBool" },
        Service { name: EMERGENCY_STOP, kind: "std_srvs/Trigger" },
    ],
};

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
    patience: Duration,
    /// Somebody has driven, and is gone.
    left: bool,
    told_at: Option<SimTime>,
}

/// What clients wanted beyond driving.
#[derive(Debug, Default)]
pub struct Wanted {
    /// To be passed on to the gateway.
    pub order: Option<Order>,
    /// What was refused, in words for whoever runs the gateway.
    pub refused: Vec<String>,
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
        let patience = Duration::from_nanos(config.limits.policy.span_ns());
        let remote = Self {
            server,
            seat,
            map,
            heights_m: Vec::new(),
            driver: None,
            patience,
            left: false,
            told_at: None,
        };
        Ok((remote, policy))
    }

    /// Where it listens.
    #[must_use]
    pub const fn address(&self) -> SocketAddr {
        self.server.address()
    }

    /// Takes all that has come in. To be called before each tick of the gateway.
    pub fn hear(&mut self, now: SimTime) -> Wanted {
        let mut wanted = Wanted::default();
        while let Some(event) = self.server.event(Duration::ZERO) {
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

    /// Waits until the controller has answered what it was shown last: for runs in simulated time, where the machine
    /// can wait. One that has left is not waited for. False when it took longer than `patience`.
    pub fn wait(&mut self, now: SimTime, patience: Duration, wanted: &mut Wanted) -> bool {
        while !self.left && !self.seat.is_answered() {
            let Some(event) = self.server.event(patience) else { return false };
            self.take(now, event, wanted);
        }
        true
    }

    fn take(&mut self, now: SimTime, event: Event, wanted: &mut Wanted) {
        match event {
            Event::Published { client, message, .. } => {
                if let Err(why) = self.drive(now, client, &message) {
                    wanted.refused.push(why.clone());
                    self.server.complain(client, why);
                }
            }
            Event::Called(call) => self.serve(call, wanted),
            Event::Left(client) if self.driver.is_some_and(|(driver, _)| driver == client) => {
                self.driver = None;
                self.left = true;
                wanted.refused.push("the controller has left".to_owned());
            }
            Event::Left(_) => {}
            Event::Complained { why, .. } => wanted.refused.push(why),
        }
    }

    /// An action of a client.
    fn drive(&mut self, now: SimTime, client: ClientId, message: &Value) -> Result<(), String> {
        let (seq, action) = messages::action(message)?;
        if let Some((driver, at)) = self.driver
            && driver != client
            && now.since(at) <= self.patience
        {
            return Err("another controller drives".to_owned());
        }
        self.seat.answer(seq, action).map_err(|refusal| refusal.to_string())?;
        self.driver = Some((client, now));
        self.left = false;
        Ok(())
    }

    fn serve(&self, call: Call, wanted: &mut Wanted) {
        let done = || json!({ "success": true, "message": "" });
        let answer = match (call.service, call.args.get("data").and_then(Value::as_bool)) {
            (FINISH, Some(reached)) if self.driver.is_none_or(|(d, _)| d == call.client) => {
                let given_up = || Outcome::Failed("the controller gave up".to_owned());
                self.seat.conclude(if reached { Outcome::Reached } else { given_up() });
                Ok(done())
            }
            (FINISH, Some(_)) => Err("another controller drives".to_owned()),
            (FINISH, None) => {
                Err("give data: true where the task is done, false where it is given up".to_owned())
            }
            _ => {
                wanted.order = Some(Order::EmergencyStop);
                Ok(done())
            }
        };
        self.server.respond(call, answer);
    }

    /// Cuts the local height map where the machine is known to be; false where there is none.
    fn read_map(&mut self, seen: &Seen) -> bool {
        let (Some(map), Some(located)) = (&self.map, &seen.observation.located) else {
            return false;
        };
        let pose = located.pose;
        // Above the ground under the front axle: receiver and survey need not agree on height.
        let ground_m = map.height_m(pose.east_m, pose.north_m);
        let position_m = [pose.east_m, pose.north_m, ground_m];
        let pose = MapPose { position_m, heading_rad: pose.heading_rad };
        LocalMap::default().read(map, &pose, &mut self.heights_m);
        true
    }
}
