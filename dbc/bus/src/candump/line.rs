//! One line of a log, from bytes to what it says. Total: no bytes make it panic.

use xt28_dbc::{CanId, Frame};
use xt28_machine::SimTime;

use super::Direction;

/// What is wrong with a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BadLine {
    /// No `(seconds.fraction)` in front, a fraction of no or more than nine digits, or a time
    /// beyond the year 2554.
    #[error("no time such as (1758440579.175206) in front")]
    Time,
    /// No interface after the time, or one that is not text.
    #[error("no interface such as can0 after the time")]
    Interface,
    /// No identifier of three or eight hexadecimal digits before `#`, or one out of range.
    #[error("no identifier of 3 (to 7FF) or 8 (to 1FFFFFFF) hexadecimal digits before #")]
    Identifier,
    /// The data is not zero to eight pairs of hexadecimal digits.
    #[error("data is not 0 to 8 pairs of hexadecimal digits")]
    Data,
    /// Something other than a direction follows the data.
    #[error("something other than R or T follows the data")]
    Trailing,
    /// A line of candump -d that does not say how many frames were dropped.
    #[error("no DROPCOUNT such as: dropped 3 CAN frames on 'can0' socket (total drops 3)")]
    DropCount,
    /// What candump shows on a screen, with the number of bytes in square brackets.
    #[error("candump as on a screen, not a log")]
    Screen,
    /// Longer than any line of a log.
    #[error("longer than any line of a log")]
    TooLong,
}

impl BadLine {
    /// What to do about it.
    #[must_use]
    pub const fn remedy(self) -> &'static str {
        match self {
            Self::Screen => "record with `candump -L`",
            Self::TooLong => "give a file that candump -L wrote",
            _ => "mend or remove the line",
        }
    }
}

/// A line that could be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Line<'a> {
    /// A data frame.
    Data { at: SimTime, interface: &'a str, frame: Frame, direction: Option<Direction> },
    /// A remote frame.
    Remote,
    /// An error frame of SocketCAN.
    Error,
    /// A CAN FD frame.
    Fd,
    /// candump -d's word for frames that came faster than it took them.
    Dropped(u64),
    /// Nothing but white space.
    Blank,
}

/// Reads one line, without its line feed.
pub(super) fn parse(line: &[u8]) -> Result<Line<'_>, BadLine> {
    let bytes_shown = |word: &[u8]| word.starts_with(b"[") && word.ends_with(b"]");
    let shown = || line.split(u8::is_ascii_whitespace).any(bytes_shown);
    read(line).map_err(|what| if shown() { BadLine::Screen } else { what })
}

fn read(line: &[u8]) -> Result<Line<'_>, BadLine> {
    let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    let Some(time) = words.next() else {
        return Ok(Line::Blank);
    };
    if time == b"DROPCOUNT:" {
        return drop_count(words).map(Line::Dropped).ok_or(BadLine::DropCount);
    }
    let at = parse_time(time).ok_or(BadLine::Time)?;
    let interface = words.next().and_then(|word| core::str::from_utf8(word).ok());
    let interface = interface.filter(|name| !name.contains('#')).ok_or(BadLine::Interface)?;
    let frame = words.next().ok_or(BadLine::Identifier)?;
    let direction = match (words.next(), words.next()) {
        (None, _) => None,
        (Some(b"R"), None) => Some(Direction::Received),
        (Some(b"T"), None) => Some(Direction::Transmitted),
        _ => return Err(BadLine::Trailing),
    };
    Ok(match parse_frame(frame)? {
        Body::Data(frame) => Line::Data { at, interface, frame, direction },
        Body::Remote => Line::Remote,
        Body::Error => Line::Error,
        Body::Fd => Line::Fd,
    })
}

/// `dropped 3 CAN frames on 'can0' socket (total drops 3)`, as candump -d says it on a line of its own, without a time:
/// how many.
fn drop_count<'a>(mut words: impl Iterator<Item = &'a [u8]>) -> Option<u64> {
    let mut next = || words.next();
    let (dropped, frames, can, unit) = (next()?, decimal(next()?)?, next()?, next()?);
    let is_count = dropped == b"dropped" && can == b"CAN" && matches!(unit, b"frame" | b"frames");
    is_count.then_some(frames)
}

/// `(1758440579.175206)`, with one to nine digits of fraction, in whole nanoseconds.
fn parse_time(word: &[u8]) -> Option<SimTime> {
    let inner = word.strip_prefix(b"(")?.strip_suffix(b")")?;
    let point = inner.iter().position(|&byte| byte == b'.')?;
    let (seconds, fraction) = (&inner[..point], &inner[point + 1..]);
    if seconds.is_empty() || fraction.is_empty() || fraction.len() > 9 {
        return None;
    }
    let missing_digits = 9 - u32::try_from(fraction.len()).ok()?;
    let nanos = decimal(fraction)? * 10_u64.pow(missing_digits);
    Some(SimTime::from_nanos(decimal(seconds)?.checked_mul(1_000_000_000)?.checked_add(nanos)?))
}

fn decimal(digits: &[u8]) -> Option<u64> {
    digits.iter().try_fold(0_u64, |number, &digit| {
        let digit = digit.is_ascii_digit().then(|| u64::from(digit - b'0'))?;
        number.checked_mul(10)?.checked_add(digit)
    })
}

/// What `ID#...` says.
enum Body {
    Data(Frame),
    Remote,
    Error,
    Fd,
}

fn parse_frame(word: &[u8]) -> Result<Body, BadLine> {
    /// Marks an error frame in SocketCAN's identifiers (`CAN_ERR_FLAG` of linux/can.h).
    const ERROR_FLAG: u32 = 0x2000_0000;

    let hash = word.iter().position(|&byte| byte == b'#').ok_or(BadLine::Identifier)?;
    let (digits, body) = (&word[..hash], &word[hash + 1..]);
    let raw = hexadecimal(digits).ok_or(BadLine::Identifier)?;
    let id = match digits.len() {
        3 => u16::try_from(raw).ok().and_then(CanId::standard),
        8 if raw & !0x1FFF_FFFF == ERROR_FLAG => return Ok(Body::Error),
        8 => CanId::extended(raw),
        _ => None,
    }
    .ok_or(BadLine::Identifier)?;
    match body.first() {
        Some(b'#') => Ok(Body::Fd),
        Some(b'R' | b'r') => match &body[1..] {
            [] | [b'0'..=b'8'] => Ok(Body::Remote),
            [b'8', b'_', code] if is_above_eight(*code) => Ok(Body::Remote),
            _ => Err(BadLine::Data),
        },
        _ => parse_data(id, body).map(Body::Data).ok_or(BadLine::Data),
    }
}

/// A length code above eight, which candump -8 writes behind a frame of eight bytes, as `_E`: on classic CAN it is
/// eight bytes as well (ISO 11898-1).
const fn is_above_eight(code: u8) -> bool {
    matches!(code, b'9' | b'A'..=b'F' | b'a'..=b'f')
}

fn parse_data(id: CanId, digits: &[u8]) -> Option<Frame> {
    let digits = match digits {
        [all @ .., b'_', code] if all.len() == 16 && is_above_eight(*code) => all,
        all => all,
    };
    let mut bytes = [0; 8];
    if !digits.len().is_multiple_of(2) {
        return None;
    }
    let data = bytes.get_mut(..digits.len() / 2)?;
    for (byte, pair) in data.iter_mut().zip(digits.chunks_exact(2)) {
        *byte = u8::try_from(hexadecimal(pair)?).ok()?;
    }
    Frame::new(id, data)
}

/// One to eight digits of either case.
fn hexadecimal(digits: &[u8]) -> Option<u32> {
    if digits.is_empty() || digits.len() > 8 {
        return None;
    }
    digits.iter().try_fold(0, |number, &digit| Some(number << 4 | char::from(digit).to_digit(16)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn data(line: &str) -> (SimTime, Frame, Option<Direction>) {
        match parse(line.as_bytes()) {
            Ok(Line::Data { at, frame, direction, .. }) => (at, frame, direction),
            other => panic!("{line}: {other:?}"),
        }
    }

    #[test]
    fn reads_both_formats_of_identifier() {
        let (at, frame, _) = data("(1758440579.175206) can0 0CFF4027#5555555555551299");
        assert_eq!(at.as_nanos(), 1_758_440_579_175_206_000);
        assert_eq!(frame.id(), CanId::Extended(0x0CFF_4027));
        assert_eq!(frame.data(), [0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x12, 0x99]);
        assert_eq!(data("(0.0) can0 123#").1, Frame::new(CanId::Standard(0x123), &[]).unwrap());
        assert_eq!(data("(0.0) can0 00000123#").1.id(), CanId::Extended(0x123));
    }

    #[test]
    fn reads_what_other_writers_write() {
        assert_eq!(data("(1.000000001) vcan0 0cff4027#aB").1.data(), [0xAB]);
        assert_eq!(data("(1.000000001) vcan0 123#AB").0.as_nanos(), 1_000_000_001);
        assert_eq!(data("(1.5)  any 123#AB R").2, Some(Direction::Received));
        assert_eq!(data("(1.5)\tany\t123#AB T\r").2, Some(Direction::Transmitted));
    }

    #[test]
    fn a_length_code_above_eight_is_eight_bytes() {
        for code in ['9', 'C', 'F', 'f'] {
            let frame = data(&format!("(1.5) can0 123#1122334455667788_{code} R")).1;
            assert_eq!(frame.data(), [0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88]);
        }
        assert_eq!(parse(b"(1.5) can0 123#R8_E"), Ok(Line::Remote));
        for body in ["1122334455667788_8", "1122334455667788_G", "11_9", "_9", "R7_E", "R_E"] {
            let line = format!("(1.5) can0 123#{body}");
            assert_eq!(parse(line.as_bytes()), Err(BadLine::Data), "{line}");
        }
    }

    #[test]
    fn knows_what_it_passes_over() {
        for (line, what) in [
            ("(0.1) can0 123#R", Line::Remote),
            ("(0.1) can0 12345678#R8 T", Line::Remote),
            ("(0.1) can0 20000004#0004000000000000", Line::Error),
            ("(0.1) can0 123##1AABB", Line::Fd),
            ("DROPCOUNT: dropped 3 CAN frames on 'can0' socket (total drops 7)", Line::Dropped(3)),
            ("DROPCOUNT: dropped 1 CAN frame on 'can0' socket (total drops 1)\r", Line::Dropped(1)),
            (" \r", Line::Blank),
            ("", Line::Blank),
        ] {
            assert_eq!(parse(line.as_bytes()), Ok(what), "{line}");
        }
    }

    #[test]
    fn says_what_is_wrong() {
        for (line, what) in [
            ("1.5 can0 123#", BadLine::Time),
            ("(1) can0 123#", BadLine::Time),
            ("(1.) can0 123#", BadLine::Time),
            ("(.5) can0 123#", BadLine::Time),
            ("(-1.5) can0 123#", BadLine::Time),
            ("(1.0000000001) can0 123#", BadLine::Time),
            ("(18446744073.709551616) can0 123#", BadLine::Time),
            ("(18446744073709551620.5) can0 123#", BadLine::Time),
            ("DROPCOUNT:", BadLine::DropCount),
            ("DROPCOUNT: dropped CAN frames on 'can0' socket", BadLine::DropCount),
            ("DROPCOUNT: dropped -3 CAN frames on 'can0' socket", BadLine::DropCount),
            ("DROPCOUNT: dropped 3 balls on 'can0' socket", BadLine::DropCount),
            ("(1.5)", BadLine::Interface),
            ("(1.5) 123#AB", BadLine::Interface),
            ("(1.5) can0", BadLine::Identifier),
            ("(1.5) can0 123", BadLine::Identifier),
            ("(1.5) can0 12#AB", BadLine::Identifier),
            ("(1.5) can0 1234#AB", BadLine::Identifier),
            ("(1.5) can0 800#AB", BadLine::Identifier),
            ("(1.5) can0 80000000#AB", BadLine::Identifier),
            ("(1.5) can0 60000004#AB", BadLine::Identifier),
            ("(1.5) can0 +23#AB", BadLine::Identifier),
            ("(1.5) can0 123#A", BadLine::Data),
            ("(1.5) can0 123#+A", BadLine::Data),
            ("(1.5) can0 123#112233445566778899", BadLine::Data),
            ("(1.5) can0 123#R9", BadLine::Data),
            ("  can0  123   [2]  AB CD", BadLine::Screen),
            (
                " (1758440579.175206)  can0  0CFF4027   [8]  55 55 55 55 55 55 12 99",
                BadLine::Screen,
            ),
            (" (0.000000)  can0  TX - -  123  [00]", BadLine::Screen),
            ("(1.5) can0 123#AB X", BadLine::Trailing),
            ("(1.5) can0 123#AB R R", BadLine::Trailing),
        ] {
            assert_eq!(parse(line.as_bytes()), Err(what), "{line}");
        }
    }
}
