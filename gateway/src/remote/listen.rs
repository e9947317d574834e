//! Where to listen for a controller, as `--policy` says it.

use std::net::{Ipv4Addr, SocketAddr};

use crate::Pace;
use crate::policy::SpecError;

/// Where a controller is listened for, and when it is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Listen {
    /// Address and port.
    pub address: SocketAddr,
    /// When it is asked.
    pub pace: Pace,
}

impl Listen {
    /// What `spec` says: `rosbridge:PORT` listens to this machine alone, `rosbridge:ADDRESS:PORT` where it says. The
    /// controller is asked at each fix, and with `,tick` behind it at 100 Hz. `None` where it names another policy.
    ///
    /// # Errors
    /// [`SpecError::Address`].
    pub fn parse(spec: &str) -> Result<Option<Self>, SpecError> {
        let Some(rest) = spec.strip_prefix("rosbridge:") else { return Ok(None) };
        let (place, pace) = match rest.strip_suffix(",tick") {
            Some(place) => (place, Pace::Tick),
            None => (rest, Pace::Fix),
        };
        let own = |port: u16| SocketAddr::from((Ipv4Addr::LOCALHOST, port));
        let port = place.strip_prefix("localhost:").unwrap_or(place);
        let address = port.parse().map(own).or_else(|_| place.parse());
        let address = address.map_err(|_| SpecError::Address { spec: spec.to_owned() })?;
        Ok(Some(Self { address, pace }))
    }

    /// Whether nobody but this machine can connect. Where others can, the gateway does not arm by itself: the protocol
    /// does not say who they are.
    #[must_use]
    pub fn is_private(&self) -> bool {
        self.address.ip().is_loopback()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_port_is_this_machines_and_an_address_its_own() {
        let heard = |spec: &str| {
            let listen = Listen::parse(spec).unwrap().unwrap();
            (listen.address.to_string(), listen.pace)
        };
        assert_eq!(heard("rosbridge:9090"), ("127.0.0.1:9090".to_owned(), Pace::Fix));
        assert_eq!(heard("rosbridge:0.0.0.0:80,tick"), ("0.0.0.0:80".to_owned(), Pace::Tick));
        assert_eq!(heard("rosbridge:[::1]:9090").0, "[::1]:9090");
        assert_eq!(heard("rosbridge:localhost:9090").0, "127.0.0.1:9090");
        let private = |spec: &str| Listen::parse(spec).unwrap().unwrap().is_private();
        assert!(
            private("rosbridge:1")
                && private("rosbridge:127.0.0.9:1")
                && private("rosbridge:[::1]:1")
        );
        for open in ["rosbridge:0.0.0.0:1", "rosbridge:[::]:1", "rosbridge:192.168.0.5:1,tick"] {
            assert!(!private(open), "{open}");
        }
        for other in ["hold", "goto:1,2,3", "rosbridge", ""] {
            assert_eq!(Listen::parse(other).unwrap(), None, "{other}");
        }
        for bad in ["rosbridge:", "rosbridge:70000", "rosbridge:localhost", "rosbridge:1,fast"] {
            assert!(
                Listen::parse(bad).unwrap_err().to_string().contains("rosbridge:9090"),
                "{bad}"
            );
        }
    }
}
