//! A controller elsewhere at the wheel of a run in simulated time.
//!
//! The machine waits for it: what it is shown at one tick it answers before the next, however long it thinks, so that
//! the same controller drives the same run again. Or it does not, once it has begun: then the run is paced by wall time,
//! and a controller that is too slow is found out as on the machine.

use std::net::SocketAddr;
use std::time::Duration;

use gateway::policy::External;
use gateway::{Gateway, GatewayConfig, Order, Phase, Reason, Remote, Waited, Wanted};
use xt28_machine::SimTime;

use crate::{RunError, Setup};

/// How long a controller is waited for before that is said.
const REMIND_AFTER: Duration = Duration::from_secs(2);

/// How much patience a run has with its controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Terms {
    /// How long it may take to connect, and for each answer that is waited for.
    pub patience: Duration,
    /// Whether each answer is waited for, or the first alone.
    pub waits_for_each: bool,
}

/// Hears what is to be said of a controller on the way: at which time of the run, and what.
pub type Hearer = Box<dyn FnMut(SimTime, &str) + Send>;

/// A controller that is listened for, to drive one run.
pub struct Controller {
    policy: External,
    talk: Talk,
}

/// The talk with it while it drives.
pub(crate) struct Talk {
    remote: Remote,
    terms: Terms,
    hearer: Hearer,
    held_up: Duration,
}

impl Controller {
    /// Listens for one, where the scenario is driven by one. It sees the map that the scenario gives a policy.
    ///
    /// # Errors
    /// [`RunError::Policy`], and [`RunError::Listen`] where the address cannot be listened on.
    pub fn open(setup: &Setup, terms: Terms, hearer: Hearer) -> Result<Option<Self>, RunError> {
        let policy_at = || setup.scenario.policy_at.clone();
        let listen =
            setup.listen().map_err(|source| RunError::Policy { policy_at: policy_at(), source })?;
        let Some(listen) = listen else { return Ok(None) };
        let (machine, map) = (&setup.machine, Some(setup.map.clone()));
        let config = GatewayConfig::new(machine);
        let (remote, policy) = Remote::open(listen, machine, &config, map)
            .map_err(|source| RunError::Listen { address: listen.address, source })?;
        let talk = Talk { remote, terms, hearer, held_up: Duration::ZERO };
        Ok(Some(Self { policy, talk }))
    }

    /// Where it is listened for.
    #[must_use]
    pub const fn address(&self) -> SocketAddr {
        self.talk.remote.address()
    }

    /// What the gateway drives by, and what the run does around it.
    pub(crate) fn split(self) -> (External, Talk) {
        (self.policy, self.talk)
    }
}

impl Talk {
    /// How long the run was held up since the last call, for a pace by wall time to begin anew from there.
    pub(crate) const fn take_held_up(&mut self) -> Duration {
        std::mem::replace(&mut self.held_up, Duration::ZERO)
    }

    /// Takes what has come in since the last tick. Before the gateway's.
    pub(crate) fn hear(&mut self, now: SimTime, gateway: &mut Gateway) {
        let wanted = self.remote.hear(now);
        self.pass_on(now, wanted, gateway);
    }

    /// Shows it what the gateway saw at this tick, and waits for its answer. After the gateway's.
    ///
    /// # Errors
    /// [`RunError::Controller`] where it does not answer.
    pub(crate) fn show(
        &mut self,
        now: SimTime,
        gateway: &mut Gateway,
        clock: &mut dyn FnMut() -> Duration,
    ) -> Result<(), RunError> {
        let status = gateway.status();
        self.remote.tell(now, &status);
        let halted = matches!(status.phase, Phase::Blocked(Reason::EmergencyStop));
        let waits = self.terms.waits_for_each || !self.remote.has_driver();
        if halted || !waits {
            return Ok(());
        }
        let begun = clock();
        let answered = self.wait(now, gateway, clock);
        self.held_up += clock().saturating_sub(begun);
        answered
    }

    fn wait(
        &mut self,
        now: SimTime,
        gateway: &mut Gateway,
        clock: &mut dyn FnMut() -> Duration,
    ) -> Result<(), RunError> {
        let (begun, mut in_vain, mut reminded) = (clock(), Duration::ZERO, false);
        loop {
            let waited = clock().saturating_sub(begun).max(in_vain);
            let next =
                if reminded { self.terms.patience } else { REMIND_AFTER.min(self.terms.patience) };
            let patience = next.saturating_sub(waited);
            match self.remote.wait(now, patience) {
                Waited::OwesNothing => return Ok(()),
                Waited::For(wanted) => {
                    if self.pass_on(now, wanted, gateway) {
                        return Ok(());
                    }
                }
                Waited::InVain => in_vain = waited.max(next),
            }
            if in_vain >= self.terms.patience {
                let (address, patience) = (self.remote.address(), self.terms.patience);
                return Err(RunError::Controller { address, patience, owed: self.owed() });
            }
            if in_vain >= REMIND_AFTER && !reminded {
                reminded = true;
                let still = format!("still waiting: {}", self.owed());
                (self.hearer)(now, &still);
            }
        }
    }

    /// What the run waits for, in words.
    fn owed(&self) -> String {
        match self.remote.owed() {
            (seq, 0) => format!("nobody has answered an observation yet ({seq} is asked)"),
            (seq, answered) => {
                format!("observation {seq} is not answered, {answered} was the last")
            }
        }
    }

    /// Tells the news, and gives the gateway the order that was wanted; true if that was to stop.
    fn pass_on(&mut self, now: SimTime, wanted: Wanted, gateway: &mut Gateway) -> bool {
        for what in &wanted.news {
            (self.hearer)(now, what);
        }
        let order = wanted.order.inspect(|order| gateway.order(*order));
        matches!(order, Some(Order::EmergencyStop))
    }
}
