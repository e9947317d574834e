//! Opens a raw CAN socket, and finds out why where that fails.

use std::io;

use rustix::io::Errno;
use socketcan::{CanAddr, CanSocket, Socket, SocketOptions};

use super::{OpenError, OpenReason};

/// Bytes of receive buffer asked for; the kernel grants at most `net.core.rmem_max`.
const RECEIVE_BUFFER_BYTES: usize = 1 << 20;

/// A non-blocking socket that stamps frames and hears error frames.
pub(super) fn open(interface: &str) -> Result<CanSocket, OpenError> {
    let fail = |reason| OpenError { interface: interface.to_owned(), reason };
    if !is_interface_name(interface) {
        return Err(fail(OpenReason::BadName));
    }
    let socket = bind(interface).map_err(fail)?;
    configure(&socket).map_err(|error| fail(reason(error)))?;
    Ok(socket)
}

/// As the kernel checks names (`dev_valid_name`).
fn is_interface_name(name: &str) -> bool {
    let bad = |c: char| c.is_whitespace() || c.is_control() || matches!(c, '/' | ':');
    (1..=15).contains(&name.len()) && !matches!(name, "." | "..") && !name.contains(bad)
}

fn bind(interface: &str) -> Result<CanSocket, OpenReason> {
    let address = match CanAddr::from_iface(interface) {
        Ok(address) => address,
        // Without CAN in the kernel there is no making the interface either: say that first.
        Err(error) => {
            return Err(match CanSocket::open_iface(0).map_err(reason) {
                Err(OpenReason::NoCan) => OpenReason::NoCan,
                _ if Errno::from_io_error(&error) == Some(Errno::NODEV) => OpenReason::NoInterface,
                _ => reason(error),
            });
        }
    };
    CanSocket::open_addr(&address).map_err(|error| match Errno::from_io_error(&error) {
        // The name was found a moment ago, so it is the kind that is wrong.
        Some(Errno::NODEV) => OpenReason::NotCan,
        _ => reason(error),
    })
}

fn configure(socket: &CanSocket) -> io::Result<()> {
    // Binding to an interface that is down works, and leaves this to be asked for.
    if let Some(error) = socket.as_raw_socket().take_error()? {
        return Err(error);
    }
    socket.set_nonblocking(true)?;
    socket.set_recv_timestamp(true)?;
    socket.set_error_filter_accept_all()?;
    socket.as_raw_socket().set_recv_buffer_size(RECEIVE_BUFFER_BYTES)
}

fn reason(error: io::Error) -> OpenReason {
    match Errno::from_io_error(&error) {
        Some(Errno::AFNOSUPPORT | Errno::PROTONOSUPPORT) => OpenReason::NoCan,
        Some(Errno::NODEV) => OpenReason::NoInterface,
        Some(Errno::NETDOWN) => OpenReason::Down,
        Some(Errno::ACCESS | Errno::PERM) => OpenReason::Denied,
        _ => OpenReason::Io(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_the_kernel_would_not_take_is_refused() {
        for name in ["", ".", "..", "a/b", "a b", "a\0b", "a\nb", "sixteen_letters_"] {
            let error = open(name).unwrap_err();
            assert!(matches!(error.reason, OpenReason::BadName), "{error}");
        }
    }

    #[test]
    fn an_interface_that_is_not_there_is_an_error_with_a_remedy() {
        let error = open("vcan4711").unwrap_err();
        assert!(matches!(error.reason, OpenReason::NoInterface | OpenReason::NoCan), "{error}");
        let text = error.to_string();
        assert!(text.contains("vcan4711") && text.contains('`') && !text.contains('\n'), "{text}");
    }
}
