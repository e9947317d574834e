//! Something that befalls the bench at an instant, as a scenario file says it.

use std::fmt;

use ecu_emu::{EcuName, PowerEvent, PowerKind};
use serde::Deserialize;

/// One event.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Keys")]
pub struct Event {
    /// When, s from the start.
    pub at_s: f64,
    /// What.
    pub what: Incident,
}

/// What can befall the bench.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Incident {
    /// A program dies without a word (`kill`).
    Kill(Node),
    /// An ECU's supply dips, or its reset line is pulled (`kind`, `ecu`, `to_v`, `for_s`).
    Power(PowerEvent),
    /// Somebody gives the gateway an order (`order`).
    Order(GatewayOrder),
}

/// A program on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Node {
    /// The gateway.
    Gateway,
    /// The emulator of the two ECUs.
    Emulator,
}

/// What somebody can order the gateway to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum GatewayOrder {
    /// To begin the handshake.
    Arm,
    /// To stop, and to arm no more.
    #[serde(rename = "emergency-stop")]
    EmergencyStop,
}

/// The keys of an event.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Keys {
    at_s: f64,
    kill: Option<Node>,
    kind: Option<PowerKind>,
    ecu: Option<EcuName>,
    to_v: Option<f64>,
    for_s: Option<f64>,
    order: Option<GatewayOrder>,
}

impl TryFrom<Keys> for Event {
    type Error = String;

    fn try_from(keys: Keys) -> Result<Self, String> {
        let Keys { at_s, kill, kind, ecu, to_v, for_s, order } = keys;
        let of_power = ecu.is_some() || to_v.is_some() || for_s.is_some();
        let what = match (kill, kind, order) {
            (Some(node), None, None) if !of_power => Incident::Kill(node),
            (None, None, Some(order)) if !of_power => Incident::Order(order),
            (None, Some(kind), None) => {
                let event = PowerEvent { at_s, kind, ecu, to_v, for_s };
                event.check()?;
                Incident::Power(event)
            }
            _ => {
                return Err("an event is one thing: give `kill`, or `order`, or `kind` (with \
                            `ecu`, `to_v`, `for_s`)"
                    .to_owned());
            }
        };
        Ok(Self { at_s, what })
    }
}

impl fmt::Display for Incident {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Kill(Node::Gateway) => f.write_str("gateway dies"),
            Self::Kill(Node::Emulator) => f.write_str("emulator dies"),
            Self::Order(GatewayOrder::Arm) => f.write_str("order to arm"),
            Self::Order(GatewayOrder::EmergencyStop) => f.write_str("emergency stop"),
            Self::Power(event) => {
                f.write_str(match event.ecu {
                    Some(EcuName::Sms) => "SMS ",
                    Some(EcuName::Dms) => "DMS ",
                    None => "both ECUs ",
                })?;
                f.write_str(match event.kind {
                    PowerKind::Reboot => "reset",
                    PowerKind::BrownOut => "browned out",
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Event, String> {
        toml::from_str(text).map_err(|error| error.message().to_owned())
    }

    #[test]
    fn an_event_is_one_thing() {
        let said = |text: &str| parse(text).map(|event| event.what.to_string());
        assert_eq!(said("at_s = 1\nkill = \"gateway\"").unwrap(), "gateway dies");
        assert_eq!(said("at_s = 1\norder = \"arm\"").unwrap(), "order to arm");
        let halt = "at_s = 1\norder = \"emergency-stop\"";
        assert_eq!(said(halt).unwrap(), "emergency stop");
        let dip = "at_s = 1\nkind = \"brown-out\"\necu = \"SMS\"\nto_v = 5\nfor_s = 0.2";
        assert_eq!(said(dip).unwrap(), "SMS browned out");
        assert_eq!(said("at_s = 1\nkind = \"reboot\"").unwrap(), "both ECUs reset");
        for bad in [
            "at_s = 1",
            "at_s = 1\nkill = \"gateway\"\norder = \"arm\"",
            "at_s = 1\nkill = \"gateway\"\necu = \"SMS\"",
        ] {
            assert!(parse(bad).unwrap_err().contains("one thing"), "{bad}");
        }
        let reboot = parse("at_s = 1\nkind = \"reboot\"\nfor_s = 1").unwrap_err();
        assert!(reboot.contains("leave out"), "{reboot}");
    }
}
