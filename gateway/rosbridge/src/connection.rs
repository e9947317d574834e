//! A client's socket, never waited for: bytes in, texts out, and what is not taken yet is kept.

use std::io::{self, ErrorKind, Read};
use std::net::{Shutdown, TcpStream};
use std::os::fd::{AsFd, BorrowedFd};
use std::time::Duration;

use rustix::net::sockopt;
use tungstenite::error::{CapacityError, ProtocolError};
use tungstenite::handshake::MidHandshake;
use tungstenite::handshake::server::{ErrorResponse, Request, Response, ServerHandshake};
use tungstenite::http::{StatusCode, header::ORIGIN};
use tungstenite::protocol::frame::coding::CloseCode;
use tungstenite::protocol::{CloseFrame, WebSocketConfig};
use tungstenite::{Error, HandshakeError, Message, WebSocket};

use crate::rationed::{Ration, Rationed};

/// Longest text that a client may send, bytes. What is taken here is a tenth of it; read as JSON it grows a hundredfold.
const TEXT_MAX: usize = 1 << 12;
/// Most messages that are taken of one client before the others have their turn.
const TURN: usize = 8;
/// Most bytes that are read of one client before the others have their turn.
const RATION: usize = 1 << 14;
/// How long a client may be silent before the system asks whether it is there at all.
const KEEPALIVE: Duration = Duration::from_secs(5);
/// How often it is asked then, and how many times in vain.
const PROBES: (Duration, u32) = (Duration::from_secs(1), 3);
/// How long what was sent may go unacknowledged, ms.
#[cfg(target_os = "linux")]
const UNACKNOWLEDGED_MS: u32 = 8_000;
/// Most that waits to be sent, bytes: a client that is this far behind does not read any more.
const WAITING_MAX: usize = 1 << 22;
/// Longest reason that a goodbye has room for, bytes (RFC 6455, 5.5).
const REASON_MAX: usize = 123;
/// Most that is passed over of what a client said before it was let go, bytes: while any of it is unread the system
/// takes a goodbye back.
const UNREAD_MAX: usize = 1 << 16;

type Screen = fn(&Request, Response) -> Result<Response, ErrorResponse>;

/// A client that is connected, or about to be.
pub(crate) struct Connection {
    /// The same socket, to be polled.
    polled: TcpStream,
    ration: Ration,
    state: State,
    /// Something waits to be sent.
    pub(crate) unsent: bool,
    /// Something may have come in that was not taken yet; the socket does not tell of it again.
    pub(crate) unread: bool,
}

enum State {
    Shaking(Box<MidHandshake<ServerHandshake<Rationed, Screen>>>),
    Open(Box<WebSocket<Rationed>>),
    /// Between two states.
    Gone,
}

/// A connection has ended, and this is why, in words and as the goodbye has it; nothing where the client wanted it so.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Ended(pub(crate) Option<(CloseCode, String)>);

impl Ended {
    /// It was ended here.
    pub(crate) fn by_us(code: CloseCode, why: impl Into<String>) -> Self {
        Self(Some((code, why.into())))
    }
}

impl Connection {
    /// Takes up a stream that was accepted.
    pub(crate) fn begin(stream: TcpStream) -> io::Result<Self> {
        stream.set_nonblocking(true)?;
        // An answer that waits for the next one to fill a packet is late.
        stream.set_nodelay(true)?;
        // One whose cable was pulled would keep its place for ever.
        sockopt::set_socket_keepalive(&stream, true)?;
        sockopt::set_tcp_keepidle(&stream, KEEPALIVE)?;
        sockopt::set_tcp_keepintvl(&stream, PROBES.0)?;
        sockopt::set_tcp_keepcnt(&stream, PROBES.1)?;
        // While something that was sent is not acknowledged no such question is asked.
        #[cfg(target_os = "linux")]
        sockopt::set_tcp_user_timeout(&stream, UNACKNOWLEDGED_MS)?;
        let polled = stream.try_clone()?;
        let config = WebSocketConfig::default()
            .read_buffer_size(1 << 14)
            .write_buffer_size(0)
            .max_write_buffer_size(WAITING_MAX)
            .max_message_size(Some(TEXT_MAX))
            .max_frame_size(Some(TEXT_MAX));
        let ration = Ration::default();
        let stream = Rationed::new(stream, ration.clone());
        let shaking = ServerHandshake::start(stream, screen as Screen, Some(config));
        let state = State::Shaking(Box::new(shaking));
        Ok(Self { polled, ration, state, unsent: false, unread: false })
    }

    /// Whether the handshake is over.
    pub(crate) const fn is_open(&self) -> bool {
        matches!(self.state, State::Open(_))
    }

    /// Takes what has come in; each text is told to `hear`.
    pub(crate) fn read(&mut self, mut hear: impl FnMut(&str)) -> Result<(), Ended> {
        self.ration.refill(RATION);
        self.shake()?;
        self.unread = self.ration.is_used_up();
        let State::Open(socket) = &mut self.state else { return Ok(()) };
        for _ in 0..TURN {
            match socket.read() {
                Ok(Message::Text(text)) => hear(text.as_str()),
                // Some clients send their JSON as bytes.
                Ok(Message::Binary(bytes)) => match std::str::from_utf8(&bytes) {
                    Ok(text) => hear(text),
                    Err(_) => {
                        return Err(Ended::by_us(
                            CloseCode::Invalid,
                            "sent bytes that are no text",
                        ));
                    }
                },
                Ok(_) => {}
                Err(error) => {
                    settle(error)?;
                    self.unread = self.ration.is_used_up();
                    return Ok(());
                }
            }
        }
        self.unread = true;
        Ok(())
    }

    /// Sends a text, or keeps it until the client takes it. One that is not open yet gets nothing.
    pub(crate) fn send(&mut self, text: String) -> Result<(), Ended> {
        let State::Open(socket) = &mut self.state else { return Ok(()) };
        if let Err(error) = socket.send(Message::text(text)) {
            self.unsent = settle(error)?;
        }
        Ok(())
    }

    /// Sends what waits.
    pub(crate) fn flush(&mut self) -> Result<(), Ended> {
        let State::Open(socket) = &mut self.state else { return Ok(()) };
        self.unsent = match socket.flush() {
            Ok(()) => false,
            Err(error) => settle(error)?,
        };
        Ok(())
    }

    /// Says goodbye, and why, if the client can still hear it.
    pub(crate) fn close(mut self, Ended(why): &Ended) {
        let State::Open(socket) = &mut self.state else { return };
        let frame = why.as_ref().map(|(code, why)| {
            let mut end = why.len().min(REASON_MAX);
            while !why.is_char_boundary(end) {
                end -= 1;
            }
            CloseFrame { code: *code, reason: why[..end].into() }
        });
        let _ = socket.close(frame).and_then(|()| socket.flush());
        let _ = self.polled.shutdown(Shutdown::Write);
        let (mut bytes, mut passed_over) = ([0; 4096], 0);
        while passed_over < UNREAD_MAX
            && let Ok(read @ 1..) = self.polled.read(&mut bytes)
        {
            passed_over += read;
        }
    }

    /// Goes on with the handshake, if it is not over.
    fn shake(&mut self) -> Result<(), Ended> {
        if self.is_open() {
            return Ok(());
        }
        let State::Shaking(shaking) = std::mem::replace(&mut self.state, State::Gone) else {
            return Err(Ended(None));
        };
        self.state = match shaking.handshake() {
            Ok(socket) => State::Open(Box::new(socket)),
            Err(HandshakeError::Interrupted(shaking)) => State::Shaking(Box::new(shaking)),
            Err(HandshakeError::Failure(error)) => {
                return Err(Ended::by_us(CloseCode::Protocol, error.to_string()));
            }
        };
        Ok(())
    }
}

impl AsFd for Connection {
    fn as_fd(&self) -> BorrowedFd<'_> {
        self.polled.as_fd()
    }
}

/// Keeps pages of the web out: a browser lets any page that somebody looks at connect to this machine, and names
/// the page's host as the origin. Programs name none.
#[allow(clippy::result_large_err, clippy::unnecessary_wraps)] // as the library has it
fn screen(request: &Request, response: Response) -> Result<Response, ErrorResponse> {
    let Some(origin) = request.headers().get(ORIGIN) else { return Ok(response) };
    if origin.to_str().is_ok_and(is_local) {
        return Ok(response);
    }
    let why = "pages of other hosts do not drive this machine\n".to_owned();
    let mut refusal = ErrorResponse::new(Some(why));
    *refusal.status_mut() = StatusCode::FORBIDDEN;
    Err(refusal)
}

/// Whether an origin is a page of this very machine.
fn is_local(origin: &str) -> bool {
    let host = origin.split_once("://").map_or("", |(_, host)| host);
    let name = match host.rsplit_once(':') {
        Some((name, port)) if port.bytes().all(|digit| digit.is_ascii_digit()) => name,
        _ => host,
    };
    matches!(name, "localhost" | "127.0.0.1" | "[::1]")
}

/// Whether an error says that the socket takes no more now; any other ends the connection.
fn settle(error: Error) -> Result<bool, Ended> {
    match error {
        Error::Io(error) if error.kind() == ErrorKind::WouldBlock => Ok(true),
        Error::Io(error) if error.kind() == ErrorKind::Interrupted => Ok(true),
        Error::ConnectionClosed | Error::AlreadyClosed => Err(Ended(None)),
        // Gone without a goodbye, as who is killed.
        Error::Protocol(ProtocolError::ResetWithoutClosingHandshake) => Err(Ended(None)),
        Error::Io(error) if error.kind() == ErrorKind::ConnectionReset => Err(Ended(None)),
        Error::WriteBufferFull(_) => {
            Err(Ended::by_us(CloseCode::Policy, "does not read what it asked for"))
        }
        Error::Capacity(CapacityError::MessageTooLong { size, max_size }) => {
            let why = format!("message of {size} bytes, {max_size} at most");
            Err(Ended::by_us(CloseCode::Size, why))
        }
        error @ Error::Utf8(_) => Err(Ended::by_us(CloseCode::Invalid, error.to_string())),
        error => Err(Ended::by_us(CloseCode::Protocol, error.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use super::is_local;

    #[test]
    fn pages_of_other_hosts_are_told_from_those_of_this_machine() {
        for own in
            ["http://localhost", "http://localhost:8080", "https://127.0.0.1:1", "http://[::1]"]
        {
            assert!(is_local(own), "{own}");
        }
        for other in [
            "null",
            "file://",
            "https://example.com",
            "https://localhost.example.com",
            "https://example.com:80",
            "http://127.0.0.1.example.com",
            "http://localhost:80@example.com",
        ] {
            assert!(!is_local(other), "{other}");
        }
    }
}
