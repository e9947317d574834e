//! The machine's supply, and what befalls it: dips, and resets of an ECU.

use serde::{Deserialize, Serialize};
use xt28_machine::SimTime;

/// The machine's battery, mV.
pub(crate) const NOMINAL_MV: f64 = 24_000.0;
/// Most that a dip may leave, V.
const DIP_MAX_V: f64 = 24.0;

/// One of the two ECUs, by its name in the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum EcuName {
    /// Pendulum arms.
    #[serde(rename = "SMS")]
    Sms,
    /// Transmission and steering.
    #[serde(rename = "DMS")]
    Dms,
}

/// Something that befalls an ECU's supply.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct PowerEvent {
    /// When, s from the start.
    pub at_s: f64,
    /// What.
    pub kind: PowerKind,
    /// Whom; both ECUs when left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ecu: Option<EcuName>,
    /// What the supply falls to, V; of a brown-out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to_v: Option<f64>,
    /// For how long, s; of a brown-out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub for_s: Option<f64>,
}

/// What can befall an ECU's supply.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum PowerKind {
    /// The reset line is pulled for a moment; the supply stays.
    Reboot,
    /// The supply falls for a while.
    BrownOut,
}

/// What the supply falls to in a brown-out that does not say, V: what a starter leaves of it.
const DIP_V: f64 = 6.0;
/// For how long, s.
const DIP_S: f64 = 0.1;

impl PowerEvent {
    /// What is wrong with the event, if anything.
    ///
    /// # Errors
    /// One line that says what and what would be right.
    pub fn check(&self) -> Result<(), String> {
        if !(self.at_s >= 0.0 && self.at_s.is_finite()) {
            return Err(format!("at_s = {}: give 0 or more", self.at_s));
        }
        if self.kind == PowerKind::Reboot && (self.to_v.is_some() || self.for_s.is_some()) {
            return Err("a reboot leaves the supply alone; leave out to_v and for_s".to_owned());
        }
        let (to_v, for_s) = (self.to_v.unwrap_or(DIP_V), self.for_s.unwrap_or(DIP_S));
        if !(0.0..=DIP_MAX_V).contains(&to_v) {
            return Err(format!("to_v = {to_v}: give 0 to {DIP_MAX_V}"));
        }
        if !(for_s > 0.0 && for_s.is_finite()) {
            return Err(format!("for_s = {for_s}: give more than 0"));
        }
        Ok(())
    }

    fn concerns(&self, ecu: EcuName) -> bool {
        self.ecu.is_none_or(|named| named == ecu)
    }
}

/// The supplies of both ECUs over a run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Supplies {
    events: Vec<PowerEvent>,
    /// Up to here resets have been carried out.
    reset_to_s: Option<f64>,
    /// When the voltages were last looked at.
    looked_s: Option<f64>,
}

impl Supplies {
    pub(crate) fn new(events: &[PowerEvent]) -> Self {
        Self { events: events.to_vec(), reset_to_s: None, looked_s: None }
    }

    /// Voltages of SMS and DMS at `now`, mV; of a dip that came and went since the last look, what it left: an
    /// ECU does not sleep between two ticks.
    pub(crate) fn voltages_mv(&mut self, now: SimTime) -> [f64; 2] {
        let now_s = now.as_secs_f64();
        let looked_s = self.looked_s.replace(now_s);
        [EcuName::Sms, EcuName::Dms].map(|ecu| {
            let dips = self.events.iter().filter(|event| {
                let (from_s, to_s) = (event.at_s, event.at_s + event.for_s.unwrap_or(DIP_S));
                let is_on = (from_s..to_s).contains(&now_s);
                let was_on = to_s <= now_s && looked_s.is_some_and(|looked_s| from_s > looked_s);
                event.kind == PowerKind::BrownOut && event.concerns(ecu) && (is_on || was_on)
            });
            dips.map(|dip| dip.to_v.unwrap_or(DIP_V) * 1e3).fold(NOMINAL_MV, f64::min)
        })
    }

    /// Which ECUs are reset at `now`, each reset told once: SMS, DMS.
    pub(crate) fn take_resets(&mut self, now: SimTime) -> [bool; 2] {
        let now_s = now.as_secs_f64();
        let done_s = self.reset_to_s.replace(now_s);
        [EcuName::Sms, EcuName::Dms].map(|ecu| {
            self.events.iter().any(|event| {
                event.kind == PowerKind::Reboot
                    && event.concerns(ecu)
                    && event.at_s <= now_s
                    && done_s.is_none_or(|done_s| event.at_s > done_s)
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(at_s: f64, kind: PowerKind, ecu: Option<EcuName>) -> PowerEvent {
        PowerEvent { at_s, kind, ecu, to_v: None, for_s: None }
    }

    #[test]
    fn a_dip_is_of_its_ecu_and_ends() {
        let dip =
            PowerEvent { to_v: Some(5.0), ..event(1.0, PowerKind::BrownOut, Some(EcuName::Sms)) };
        let mut supplies = Supplies::new(&[dip]);
        let mut mv = |ms| supplies.voltages_mv(SimTime::from_millis(ms));
        assert_eq!(mv(990), [24_000.0; 2]);
        assert_eq!([mv(1000), mv(1050), mv(1090)], [[5_000.0, 24_000.0]; 3]);
        assert_eq!(mv(1100), [24_000.0; 2]);
    }

    #[test]
    fn a_dip_between_two_ticks_is_no_less_of_one() {
        let blink = PowerEvent { for_s: Some(0.004), ..event(1.003, PowerKind::BrownOut, None) };
        let mut supplies = Supplies::new(&[blink]);
        let mut mv = |ms| supplies.voltages_mv(SimTime::from_millis(ms));
        let seen = [mv(990), mv(1000), mv(1010), mv(1020)];
        assert_eq!(seen, [[24_000.0; 2], [24_000.0; 2], [6_000.0; 2], [24_000.0; 2]]);
    }

    #[test]
    fn a_reset_is_told_once() {
        let mut supplies = Supplies::new(&[
            event(0.0, PowerKind::Reboot, Some(EcuName::Dms)),
            event(1.0, PowerKind::Reboot, None),
        ]);
        assert_eq!(supplies.take_resets(SimTime::ZERO), [false, true]);
        assert_eq!(supplies.take_resets(SimTime::from_millis(990)), [false, false]);
        assert_eq!(supplies.take_resets(SimTime::from_millis(1000)), [true, true]);
        assert_eq!(supplies.take_resets(SimTime::from_millis(1010)), [false, false]);
    }

    #[test]
    fn senseless_events_are_refused() {
        let reboot = event(1.0, PowerKind::Reboot, None);
        assert!(PowerEvent { for_s: Some(1.0), ..reboot }.check().is_err());
        let dip = event(1.0, PowerKind::BrownOut, None);
        dip.check().unwrap();
        for bad in [
            PowerEvent { at_s: f64::NAN, ..dip },
            PowerEvent { to_v: Some(25.0), ..dip },
            PowerEvent { for_s: Some(0.0), ..dip },
        ] {
            assert!(bad.check().is_err(), "{bad:?}");
        }
    }
}
