//! How two senders of one message show in a log.

use std::fmt;

/// Where a message says two things at the same time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Voices {
    /// One thing on the interface that it came on first, another on the next.
    Interfaces([String; 2]),
    /// On the same interface, one in turn with the other.
    InTurn,
}

impl Voices {
    /// What of it makes two machines of a log, and how to part them.
    pub(crate) fn of_machines(&self, message: &str) -> String {
        match self {
            Self::Interfaces([one, other]) => format!(
                "{message} comes on {one} and on {other}, and says different things there: that is two machines; keep \
                 one, as `grep ' {one} '` does"
            ),
            Self::InTurn => format!(
                "{message} comes from two senders from here on, which say different things in turn: that is two \
                 machines or emulators on one bus; record with one of them"
            ),
        }
    }
}

impl fmt::Display for Voices {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Interfaces([one, other]) => write!(
                f,
                "says one thing on {one} and another on {other}, from here on; both are taken as they come, so leave out \
                 the interface of another device"
            ),
            Self::InTurn => f.write_str(
                "says two things in turn from here on, as two senders do; both are taken as they come, so record with \
                 one of them",
            ),
        }
    }
}
