//! What is left of a run: the trace of its log, and the log's figures.

use std::io::BufRead;

use ecu_emu::Profile;
use xt28_bus::candump::{ReadError, Reader};
use xt28_machine::SimTime;

use crate::decode::Decoder;
use crate::{Bound, Conditions, Driven, Finding, Report, Setup, Trace, Truth};

/// One recorded run, on either kind of bus.
#[derive(Clone, Debug)]
pub struct Recording {
    /// What the bus said.
    pub trace: Trace,
    /// What was true, where the runner could see it.
    pub truth: Option<Truth>,
    /// What the gateway said of itself at its end, where it could.
    pub driven: Option<Driven>,
    /// SHA-256 of the candump log, hexadecimal.
    pub log_sha256: String,
    /// Share of the time the bus was taken, 0 to 1, where it has a bit rate.
    pub bus_load: Option<f64>,
}

impl Recording {
    /// A recording from a candump log named `name`; the run began at `start` on the log's clock.
    /// What was on the bus before has times below zero.
    ///
    /// # Errors
    /// The log is cut or damaged; name and line are in the message.
    pub fn read(log: impl BufRead, name: &str, start: SimTime) -> Result<Trace, ReadError> {
        let mut decoder = Decoder::default();
        for received in Reader::new(log, name) {
            let received = received?;
            let before_s = start.since(received.at).as_secs_f64();
            let at_s = received.at.since(start).as_secs_f64() - before_s;
            decoder.push(at_s, &received.frame);
        }
        Ok(decoder.finish())
    }

    /// Judges the run by the scenario's expectations.
    #[must_use]
    pub fn report(&self, setup: &Setup, bus: &str) -> Report {
        let mut findings = setup.judge(&self.trace, self.truth.as_ref());
        // The ECUs of 2016 have nothing that a gateway could arm.
        let unarmed = self.driven.as_ref().filter(|driven| {
            setup.scenario.profile == Profile::Paper && driven.armed_at_s.is_none()
        });
        findings.extend(unarmed.map(|driven| {
            // Nothing was driven, whatever an expectation finds of a machine that stands or slides.
            let why = driven.reason.clone().unwrap_or_default();
            let by = Bound::AtMost(setup.scenario.duration_s);
            Finding::missing("gateway armed", by, "s", why)
        }));
        Report {
            scenario: setup.scenario.name.clone(),
            seed: setup.seed,
            bus: bus.to_owned(),
            conditions: Conditions::new(setup),
            findings,
            driven: self.driven.clone(),
            simulated_s: setup.scenario.duration_s,
            cost: None,
            log_sha256: self.log_sha256.clone(),
            frames: self.trace.frames,
            bus_load: self.bus_load,
        }
    }
}
