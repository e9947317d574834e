//! A controller elsewhere at the wheel of a run in simulated time: the machine waits for its answers.
//!
//! What it is shown at one tick it answers before the next, however long it thinks, so that the same controller
//! drives the same run again.

use std::io;
use std::net::SocketAddr;
use std::time::Duration;

use gateway::policy::External;
use gateway::{Gateway, GatewayConfig, Listen, Remote, Wanted};
use xt28_machine::SimTime;

use crate::{RunError, Setup};

/// The talk with a controller that connects over rosbridge.
#[derive(Debug)]
pub struct Controller {
    remote: Remote,
    patience: Duration,
    wanted: Wanted,
}

impl Controller {
    /// Listens for one, which may take `patience` for each answer, the first among them; the policy is what the
    /// gateway is to drive by. It sees the map that the scenario gives a policy.
    ///
    /// # Errors
    /// The address cannot be listened on.
    pub fn open(setup: &Setup, listen: Listen, patience: Duration) -> io::Result<(Self, External)> {
        let (machine, map) = (&setup.machine, Some(setup.map.clone()));
        let (remote, policy) = Remote::open(listen, machine, &GatewayConfig::new(machine), map)?;
        Ok((Self { remote, patience, wanted: Wanted::default() }, policy))
    }

    /// Where it is listened for.
    #[must_use]
    pub const fn address(&self) -> SocketAddr {
        self.remote.address()
    }

    /// What was refused since the last call.
    pub fn refused(&mut self) -> Vec<String> {
        std::mem::take(&mut self.wanted.refused)
    }

    /// Shows it what the gateway saw at this tick, waits for its answer, and passes on what else it wants.
    ///
    /// # Errors
    /// [`RunError::Controller`] where it does not answer.
    pub(crate) fn follow(&mut self, now: SimTime, gateway: &mut Gateway) -> Result<(), RunError> {
        self.remote.tell(now, &gateway.status());
        let answered = self.remote.wait(now, self.patience, &mut self.wanted);
        let mut late = self.remote.hear(now);
        self.wanted.refused.append(&mut late.refused);
        if let Some(order) = self.wanted.order.take().or(late.order) {
            gateway.order(order);
        }
        if answered {
            return Ok(());
        }
        let refused =
            self.wanted.refused.last().map_or_else(String::new, |why| format!(" ({why})"));
        Err(RunError::Controller { address: self.address(), patience: self.patience, refused })
    }
}
