//! A run in simulated time: emulator and gateway on a virtual bus, tick by tick.
//!
//! One tick of 10 ms at time `t`, in this order and no other:
//!
//! 1. The bus delivers all that ended by `t`, and the log takes it in bus order.
//! 2. Events due at `t` happen. A node that dies is gone; what it had queued still leaves.
//! 3. The emulator hears its frames, runs both ECUs and the plant, and queues its frames at `t`.
//! 4. The gateway hears its frames and the receiver's bytes of this tick, and queues its frames at
//!    `t`. A controller elsewhere is heard before it, and shown what it saw and waited for after it.
//!
//! So both nodes' frames meet on the wire at `t`, and arbitration alone decides their order.

use std::io::{self, Write};
use std::net::SocketAddr;
use std::time::Duration;

use ecu_emu::{Emulator, EmulatorConfig, Operator, TICK};
use gateway::policy::{Policy, SpecError};
use gateway::{Gateway, GatewayConfig, Order};
use xt28_bus::{Bitrate, NodeId, VirtualBus, candump};
use xt28_dbc::Outbox;
use xt28_machine::SimTime;
use xt28_sim::STEP;
use xt28_sim::effects::OverlayError;

use crate::controller::Talk;
use crate::decode::Decoder;
use crate::digest::HashingWriter;
use crate::recording::Recording;
use crate::{Controller, Driven, GatewayOrder, Incident, Node, Setup, Truth};

/// A run under way. Call [`Lockstep::tick`] until it says that the run is over.
pub struct Lockstep<W: Write> {
    bus: VirtualBus,
    emulator: Option<(NodeId, Emulator)>,
    gateway: Option<(NodeId, Gateway)>,
    /// With what the gateway is driven by, where that is elsewhere.
    talk: Option<Talk>,
    /// What a gateway that was killed had said of itself.
    driven: Option<Driven>,
    events: Vec<(SimTime, Incident)>,
    now: SimTime,
    end: SimTime,
    outbox: Outbox,
    gnss: Vec<u8>,
    log: candump::Writer<HashingWriter<W>>,
    decoder: Decoder,
    truth: Truth,
}

/// Why a run could not start or go on.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The scenario's policy is none.
    #[error("{policy_at}: {source}")]
    Policy {
        /// File and line of the policy.
        policy_at: String,
        /// What the gateway said.
        source: SpecError,
    },
    /// An effect is none that the machine can have.
    #[error(transparent)]
    Effects(#[from] OverlayError),
    /// A controller elsewhere cannot be listened for.
    #[error("{address}: cannot listen for a controller: {source}; {}", gateway::listen_advice(.source))]
    Listen {
        /// Where.
        address: SocketAddr,
        /// Why not.
        source: io::Error,
    },
    /// A controller elsewhere did not answer.
    #[error(
        "no answer from a controller at ws://{address} within {patience:?}: {owed}; does one run, subscribe, and \
         answer each observation once?"
    )]
    Controller {
        /// Where it was listened for.
        address: SocketAddr,
        /// How long it was waited for.
        patience: Duration,
        /// What it owes, in words.
        owed: String,
    },
    /// The log could not be written.
    #[error("cannot write the log: {0}; is the disk full?")]
    Log(#[from] io::Error),
}

/// Name of the bus in the log, as on a real one.
pub const INTERFACE: &str = "vcan0";

impl<W: Write> Lockstep<W> {
    /// Everything at rest at time zero; the log goes to `log`.
    ///
    /// # Errors
    /// [`RunError::Policy`], [`RunError::Effects`].
    pub fn new(setup: &Setup, log: W) -> Result<Self, RunError> {
        let policy_at = || setup.scenario.policy_at.clone();
        let policy =
            setup.policy().map_err(|source| RunError::Policy { policy_at: policy_at(), source })?;
        Self::driven_by(setup, policy, None, log)
    }

    /// The same under a controller elsewhere.
    ///
    /// # Errors
    /// [`RunError::Effects`].
    pub fn with_controller(
        setup: &Setup,
        controller: Controller,
        log: W,
    ) -> Result<Self, RunError> {
        let (policy, talk) = controller.split();
        Self::driven_by(setup, Box::new(policy), Some(talk), log)
    }

    fn driven_by(
        setup: &Setup,
        policy: Box<dyn Policy>,
        talk: Option<Talk>,
        log: W,
    ) -> Result<Self, RunError> {
        let Setup { scenario, machine, overlay, solver, terrain, seed, .. } = setup;
        let mut bus = VirtualBus::new(Bitrate::MBIT_1);
        bus.enable_tap();
        let config = EmulatorConfig {
            effects: overlay.effects(machine)?,
            solver: *solver,
            mishaps: scenario.mishaps(),
            profile: scenario.profile,
            quirks: scenario.quirks,
            operator: scenario.cab.as_ref().map_or_else(Operator::idle, |cab| cab.operator.clone()),
            ..EmulatorConfig::new(machine.clone(), terrain.clone(), Some(*seed))
        };
        let emulator = (bus.attach("emulator"), Emulator::new(&config));
        let gateway = Gateway::new(machine, GatewayConfig::new(machine), policy);
        let gateway = (bus.attach("gateway"), gateway);
        let instant = |seconds| SimTime::ZERO + Duration::from_secs_f64(seconds);
        Ok(Self {
            bus,
            emulator: Some(emulator),
            gateway: Some(gateway),
            talk,
            driven: None,
            events: scenario.events.iter().map(|e| (instant(e.at_s), e.what)).collect(),
            now: SimTime::ZERO,
            end: instant(scenario.duration_s),
            outbox: Outbox::with_capacity(64),
            gnss: Vec::with_capacity(512),
            log: candump::Writer::new(HashingWriter::new(log), INTERFACE),
            decoder: Decoder::default(),
            truth: Truth::default(),
        })
    }

    /// The time up to which the run has come.
    #[must_use]
    pub const fn now(&self) -> SimTime {
        self.now
    }

    /// How long a controller elsewhere held up the run since the last call.
    pub fn take_held_up(&mut self) -> Duration {
        self.talk.as_mut().map_or(Duration::ZERO, Talk::take_held_up)
    }

    /// Share of the run that is done, 0 to 1.
    #[must_use]
    pub fn progress(&self) -> f64 {
        (self.now.as_secs_f64() / self.end.as_secs_f64()).min(1.0)
    }

    /// One tick; false once the run is over and nothing was done. `clock` is read around the
    /// emulator's part, for callers that measure; it says the time since any fixed instant.
    ///
    /// # Errors
    /// The log could not be written, or a controller elsewhere did not answer.
    pub fn tick(
        &mut self,
        clock: &mut dyn FnMut() -> Duration,
    ) -> Result<Option<TickCost>, RunError> {
        if self.now >= self.end {
            return Ok(None);
        }
        let now = self.now;
        self.deliver(now)?;
        self.befall(now);
        let start = clock();
        self.tick_emulator(now);
        let emulator = clock().saturating_sub(start);
        self.tick_gateway(now, clock)?;
        self.now += TICK;
        Ok(Some(TickCost { emulator }))
    }

    /// Lets the last frames end, and gives what was recorded.
    ///
    /// # Errors
    /// The log could not be written.
    pub fn finish(mut self) -> Result<Recording, RunError> {
        self.deliver(self.end)?;
        self.log.flush()?;
        let bus_load = Some(self.bus.load_total());
        Ok(Recording {
            trace: self.decoder.finish(),
            truth: Some(self.truth),
            driven: account(self.gateway.as_ref()).or(self.driven),
            log_sha256: self.log.into_inner().finish(),
            bus_load,
        })
    }

    /// Brings the bus to `now` and writes what was on it.
    fn deliver(&mut self, now: SimTime) -> Result<(), RunError> {
        self.bus.advance(now);
        for sent in self.bus.drain_tap() {
            self.log.write(sent.at, &sent.frame)?;
            self.decoder.push(logged_s(sent.at), &sent.frame);
        }
        Ok(())
    }

    fn befall(&mut self, now: SimTime) {
        for &(_, incident) in self.events.iter().filter(|(at, _)| *at <= now) {
            match incident {
                Incident::Kill(Node::Gateway) => {
                    self.driven = account(self.gateway.take().as_ref());
                }
                Incident::Kill(Node::Emulator) => self.emulator = None,
                Incident::Order(order) => {
                    if let Some((_, gateway)) = &mut self.gateway {
                        gateway.order(match order {
                            GatewayOrder::Arm => Order::Arm,
                            GatewayOrder::EmergencyStop => Order::EmergencyStop,
                        });
                    }
                }
                // The emulator has it from its configuration.
                Incident::Power(_) => {}
            }
        }
        self.events.retain(|(at, _)| *at > now);
    }

    fn tick_emulator(&mut self, now: SimTime) {
        let Some((node, emulator)) = &mut self.emulator else {
            return;
        };
        while let Some(received) = self.bus.receive(*node) {
            emulator.on_frame(received.at, &received.frame);
        }
        self.outbox.clear();
        emulator.tick(now, &mut self.outbox);
        for frame in self.outbox.frames() {
            self.bus.send(*node, now, frame);
        }
        self.gnss.clear();
        emulator.take_gnss(&mut self.gnss);
        self.truth.push((now + TICK).as_secs_f64(), &emulator.truth());
    }

    fn tick_gateway(
        &mut self,
        now: SimTime,
        clock: &mut dyn FnMut() -> Duration,
    ) -> Result<(), RunError> {
        let Some((node, gateway)) = &mut self.gateway else {
            return Ok(());
        };
        while let Some(received) = self.bus.receive(*node) {
            gateway.on_frame(received.at, &received.frame);
        }
        if !self.gnss.is_empty() {
            gateway.on_gnss(now, &self.gnss);
        }
        if let Some(talk) = &mut self.talk {
            talk.hear(now, gateway);
        }
        self.outbox.clear();
        gateway.tick(now, &mut self.outbox);
        for frame in self.outbox.frames() {
            self.bus.send(*node, now, frame);
        }
        match &mut self.talk {
            Some(talk) => talk.show(now, gateway, clock),
            None => Ok(()),
        }
    }
}

fn account(gateway: Option<&(NodeId, Gateway)>) -> Option<Driven> {
    gateway.map(|(_, gateway)| Driven::new(&gateway.status()))
}

/// What one tick took, by the caller's clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TickCost {
    /// The emulator's part: both ECUs and [`STEPS_PER_TICK`] steps of the plant.
    pub emulator: Duration,
}

/// Plant steps in one tick.
pub const STEPS_PER_TICK: u32 = (TICK.as_nanos() / STEP.as_nanos()) as u32;

/// Seconds as the log's own digits say them, so that a run is judged by what its log holds.
fn logged_s(at: SimTime) -> f64 {
    SimTime::from_micros(at.as_nanos() / 1_000).as_secs_f64()
}
