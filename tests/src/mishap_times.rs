//! When events and faults come: a run that ends before them would pass without them.

use ecu_emu::{SensorFault, TICK};

use crate::places::Places;
use crate::{Event, Scenario};

impl Scenario {
    /// The first event or fault that makes no sense, or that would come after the run: its line, and what is
    /// wrong.
    pub(crate) fn mishap_problem(&self, text: &str) -> Option<(usize, String)> {
        let places = Places::of(text);
        let of_event = |(index, event): (usize, &Event)| {
            let problem = self.never_comes("at_s", event.at_s)?;
            Some((places.event(index, "at_s", text), problem))
        };
        let of_fault = |(index, fault): (usize, &SensorFault)| match fault.check() {
            Ok(()) => {
                let (key, problem) = self.fault_time_problem(fault)?;
                Some((places.fault(index, key, text), problem))
            }
            Err(problem) => {
                Some((places.fault(index, "sensor", text), format!("[[fault]]: {problem}")))
            }
        };
        let mut events = self.events.iter().enumerate();
        let mut faults = self.faults.iter().enumerate();
        events.find_map(of_event).or_else(|| faults.find_map(of_fault))
    }

    /// The key of `fault` that lies outside the run, and what is wrong with it.
    fn fault_time_problem(&self, fault: &SensorFault) -> Option<(&'static str, String)> {
        if let Some(problem) = self.never_comes("from_s", fault.from_s) {
            return Some(("from_s", problem));
        }
        let problem = self.outside("to_s", fault.to_s?)?;
        Some(("to_s", format!("{problem}; leave it out if the fault stays")))
    }

    fn outside(&self, key: &str, at_s: f64) -> Option<String> {
        let duration_s = self.duration_s;
        let is_outside = !(0.0..=duration_s).contains(&at_s);
        is_outside.then(|| format!("{key} = {at_s} lies outside the run, 0 to {duration_s}"))
    }

    /// Why what is to come at `at_s` never would: it comes with the first tick at or after that.
    fn never_comes(&self, key: &str, at_s: f64) -> Option<String> {
        let outside = self.outside(key, at_s);
        if outside.is_some() {
            return outside;
        }
        let [at, end] = [at_s, self.duration_s].map(nanos);
        let tick = TICK.as_nanos();
        let last_tick = end.saturating_sub(1) / tick * tick;
        #[allow(clippy::cast_precision_loss)] // an hour
        let last_s = (last_tick / 1_000_000) as f64 / 1e3;
        (at > last_tick).then(|| {
            format!("{key} = {at_s} is behind the run's last tick: no tick follows; give at most {last_s}")
        })
    }
}

/// On the run's own clock, which is not the decimal of the file.
fn nanos(at_s: f64) -> u128 {
    core::time::Duration::from_secs_f64(at_s).as_nanos()
}
