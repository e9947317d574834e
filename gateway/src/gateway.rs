//! The gateway's core: observe, ask the policy, hold to the limits, send. No clock, no socket.

use xt28_dbc::messages::{ArmStatus, ArmTarget, ArmValve, DriveStatus, DriveTarget};
use xt28_dbc::{EncodeError, Frame, Outbox};
use xt28_machine::{Machine, PerWheel, SimTime};
use xt28_safety::{Command, Input, Measured, Order, Phase, Stamps, State, Verdict, step};
use xt28_ubx::LocalFrame;

use crate::epoch::{Epoch, EpochCollector, Quality};
use crate::frames::{self, Drive, FrameWriter};
use crate::peer::Peer;
use crate::policy::{Answer, held};
use crate::sensors::Sensors;
use crate::status::{Status, Stops, Tally};
use crate::trust::{trusted, trusts_loads, turning_rad_s};
use crate::{Action, ActionMap, GatewayConfig, Located, Observation, Outcome, Pace, Policy, Pose};

/// After a stop, neutral frames go on for this long, so that the machine is brought to rest and not
/// left to the ECUs' deadlines; then silence.
const NEUTRAL_TICKS: u32 = 150;
/// One period, ns.
const TICK_NS: u64 = 10_000_000;

/// The gateway, to be fed frames, receiver bytes and ticks of 10 ms.
pub struct Gateway {
    config: GatewayConfig,
    wheel_radius_m: f64,
    antenna_m: [f64; 3],
    map: ActionMap,
    frame: LocalFrame,
    policy: Box<dyn Policy>,
    sensors: Sensors,
    arm_ecu: Peer,
    drive_ecu: Peer,
    epochs: EpochCollector,
    /// The newest epoch not yet handled, and when it was complete.
    fresh: Option<(SimTime, Epoch)>,
    located: Option<Located>,
    quality: Option<Quality>,
    /// What the policy wants, and the arming that it saw as it wanted it.
    request: Option<(Command, Option<SimTime>)>,
    stamps: Stamps,
    kernel: State,
    order: Order,
    auto_arm: bool,
    armed_at: Option<SimTime>,
    verdict: Verdict,
    stops: Stops,
    neutral_left: u32,
    writer: FrameWriter,
    bus_ok: bool,
    /// When a command of somebody else's was heard last.
    rival_at: Option<SimTime>,
    tally: Tally,
}

impl Gateway {
    /// A disarmed gateway.
    #[must_use]
    pub fn new(machine: &Machine, config: GatewayConfig, policy: Box<dyn Policy>) -> Self {
        Self {
            wheel_radius_m: machine.wheels.radius_m,
            antenna_m: machine.sensors.gnss_antenna_m,
            map: ActionMap::new(machine),
            frame: LocalFrame::new(config.origin),
            policy,
            sensors: Sensors::new(),
            arm_ecu: Peer::default(),
            drive_ecu: Peer::default(),
            epochs: EpochCollector::default(),
            fresh: None,
            located: None,
            quality: None,
            request: None,
            stamps: Stamps::default(),
            kernel: State::new(),
            order: Order::None,
            auto_arm: config.arm_at_start,
            armed_at: None,
            verdict: Verdict::Block(xt28_safety::Reason::Disarmed),
            stops: Stops::default(),
            neutral_left: 0,
            writer: FrameWriter::new(machine.drive.engine_speed_rpm),
            bus_ok: true,
            rival_at: None,
            tally: Tally::default(),
            config,
        }
    }

    /// A frame from the bus.
    pub fn on_frame(&mut self, now: SimTime, frame: &Frame) {
        match frame.id() {
            ArmStatus::ID => self.arm_ecu.on_status(now, ArmStatus::decode(frame)),
            DriveStatus::ID => self.drive_ecu.on_status(now, DriveStatus::decode(frame)),
            // Nobody hears its own frames.
            ArmTarget::ID | ArmValve::ID | DriveTarget::ID => self.rival_at = Some(now),
            _ => self.sensors.on_frame(now, frame),
        }
    }

    /// Bytes from the receiver, in any portions.
    pub fn on_gnss(&mut self, now: SimTime, bytes: &[u8]) {
        self.tally.gnss_bytes += bytes.len() as u64;
        if let Some(epoch) = self.epochs.push(bytes) {
            let overtaken = self.fresh.replace((now, epoch));
            self.tally.fixes_overtaken += u64::from(overtaken.is_some());
        }
    }

    /// Whether the bus can carry frames. A fault stops the kernel, which then needs a new order.
    pub const fn on_bus(&mut self, ok: bool) {
        self.bus_ok = ok;
        if !ok {
            self.neutral_left = 0;
        }
    }

    /// An order to the safety kernel, carried out at the next tick. Of several that wait for one tick the
    /// safest is carried out: emergency stop, disarm, release, arm. After the first two the gateway does
    /// not arm by itself any more.
    pub fn order(&mut self, order: Order) {
        if precedence(order) >= precedence(self.order) {
            self.order = order;
        }
        self.auto_arm &= !matches!(order, Order::EmergencyStop | Order::Disarm);
    }

    /// One period of 10 ms: at most one round of frames is added to `out`.
    pub fn tick(&mut self, now: SimTime, out: &mut Outbox) {
        let fresh = self.fresh.take();
        let located = fresh.as_ref().and_then(|(at, epoch)| self.locate(*at, epoch));
        self.ask(now, located);
        let was = self.kernel.phase();
        let input = self.input(now);
        self.order = Order::None;
        (self.kernel, self.verdict) =
            step(&self.config.limits, self.kernel, &input, now.as_nanos());
        self.follow(now, was);
        let sent = match self.verdict {
            Verdict::Allow(command) => {
                self.tally.allowed += 1;
                self.writer.actuate(&command, Drive::Enabled, out)
            }
            Verdict::Clamp(command, _) => {
                self.tally.clamped += 1;
                self.writer.actuate(&command, Drive::Enabled, out)
            }
            Verdict::Block(_) => self.stay_neutral(now, out),
        };
        self.note(sent);
        // After the commands: a node's frames leave in the order in which they were queued, and behind
        // these of low priority a command waited for the whole bus.
        if let Some((at, epoch)) = fresh {
            let antenna = self.frame.to_local(epoch.position);
            let latency_s = now.since(at).as_secs_f64();
            frames::fix(&epoch, antenna, latency_s, out)
                .into_iter()
                .for_each(|sent| self.note(sent));
        }
    }

    /// How things stand.
    #[must_use]
    pub fn status(&self) -> Status {
        let (parsed, fixes_incomplete) = self.epochs.counts();
        Status {
            phase: self.kernel.phase(),
            blocked: match self.verdict {
                Verdict::Block(reason) => Some(reason),
                Verdict::Allow(_) | Verdict::Clamp(..) => None,
            },
            stops: self.stops,
            outcome: self.outcome(),
            armed_at: self.armed_at,
            located: self.located,
            quality: self.quality,
            arm_ecu: self.arm_ecu.report(),
            drive_ecu: self.drive_ecu.report(),
            counts: Tally {
                fixes_incomplete,
                gnss_messages: parsed.messages + parsed.other,
                gnss_faults: parsed.bad_checksum + parsed.malformed + parsed.oversize,
                frames_refused: self.sensors.refused()
                    + self.arm_ecu.refused()
                    + self.drive_ecu.refused(),
                ..self.tally
            },
        }
    }

    /// How the policy's task stands.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        self.policy.outcome()
    }

    /// True while no frame to the ECUs leaves and none is about to.
    #[must_use]
    pub const fn is_silent(&self) -> bool {
        self.neutral_left == 0
            && matches!(self.kernel.phase(), Phase::Disarmed | Phase::Blocked(_))
            && matches!(self.order, Order::None)
    }

    /// Handles the newest epoch, whose last byte came in at `at`: says where the machine is if it can.
    fn locate(&mut self, at: SimTime, epoch: &Epoch) -> Option<Located> {
        let antenna = self.frame.to_local(epoch.position);
        self.quality = Some(epoch.quality);
        if !self.config.may_drive_by(&epoch.quality) {
            self.tally.fixes_refused += 1;
            return None;
        }
        let Some(heading_rad) = epoch.heading_rad else {
            self.tally.fixes_without_heading += 1;
            return None;
        };
        let attitude = self.sensors.attitude();
        let pose = Pose::under_antenna(antenna, self.antenna_m, heading_rad, attitude);
        let located = Located { at, pose, velocity_m_s: epoch.velocity_m_s };
        self.located = Some(located);
        self.tally.fixes += 1;
        Some(located)
    }

    /// Takes an answer that has come in, and asks the policy, if it is its time.
    fn ask(&mut self, now: SimTime, located: Option<Located>) {
        if let Some(Answer { command, sensed_at }) = self.policy.answer() {
            // One from before this arming, however late it comes, was of another machine.
            let armed_at = self.armed_now().filter(|armed_at| sensed_at >= *armed_at);
            self.request = Some((command, armed_at));
            // Not when it came: a controller that falls behind is as good as silent.
            self.stamps.policy_ns = Some(sensed_at.as_nanos());
        }
        let sensed_at = match self.policy.pace() {
            Pace::Fix => located.map(|located| located.at),
            Pace::Tick => self.sensors.oldest_at(),
        };
        let whole = self.sensors.complete(now) && trusts_loads(&self.arm_ecu);
        let Some(sensed_at) = sensed_at.filter(|_| whole) else { return };
        let seen = self.observe(now, sensed_at);
        self.stamps.observation_ns = Some(sensed_at.as_nanos());
        if let Some(command) = self.policy.act(&seen) {
            self.request = Some((command, self.armed_now()));
            self.stamps.policy_ns = Some(now.as_nanos());
        }
    }

    fn observe(&mut self, now: SimTime, sensed_at: SimTime) -> Observation {
        let means = self.sensors.take_means();
        let previous_action = match &self.request {
            Some((wanted, _)) => self.map.action(wanted, &means.stroke_m),
            None => Action::default(),
        };
        let armed_at = self.armed_now();
        let lost = self.config.limits.observation;
        Observation {
            at: now,
            sensed_at,
            since_arming_s: armed_at.map(|at| now.since(at).as_secs_f64()),
            located: self
                .located
                .filter(|located| !lost.missed(Some(located.at.as_nanos()), now.as_nanos())),
            attitude: means.attitude,
            stroke_m: means.stroke_m,
            load_n: means.load_n,
            wheel_speed_rad_s: means.wheel_speed_rad_s,
            wheel_speed_m_s: self.speed_m_s(&means.wheel_speed_rad_s),
            front_joint_rad: means.front_joint_rad,
            rear_joint_rad: means.rear_joint_rad,
            previous_action,
        }
    }

    /// When the kernel was armed, while it is.
    fn armed_now(&self) -> Option<SimTime> {
        self.armed_at.filter(|_| self.kernel.is_armed())
    }

    /// What the policy wants, given what it has seen since the kernel was armed; before that, nothing but its brake.
    fn requested(&self, joint_rad: f64) -> Option<Command> {
        let (command, seen_armed) = self.request?;
        let moves = seen_armed.is_some() && seen_armed == self.armed_now();
        // What is not finite the kernel has to see.
        let as_it_is = moves || !command.is_finite() || !joint_rad.is_finite();
        Some(if as_it_is { command } else { held(joint_rad, command.brake) })
    }

    /// The brake is on, or is told to be.
    fn is_braked(&self) -> bool {
        self.writer.is_braking() || self.drive_ecu.is_braked()
    }

    fn measured(&self) -> Measured {
        let said = self.sensors.measured(|wheel_rad_s| self.speed_m_s(wheel_rad_s));
        trusted(said, &self.arm_ecu, &self.drive_ecu)
    }

    /// Speed by the wheels.
    fn speed_m_s(&self, wheel_rad_s: &PerWheel<f64>) -> f64 {
        turning_rad_s(wheel_rad_s, &self.drive_ecu) * self.wheel_radius_m
    }

    fn input(&self, now: SimTime) -> Input {
        let order = if self.auto_arm && matches!(self.order, Order::None) {
            Order::Arm
        } else {
            self.order
        };
        let (sent, measured) = (self.writer.sent(), self.measured());
        Input {
            order,
            request: self.requested(measured.front_angle_rad),
            measured,
            is_braked: self.is_braked(),
            arm: self.arm_ecu.link(sent.map(|(arm, _)| arm)),
            drive: self.drive_ecu.link(sent.map(|(_, drive)| drive)),
            stamps: Stamps {
                sensors_ns: self.sensors.oldest_at().map(SimTime::as_nanos),
                ..self.stamps
            },
            bus_ok: self.bus_ok,
            // As long as an ECU's silence is waited for: then the other one is gone.
            alone: self
                .config
                .limits
                .status
                .missed(self.rival_at.map(SimTime::as_nanos), now.as_nanos()),
        }
    }

    /// Keeps what changes with the kernel's phase.
    fn follow(&mut self, now: SimTime, was: Phase) {
        let is = self.kernel.phase();
        if is == was {
            return;
        }
        match is {
            Phase::Handshake { .. } => {
                // Once: after a hazard somebody has to look before it goes on.
                self.auto_arm = false;
                self.neutral_left = NEUTRAL_TICKS;
            }
            Phase::Armed => {
                self.armed_at = Some(now);
                self.neutral_left = NEUTRAL_TICKS;
            }
            Phase::Blocked(reason) => {
                self.stops.note(now, reason);
            }
            Phase::Disarmed => {}
        }
    }

    /// Frames that move nothing: through the handshake, and for a while after a stop. They close the brake on a
    /// machine that stands, and open none.
    fn stay_neutral(&mut self, now: SimTime, out: &mut Outbox) -> Result<(), EncodeError> {
        if self.neutral_left == 0 || !self.bus_ok {
            self.writer.silence();
            return Ok(());
        }
        let since_ns = if let Phase::Handshake { since_ns, .. } = self.kernel.phase() {
            now.as_nanos().saturating_sub(since_ns)
        } else {
            self.neutral_left -= 1;
            u64::from(NEUTRAL_TICKS - self.neutral_left) * TICK_NS
        };
        let measured = self.measured();
        let limits = &self.config.limits;
        let standing = measured.speed_m_s.abs() <= limits.brake_speed_m_s;
        // Without a joint reading the middle is as good as any: neutral frames steer nothing.
        let joint_rad = measured.front_angle_rad;
        let rest = Command::rest(if joint_rad.is_finite() { joint_rad } else { 0.0 });
        let brake = self.is_braked() || standing || since_ns > limits.brake_wait_ns;
        self.writer.actuate(&Command { brake, ..rest }, Drive::Neutral, out)
    }

    fn note(&mut self, sent: Result<(), EncodeError>) {
        self.tally.frames_unsent += u64::from(sent.is_err());
    }
}

/// Which of two orders for one tick is carried out.
const fn precedence(order: Order) -> u8 {
    match order {
        Order::None => 0,
        Order::Arm => 1,
        Order::Release => 2,
        Order::Disarm => 3,
        Order::EmergencyStop => 4,
    }
}

impl core::fmt::Debug for Gateway {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Gateway").field("status", &self.status()).finish_non_exhaustive()
    }
}
