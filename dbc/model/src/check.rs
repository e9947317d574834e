//! What makes a database bad: found before a frame is built from it.

use core::fmt;

use crate::{Database, Message, Signal};

/// Something wrong with a database.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The message, and the signal where it is one's fault.
    pub place: String,
    /// What is wrong, and what to do.
    pub what: String,
    /// What comes of it.
    pub harm: Harm,
    /// The signal whose fault it is; all of the message where none.
    pub(crate) signal: Option<String>,
}

/// What comes of a [`Problem`] where frames are read nevertheless.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Harm {
    /// Numbers that are wrong, or never there.
    Misread,
    /// None: the database only says less than ours must, or something odd.
    Untidy,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.what)
    }
}

/// A whole number of more bits is not exact as a 64-bit float, which all values are.
const EXACT_BITS: u16 = 53;

impl Database {
    /// Everything wrong with the database, in its order; empty for a good one. A database of
    /// somebody else's may have problems and still decode; ours may have none.
    #[must_use]
    pub fn problems(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        for (i, message) in self.messages().iter().enumerate() {
            check_names(&self.messages()[..i], message, &mut teller(message, &mut problems));
            check_message(message, &mut teller(message, &mut problems));
        }
        problems.extend(self.stray().iter().map(|(_, problem)| problem.clone()));
        problems
    }

    /// What would make a signal be misread, its own fault or that of a switch it hangs on; `None` for
    /// one that can be read.
    #[must_use]
    pub fn misread(&self, message: &Message, signal: &Signal) -> Option<Problem> {
        let mut problems = Vec::new();
        let others = self.messages().iter().filter(|other| !core::ptr::eq(*other, message));
        check_names(others, message, &mut teller(message, &mut problems));
        check_message(message, &mut teller(message, &mut problems));
        let stray = self.stray().iter().filter(|(id, _)| *id == message.id);
        problems.extend(stray.map(|(_, problem)| problem.clone()));
        let names: Vec<&str> = message.switches(signal).map(|s| s.name.as_str()).collect();
        let concerns = |problem: &Problem| {
            let signal = problem.signal.as_deref();
            problem.harm == Harm::Misread && signal.is_none_or(|name| names.contains(&name))
        };
        problems.into_iter().find(concerns)
    }
}

/// Adds to `problems` what is said of `message`, or of one of its signals.
fn teller<'a>(
    message: &'a Message,
    problems: &'a mut Vec<Problem>,
) -> impl FnMut(Option<&Signal>, Harm, String) + 'a {
    move |signal, harm, what| {
        let place = match signal {
            Some(signal) => format!("{}.{}", message.name, signal.name),
            None => message.name.clone(),
        };
        let signal = signal.map(|signal| signal.name.clone());
        problems.push(Problem { place, what, harm, signal });
    }
}

/// Says which of `others` a frame or a name could mean as well.
fn check_names<'a>(
    others: impl IntoIterator<Item = &'a Message>,
    message: &Message,
    say: &mut impl FnMut(Option<&Signal>, Harm, String),
) {
    for other in others {
        if other.id == message.id {
            let what = format!("has the identifier of {}; give it its own", other.name);
            say(None, Harm::Misread, what);
        }
        if other.name == message.name {
            say(None, Harm::Misread, "has the name of another message; rename one".to_owned());
        }
    }
}

fn check_message(message: &Message, say: &mut impl FnMut(Option<&Signal>, Harm, String)) {
    use Harm::{Misread, Untidy};
    if message.period_ms == 0 {
        say(None, Untidy, "has no cycle time; set GenMsgCycleTime".to_owned());
    }
    if message.len > 8 {
        say(None, Untidy, format!("has {} bytes; a classic CAN frame has up to 8", message.len));
    }
    if message.alive && !message.signals.iter().any(|s| s.name == "Counter" && s.field.length == 4)
    {
        say(None, Untidy, "is to have an alive counter; add a 4-bit signal Counter".to_owned());
    }
    if message.data_id != 0 && !message.is_protected() {
        say(None, Untidy, "has a data ID but no CRC; add an 8-bit signal Crc in byte 7".to_owned());
    }
    if message.data_id == 0 && message.signals.iter().any(Signal::is_crc) {
        say(None, Untidy, "has a CRC that nothing checks; set E2eDataId, 1 to 65535".to_owned());
    }
    for (i, signal) in message.signals.iter().enumerate() {
        check_signal(message, signal, say);
        for other in &message.signals[..i] {
            if other.name == signal.name {
                say(Some(signal), Misread, "has the name of another signal; rename one".to_owned());
            }
            if overlap(message, signal, other) {
                say(Some(signal), Untidy, format!("shares bits with {}; move one", other.name));
            }
        }
    }
}

fn check_signal(
    message: &Message,
    signal: &Signal,
    say: &mut impl FnMut(Option<&Signal>, Harm, String),
) {
    use Harm::{Misread, Untidy};
    let field = &signal.field;
    if field.bits().any(|bit| bit >= u16::from(message.len) * 8) {
        say(
            Some(signal),
            Misread,
            format!("reaches beyond the {} bytes of the frame", message.len),
        );
    }
    if field.min > field.max {
        say(
            Some(signal),
            Misread,
            format!("has its least value {} above its greatest {}", field.min, field.max),
        );
    }
    if !field.is_float() && field.length > EXACT_BITS {
        let what = format!("has {} bits, and numbers are exact to 53; split it", field.length);
        say(Some(signal), Misread, what);
    }
    let (low, high) = field.physical_range();
    let slack = field.factor.abs() * 1e-6;
    if field.min < low - slack || field.max > high + slack {
        let (min, max) = (field.min, field.max);
        say(
            Some(signal),
            Untidy,
            format!("has range {min} to {max}, but its bits hold {low} to {high}"),
        );
    }
    for (i, (raw, name)) in signal.values.iter().enumerate() {
        #[allow(clippy::cast_precision_loss)] // a table that long is out of every range
        let value = *raw as f64 * field.factor + field.offset;
        if value < field.min - slack || value > field.max + slack {
            say(Some(signal), Untidy, format!("names {raw} \"{name}\", which is out of its range"));
        }
        if signal.values[..i].iter().any(|(other, _)| other == raw) {
            say(Some(signal), Untidy, format!("names {raw} twice; drop one"));
        }
    }
    if in_ring(message, signal) {
        say(Some(signal), Misread, "is multiplexed by itself in the end; open the ring".to_owned());
    }
    if let Some(presence) = &signal.present
        && message.signal(&presence.switch).is_none_or(|switch| !switch.is_switch)
    {
        say(
            Some(signal),
            Misread,
            format!("is multiplexed by {}, which is no switch", presence.switch),
        );
    }
}

/// Following its switches never comes to a signal that is always there.
fn in_ring(message: &Message, signal: &Signal) -> bool {
    let mut signal = signal;
    for _ in 0..=message.signals.len() {
        let Some(presence) = &signal.present else { return false };
        let Some(switch) = message.signal(&presence.switch) else { return false };
        signal = switch;
    }
    true
}

/// Signals that can never be there together may share bits.
fn overlap(message: &Message, a: &Signal, b: &Signal) -> bool {
    let apart = message.signals.iter().any(|switch| {
        let ranges = |s: &Signal| ranges_under(message, s, &switch.name);
        match (ranges(a), ranges(b)) {
            (Some(a), Some(b)) => !a.iter().any(|x| b.iter().any(|y| x.0 <= y.1 && y.0 <= x.1)),
            _ => false,
        }
    });
    !apart && a.field.bits().any(|bit| b.field.bits().any(|other| bit == other))
}

/// Values of `switch` at which `signal` can be there; `None` if it does not depend on it.
fn ranges_under(message: &Message, signal: &Signal, switch: &str) -> Option<Vec<(u64, u64)>> {
    let mut signal = signal;
    for _ in 0..=message.signals.len() {
        let presence = signal.present.as_ref()?;
        if presence.switch == switch {
            return Some(presence.ranges.clone());
        }
        signal = message.signal(&presence.switch)?;
    }
    None
}
