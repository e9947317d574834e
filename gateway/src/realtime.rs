//! The loop: frames as they come, a tick every 10 ms on an absolute schedule, no spinning.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant, SystemTime};

use gateway::policy::Account;
use gateway::{
    Gateway, GatewayConfig, Listen, Order, Outcome, Phase, Policy, Reason, Remote, Status,
};
use signal_hook::consts::{SIGINT, SIGTERM, SIGUSR1, SIGUSR2};
use xt28_dbc::Outbox;
use xt28_machine::{Machine, SimTime};
use xt28_terrain::{Terrain, TerrainError, TerrainSpec};

use crate::announcer::{Announcer, announce};
use crate::args::Args;
use crate::freshness::Freshness;
use crate::lateness::Lateness;
use crate::news::News;
use crate::problem::Problem;
use crate::serial::SerialPort;
use crate::wire::Wire;

const TICK: Duration = Duration::from_millis(10);

/// What a run came to.
pub(crate) struct Finished {
    pub(crate) status: Status,
    pub(crate) lateness: Lateness,
    /// Received frames that the kernel dropped before anyone read them; none where it does not say.
    pub(crate) frames_lost: Option<u32>,
    /// Frames of ours that the bus never took.
    pub(crate) frames_discarded: u64,
    /// How a controller elsewhere kept up, where one was to drive.
    pub(crate) controller: Option<Account>,
    /// What went wrong with the host and ended the run.
    pub(crate) broke: Option<Problem>,
    pub(crate) interrupted: bool,
    /// Whether there is a receiver.
    pub(crate) receiver: bool,
    /// What last stood against arming, if it never came to that.
    pub(crate) never_armed: Option<Reason>,
    pub(crate) seconds: f64,
}

/// Runs until the policy is done, the time is over or a signal comes.
pub(crate) fn run(args: &Args) -> Result<(Finished, Announcer), Problem> {
    let machine = match &args.machine {
        Some(path) => Machine::load(path)?,
        None => Machine::xt28(),
    };
    let listen = Listen::parse(&args.policy)?;
    let config = GatewayConfig {
        origin: args.origin,
        fix_least: args.least_fix.into(),
        accuracy_max_m: args.least_accuracy,
        arm_at_start: listen.is_none_or(|listen| listen.is_private()),
        ..GatewayConfig::new(&machine)
    };
    let (policy, remote) = policy(args, listen, &machine, &config)?;
    let port = match &args.gnss {
        Some(path) => Some(
            SerialPort::open(path)
                .map_err(|source| Problem::OpenGnss { path: path.clone(), source })?,
        ),
        None if policy.needs_fixes() => return Err(Problem::NoGnss),
        None => None,
    };
    let interrupt = watch_signals().map_err(Problem::Signals)?;
    let [arm, halt] = [(); 2].map(|()| Arc::new(AtomicBool::new(false)));
    for (signal, flag) in [(SIGUSR1, &arm), (SIGUSR2, &halt)] {
        signal_hook::flag::register(signal, Arc::clone(flag)).map_err(Problem::Signals)?;
    }
    let wire = Wire::open(&args.bus, args.record.as_deref(), SystemTime::now())?;
    if let Some(remote) = &remote {
        announce(&format!("gateway: a controller may connect to ws://{}", remote.address()));
        if !config.arm_at_start {
            announce("gateway: others than this machine may drive, so it arms on SIGUSR1 alone");
        }
    }
    let gateway = Gateway::new(&machine, config, policy);
    let run = Run {
        gateway,
        wire,
        port,
        remote,
        interrupt,
        arm,
        halt,
        start: Instant::now(),
        freshness: Freshness::default(),
        announcer: Announcer::start().map_err(Problem::Thread)?,
        ending: false,
        never_armed: None,
        broke: None,
    };
    Ok(run.until_done(args))
}

/// What drives, and the talk with it where it thinks elsewhere.
fn policy(
    args: &Args,
    listen: Option<Listen>,
    machine: &Machine,
    config: &GatewayConfig,
) -> Result<(Box<dyn Policy>, Option<Remote>), Problem> {
    if args.map.is_some() && !gateway::policy::takes_map(&args.policy) {
        return Err(Problem::MapUnused);
    }
    let map = args.map.as_deref().map(surveyed).transpose()?;
    let Some(listen) = listen else {
        return Ok((gateway::policy::from_spec(&args.policy, machine, map.as_ref())?, None));
    };
    let (remote, policy) = Remote::open(listen, machine, config, map)
        .map_err(|source| Problem::Listen { address: listen.address, source })?;
    Ok((Box::new(policy), Some(remote)))
}

/// The ground as the file says that a policy is given it: with what its map leaves out.
fn surveyed(path: &Path) -> Result<Terrain, TerrainError> {
    let spec = TerrainSpec::load(path)?;
    spec.build_map(&spec.build()?)
}

/// A flag that SIGINT and SIGTERM raise. Whoever asks twice is not kept waiting, and has the log to within a tick.
fn watch_signals() -> std::io::Result<Arc<AtomicBool>> {
    let flag = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        signal_hook::flag::register_conditional_shutdown(signal, 1, Arc::clone(&flag))?;
        signal_hook::flag::register(signal, Arc::clone(&flag))?;
    }
    Ok(flag)
}

struct Run {
    gateway: Gateway,
    wire: Wire,
    port: Option<SerialPort>,
    /// A controller elsewhere, where one drives.
    remote: Option<Remote>,
    interrupt: Arc<AtomicBool>,
    /// Raised by SIGUSR1: the order to arm again, after a stop that somebody has looked at.
    arm: Arc<AtomicBool>,
    /// Raised by SIGUSR2: the emergency stop, which only a new run releases.
    halt: Arc<AtomicBool>,
    start: Instant,
    freshness: Freshness,
    announcer: Announcer,
    /// The order to disarm was given.
    ending: bool,
    never_armed: Option<Reason>,
    /// What ends the run, but leaves the bus to stop the machine by.
    broke: Option<Problem>,
}

impl Run {
    fn until_done(mut self, args: &Args) -> (Finished, Announcer) {
        let mut lateness = Lateness::new();
        let broke = self.go_on(args, &mut lateness).err();
        let status = self.gateway.status();
        let interrupted = self.interrupt.load(Ordering::Relaxed);
        let seconds = self.start.elapsed().as_secs_f64();
        let (frames_lost, frames_discarded) = (self.wire.lost(), self.wire.discarded());
        let closed = self.wire.close().err();
        let finished = Finished {
            status,
            lateness,
            frames_lost,
            frames_discarded,
            controller: self.remote.as_ref().map(Remote::account),
            broke: broke.or(self.broke).or(closed),
            interrupted,
            receiver: args.gnss.is_some(),
            never_armed: self.never_armed,
            seconds,
        };
        (finished, self.announcer)
    }

    /// Ticks until the run is over and the machine left in peace.
    fn go_on(&mut self, args: &Args, lateness: &mut Lateness) -> Result<(), Problem> {
        let mut out = Outbox::with_capacity(8);
        let mut bytes = [0; 4096];
        let mut news = News::new();
        let mut due = Duration::ZERO;
        loop {
            self.listen_until(due)?;
            let now = self.start.elapsed();
            lateness.note(now.saturating_sub(due));
            self.read_gnss(&mut bytes);
            self.tick(now, &mut out)?;
            if let Some(what) = news.of(now, &self.gateway.status()) {
                self.announcer.say(format!("{:8.2} s  {what}", now.as_secs_f64()));
            }
            self.end_if_due(now, args);
            if self.ending && self.gateway.is_silent() {
                return Ok(());
            }
            due += TICK;
            // The schedule is absolute; a tick whose successor is due already is not made up for.
            let now = self.start.elapsed();
            while due + TICK <= now {
                due += TICK;
                lateness.missed += 1;
            }
        }
    }

    /// Takes frames until `due`, asleep in between.
    fn listen_until(&mut self, due: Duration) -> Result<(), Problem> {
        loop {
            let start = self.start;
            let looked = start.elapsed();
            let emptied = self.freshness.last_look();
            while let Some(frame) = self.wire.receive(|| start.elapsed(), emptied)? {
                let at = self.freshness.came_in(start.elapsed());
                self.gateway.on_frame(sim_time(at), &frame);
            }
            self.freshness.looked(looked);
            let left = due.saturating_sub(self.start.elapsed());
            if left.is_zero() {
                return Ok(());
            }
            self.wire.wait(left, || start.elapsed())?;
        }
    }

    fn read_gnss(&mut self, bytes: &mut [u8]) {
        let Some(port) = &mut self.port else { return };
        let at = sim_time(self.freshness.came_in(self.start.elapsed()));
        match port.drain(bytes, |bytes| self.gateway.on_gnss(at, bytes)) {
            Ok(false) => {}
            Ok(true) => self.announcer.say("gateway: the receiver's port was closed".to_owned()),
            Err(error) => {
                self.port = None;
                self.broke = Some(Problem::ReadGnss(error));
            }
        }
    }

    fn tick(&mut self, now: Duration, out: &mut Outbox) -> Result<(), Problem> {
        self.gateway.on_bus(self.wire.is_well());
        let asked = self.arm.swap(false, Ordering::Relaxed) && !self.ending;
        if asked {
            self.gateway.order(Order::Arm);
        }
        if self.halt.load(Ordering::Relaxed) {
            self.gateway.order(Order::EmergencyStop);
        }
        out.clear();
        self.hear_controller();
        // Receiver bytes, frames and answers came in up to here.
        let now = sim_time(now.max(self.start.elapsed()));
        let ran = matches!(self.gateway.status().phase, Phase::Armed);
        self.gateway.tick(now, out);
        let status = self.gateway.status();
        if let (true, Phase::Disarmed | Phase::Blocked(_), Some(why)) =
            (asked, status.phase, status.blocked)
        {
            self.announcer.say(format!(
                "{:8.2} s  not armed: {}",
                now.as_secs_f64(),
                status.told(why)
            ));
        }
        if ran && !matches!(status.phase, Phase::Armed) {
            // What a full queue still holds would move the machine once the bus takes it again.
            self.wire.discard_waiting();
        }
        out.frames().iter().try_for_each(|frame| self.wire.send(now, frame))?;
        // After the frames, which nobody's observation delays.
        if let Some(remote) = &mut self.remote {
            remote.tell(now, &status);
        }
        Ok(())
    }

    /// Takes what a controller elsewhere has said.
    fn hear_controller(&mut self) {
        let Some(remote) = &mut self.remote else { return };
        let now = sim_time(self.start.elapsed());
        let wanted = remote.hear(now);
        wanted.order.into_iter().for_each(|order| self.gateway.order(order));
        for what in wanted.news {
            self.announcer.say(format!("{:8.2} s  controller: {what}", now.as_secs_f64()));
        }
    }

    /// Gives the order to disarm once, when there is a reason to stop.
    fn end_if_due(&mut self, now: Duration, args: &Args) {
        if self.ending {
            return;
        }
        let seconds = now.as_secs_f64();
        let status = self.gateway.status();
        let task_over = matches!(status.outcome, Outcome::Reached | Outcome::Failed(_));
        let over = match args.duration {
            Some(duration) => seconds >= duration,
            None => task_over || matches!(status.phase, Phase::Blocked(_)),
        };
        let never_armed = status.armed_at.is_none() && seconds >= args.arm_within;
        let broke = self.broke.is_some() || !self.wire.log_is_whole();
        if over || never_armed || broke || self.interrupt.load(Ordering::Relaxed) {
            self.ending = true;
            self.never_armed = status.blocked.filter(|_| status.armed_at.is_none());
            // A block is an end of its own; its reason stays to be told.
            if !matches!(status.phase, Phase::Blocked(_)) {
                self.gateway.order(Order::Disarm);
            }
        }
    }
}

fn sim_time(since_start: Duration) -> SimTime {
    SimTime::ZERO + since_start
}
