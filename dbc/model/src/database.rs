//! A database read from DBC text.

use std::collections::BTreeMap;

use can_dbc::{
    AttributeValue, ByteOrder, Comment, Dbc, MessageId, MultiplexIndicator, NumericValue,
    SignalExtendedValueType, ValueDescription, ValueType,
};

use crate::declared::{Declared, declared};
use crate::stray::stray;
use crate::{Field, Kind, Message, Presence, Problem, Signal};

/// All messages of a database, by identifier.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Database {
    messages: Vec<Message>,
    by_id: BTreeMap<u32, usize>,
    stray: Vec<(u32, Problem)>,
    unusable: Vec<Unusable>,
}

/// A message, or one signal of it, that no frame can be read by. The rest of its database can be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unusable {
    /// Name of the message.
    pub message: String,
    /// Name of the signal; the whole message is unusable without one.
    pub signal: Option<String>,
    /// Where and why.
    pub why: ReadError,
}

/// Why a database was not read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}:{line}: {problem}; a DBC editor or cantools shows the place")]
pub struct ReadError {
    /// The file.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// What is wrong there.
    pub problem: String,
}

impl Database {
    /// Reads DBC text; `file` only names it in errors.
    ///
    /// A range of zero to zero means the whole raw range, as editors write it. A message or signal
    /// that no frame has is left out and told by [`Database::unusable`].
    ///
    /// # Errors
    /// [`ReadError`], with the line.
    pub fn parse(text: &str, file: &str) -> Result<Self, ReadError> {
        let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
        let dbc = Dbc::try_from(text).map_err(|error| read_error(&error, text, file))?;
        let declared = declared(text);
        let (mut messages, mut unusable) = (Vec::with_capacity(dbc.messages.len()), Vec::new());
        for (i, message) in dbc.messages.iter().enumerate() {
            let place = declared.get(i).filter(|place| place.name == message.name);
            let mut refuse = |signal: Option<&str>, problem| {
                let line = place.map_or(1, |place| place.line_of(signal.unwrap_or_default()));
                let why = ReadError { file: file.to_owned(), line, problem };
                let (message, signal) = (message.name.clone(), signal.map(str::to_owned));
                unusable.push(Unusable { message, signal, why });
            };
            match place.map_or(Ok(()), check_identifier).and_then(|()| read_message(&dbc, message))
            {
                Err(problem) => refuse(None, problem),
                Ok((message, refused)) => {
                    for (signal, problem) in refused {
                        refuse(Some(&signal), problem);
                    }
                    messages.push(message);
                }
            }
        }
        let by_id = messages.iter().enumerate().rev().map(|(i, m)| (m.id, i)).collect();
        Ok(Self { messages, by_id, stray: stray(&dbc), unusable })
    }

    /// Messages and signals that are left out, in the order of the file.
    #[must_use]
    pub fn unusable(&self) -> &[Unusable] {
        &self.unusable
    }

    /// Why the signal of a message cannot be used; `None` where it can, or is not there.
    #[must_use]
    pub fn why_unusable(&self, message: &str, signal: &str) -> Option<&ReadError> {
        let about = |one: &&Unusable| {
            one.message == message && one.signal.as_ref().is_none_or(|name| name == signal)
        };
        self.unusable.iter().find(about).map(|one| &one.why)
    }

    /// Messages, in the order of the file.
    #[must_use]
    pub fn messages(&self) -> &[Message] {
        &self.messages
    }

    /// The message with an identifier as DBC files write it (bit 31 set for 29 bits).
    #[must_use]
    pub fn message(&self, id: u32) -> Option<&Message> {
        self.by_id.get(&id).map(|&index| &self.messages[index])
    }

    /// Statements about nothing declared, with the identifier each names.
    pub(crate) fn stray(&self) -> &[(u32, Problem)] {
        &self.stray
    }

    /// The message of that name.
    #[must_use]
    pub fn message_named(&self, name: &str) -> Option<&Message> {
        self.messages.iter().find(|message| message.name == name)
    }
}

/// An identifier with more bits than its kind has is no frame's, and the parser would cut it down to
/// another's.
fn check_identifier(place: &Declared<'_>) -> Result<(), String> {
    const EXTENDED: u64 = 0x8000_0000;
    const STANDARD_MAX: u64 = 0x7FF;
    const EXTENDED_MAX: u64 = 0x9FFF_FFFF;
    let (id, name) = (place.id, place.name);
    match id.parse::<u64>() {
        Ok(raw) if raw & EXTENDED == 0 && raw > STANDARD_MAX => {
            Err(format!("{name}: {id} has more than 11 bits; add 2147483648 for 29"))
        }
        Ok(raw) if raw > EXTENDED_MAX => {
            Err(format!("{name}: {id} has more than 29 bits; take 536870912 or 1073741824 off"))
        }
        _ => Ok(()),
    }
}

/// Line of the first statement, comments left out, that holds what the parser quotes in `error`.
fn line_of_quoted(error: &can_dbc::DbcError, text: &str) -> Option<usize> {
    let said = match error {
        can_dbc::DbcError::MessageIdOutOfRange(id) => format!("'{id}'"),
        error => error.to_string(),
    };
    let quoted = said.split('\'').nth(1)?;
    let holds = |line: &str| !line.starts_with("CM_") && line.contains(quoted);
    text.lines().position(holds).map(|index| index + 1)
}

fn read_error(error: &can_dbc::DbcError, source: &str, file: &str) -> ReadError {
    let text = error.to_string();
    // The parser's own message shows the place as " --> LINE:COLUMN".
    let line = text
        .split("-->")
        .nth(1)
        .and_then(|rest| rest.trim().split(':').next()?.parse().ok())
        .or_else(|| line_of_quoted(error, source))
        .unwrap_or(1);
    let problem = text.lines().last().unwrap_or("not a DBC").trim_start_matches([' ', '=']);
    ReadError { file: file.to_owned(), line, problem: problem.trim().to_owned() }
}

/// A message with the signals that can be used, and what is wrong with each of the others.
fn read_message(
    dbc: &Dbc,
    message: &can_dbc::Message,
) -> Result<(Message, Vec<(String, String)>), String> {
    let id = message.id;
    let len = u8::try_from(message.size).ok().filter(|&len| len <= 64).ok_or_else(|| {
        format!("{} has {} bytes; frames have up to 64", message.name, message.size)
    })?;
    let switch = message
        .signals
        .iter()
        .find(|s| s.multiplexer_indicator == MultiplexIndicator::Multiplexor)
        .map(|s| s.name.clone());
    let (mut signals, mut refused) = (Vec::with_capacity(message.signals.len()), Vec::new());
    for signal in &message.signals {
        match read_signal(dbc, message, signal, switch.as_deref()) {
            Ok(signal) => signals.push(signal),
            Err(problem) => refused.push((signal.name.clone(), problem)),
        }
    }
    let attribute = |name: &str| message_attribute(dbc, id, name);
    let comment = dbc.comments.iter().find_map(|c| match c {
        Comment::Message { id: at, comment } if *at == id => Some(comment.clone()),
        _ => None,
    });
    let message = Message {
        id: id.raw(),
        name: message.name.clone(),
        len,
        sender: message.transmitter.clone().unwrap_or_default(),
        comment: comment.unwrap_or_default(),
        period_ms: u32::try_from(attribute("GenMsgCycleTime")).unwrap_or(0),
        data_id: u16::try_from(attribute("E2eDataId")).unwrap_or(0),
        alive: attribute("AliveCounter") != 0,
        signals,
    };
    Ok((message, refused))
}

fn read_signal(
    dbc: &Dbc,
    message: &can_dbc::Message,
    signal: &can_dbc::Signal,
    switch: Option<&str>,
) -> Result<Signal, String> {
    let at = |id: MessageId, name: &str| id == message.id && name == signal.name;
    let narrow = |bits: u64, what: &str| {
        u16::try_from(bits).ok().filter(|&bits| bits < 512).ok_or_else(|| {
            format!("{}.{}: {what} {bits} is beyond any frame", message.name, signal.name)
        })
    };
    let length = narrow(signal.size, "length")?;
    let kind = kind(dbc, message.id, signal);
    let fits = match kind {
        Kind::Float32 => length == 32,
        Kind::Float64 => length == 64,
        Kind::Unsigned | Kind::Signed => (1..=64).contains(&length),
    };
    if !fits {
        return Err(format!("{}.{}: {length} bits cannot hold it", message.name, signal.name));
    }
    if signal.factor == 0.0 || !signal.factor.is_finite() || !signal.offset.is_finite() {
        return Err(format!(
            "{}.{}: factor and offset must be finite, the factor not zero",
            message.name, signal.name
        ));
    }
    let mut field = Field {
        start: narrow(signal.start_bit, "start bit")?,
        length,
        big_endian: signal.byte_order == ByteOrder::BigEndian,
        kind,
        factor: signal.factor,
        offset: signal.offset,
        min: number(signal.min),
        max: number(signal.max),
    };
    if field.min == 0.0 && field.max == 0.0 {
        (field.min, field.max) = field.physical_range();
    }
    let values = dbc.value_descriptions.iter().find_map(|v| match v {
        ValueDescription::Signal { message_id, name, value_descriptions }
            if at(*message_id, name) =>
        {
            Some(value_descriptions.iter().map(|d| (d.id, d.description.clone())).collect())
        }
        _ => None,
    });
    let comment = dbc.comments.iter().find_map(|c| match c {
        Comment::Signal { message_id, name, comment } if at(*message_id, name) => {
            Some(comment.clone())
        }
        _ => None,
    });
    Ok(Signal {
        name: signal.name.clone(),
        field,
        unit: signal.unit.clone(),
        values: values.unwrap_or_default(),
        comment: comment.unwrap_or_default(),
        present: presence(dbc, message, signal, switch)?,
        is_switch: matches!(
            signal.multiplexer_indicator,
            MultiplexIndicator::Multiplexor
                | MultiplexIndicator::MultiplexorAndMultiplexedSignal(_)
        ),
    })
}

fn kind(dbc: &Dbc, id: MessageId, signal: &can_dbc::Signal) -> Kind {
    let extended = dbc
        .signal_extended_value_type_list
        .iter()
        .find(|e| e.message_id == id && e.signal_name == signal.name);
    match extended.map(|e| e.signal_extended_value_type) {
        Some(SignalExtendedValueType::IEEEfloat32Bit) => Kind::Float32,
        Some(SignalExtendedValueType::IEEEdouble64bit) => Kind::Float64,
        _ if signal.value_type == ValueType::Signed => Kind::Signed,
        _ => Kind::Unsigned,
    }
}

/// When a multiplexed signal is there: by `SG_MUL_VAL_` where the file has it, else by the one
/// switch of the message.
fn presence(
    dbc: &Dbc,
    message: &can_dbc::Message,
    signal: &can_dbc::Signal,
    switch: Option<&str>,
) -> Result<Option<Presence>, String> {
    let value = match signal.multiplexer_indicator {
        MultiplexIndicator::Plain | MultiplexIndicator::Multiplexor => return Ok(None),
        MultiplexIndicator::MultiplexedSignal(value)
        | MultiplexIndicator::MultiplexorAndMultiplexedSignal(value) => value,
    };
    let extended = dbc
        .extended_multiplex
        .iter()
        .find(|e| e.message_id == message.id && e.signal_name == signal.name);
    if let Some(extended) = extended {
        let ranges = extended.mappings.iter().map(|m| (m.min_value, m.max_value)).collect();
        return Ok(Some(Presence { switch: extended.multiplexor_signal_name.clone(), ranges }));
    }
    let switches = message.signals.iter().filter(|s| {
        matches!(
            s.multiplexer_indicator,
            MultiplexIndicator::Multiplexor
                | MultiplexIndicator::MultiplexorAndMultiplexedSignal(_)
        )
    });
    if switches.count() > 1 {
        return Err(format!(
            "{}.{} has several switches to go by; name its own with SG_MUL_VAL_",
            message.name, signal.name
        ));
    }
    let switch = switch.ok_or_else(|| {
        format!("{}.{} is multiplexed but the message has no switch", message.name, signal.name)
    })?;
    Ok(Some(Presence { switch: switch.to_owned(), ranges: vec![(value, value)] }))
}

fn message_attribute(dbc: &Dbc, id: MessageId, name: &str) -> i64 {
    let own = dbc
        .attribute_values_message
        .iter()
        .find(|a| a.message_id == id && a.name == name)
        .map(|a| &a.value);
    let default = || dbc.attribute_defaults.iter().find(|d| d.name == name).map(|d| &d.value);
    match own.or_else(default) {
        Some(AttributeValue::Uint(value)) => i64::try_from(*value).unwrap_or(0),
        Some(AttributeValue::Int(value)) => *value,
        #[allow(clippy::cast_possible_truncation)]
        Some(AttributeValue::Double(value)) => *value as i64,
        _ => 0,
    }
}

#[allow(clippy::cast_precision_loss)]
const fn number(value: NumericValue) -> f64 {
    match value {
        NumericValue::Uint(value) => value as f64,
        NumericValue::Int(value) => value as f64,
        NumericValue::Double(value) => value,
    }
}
