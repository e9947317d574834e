//! What can be wrong with an interface, in one line each, with the remedy.

use std::fmt;
use std::io;

/// An interface could not be opened.
#[derive(Debug, thiserror::Error)]
#[error("cannot open CAN interface {interface:?}: {reason}; {}", Remedy { interface, reason })]
pub struct OpenError {
    /// The interface asked for.
    pub interface: String,
    /// Why not.
    pub reason: OpenReason,
}

/// Why an interface could not be opened.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OpenReason {
    /// Not a name that Linux gives an interface.
    #[error("not an interface name (1 to 15 characters, no white space, no slash)")]
    BadName,
    /// This system is not Linux.
    #[error("this system has no SocketCAN")]
    NotLinux,
    /// The kernel was built without CAN, or its module is not loaded.
    #[error("this kernel has no CAN sockets (AF_CAN)")]
    NoCan,
    /// There is no interface of that name.
    #[error("no such interface")]
    NoInterface,
    /// There is one, of another kind.
    #[error("not a CAN interface")]
    NotCan,
    /// There is one, and it is down.
    #[error("the interface is down")]
    Down,
    /// The process may not.
    #[error("permission denied")]
    Denied,
    /// Something else.
    #[error("{0}")]
    Io(#[from] io::Error),
}

/// What to do about it.
struct Remedy<'a> {
    interface: &'a str,
    reason: &'a OpenReason,
}

impl fmt::Display for Remedy<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.interface;
        let is_virtual = name.starts_with("vcan");
        match self.reason {
            OpenReason::BadName => f.write_str("try vcan0 or can0"),
            OpenReason::NotLinux => {
                f.write_str("CAN interfaces are Linux's; `xt28 run` needs none")
            }
            OpenReason::NoCan => {
                f.write_str("try `modprobe can-raw`; `xt28 run` needs no interface")
            }
            OpenReason::NoInterface if is_virtual => write!(
                f,
                "make it with `ip link add dev {name} type vcan && ip link set {name} up`"
            ),
            OpenReason::NoInterface => {
                f.write_str("plug in the adapter, or see `ip link show type can` for what there is")
            }
            OpenReason::NotCan => {
                f.write_str("see `ip link show type can` and `ip link show type vcan`")
            }
            OpenReason::Down if is_virtual => write!(f, "try `ip link set {name} up`"),
            OpenReason::Down => {
                write!(f, "try `ip link set {name} up type can bitrate 1000000 restart-ms 100`")
            }
            OpenReason::Denied => f.write_str("let the process open raw CAN sockets"),
            OpenReason::Io(_) => write!(f, "see `ip -details link show {name}`"),
        }
    }
}

/// An open interface no longer does what it should. Faults of the bus are not among them.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SocketError {
    /// The kernel's queue and ours are full.
    #[error(
        "{interface}: {frames} frames wait and none leaves; is another node on the bus at the \
         same bit rate? see `ip -details -statistics link show {interface}`"
    )]
    BacklogFull {
        /// The interface.
        interface: String,
        /// How many frames wait.
        frames: usize,
    },
    /// The interface was taken down.
    #[error("{interface}: the interface went down; try `ip link set {interface} up`")]
    Down {
        /// The interface.
        interface: String,
    },
    /// The interface is gone.
    #[error("{interface}: the interface is gone; plug the adapter in again and restart")]
    Gone {
        /// The interface.
        interface: String,
    },
    /// Something else.
    #[error("{interface}: cannot {doing}: {source}; see `ip -details link show {interface}`")]
    Io {
        /// The interface.
        interface: String,
        /// `send`, `receive` or `wait`.
        doing: &'static str,
        /// What the kernel said.
        source: io::Error,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn says_interface_reason_and_remedy_in_one_line() {
        let says = |interface: &str, reason| {
            OpenError { interface: interface.to_owned(), reason }.to_string()
        };
        assert_eq!(
            says("vcan0", OpenReason::NoInterface),
            "cannot open CAN interface \"vcan0\": no such interface; make it with \
             `ip link add dev vcan0 type vcan && ip link set vcan0 up`"
        );
        assert_eq!(
            says("can1", OpenReason::Down),
            "cannot open CAN interface \"can1\": the interface is down; try \
             `ip link set can1 up type can bitrate 1000000 restart-ms 100`"
        );
        assert!(!says("a\nb", OpenReason::BadName).contains('\n'));
    }
}
