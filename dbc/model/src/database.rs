//! A database read from DBC text.

use std::collections::BTreeMap;

use can_dbc::{
    AttributeValue, ByteOrder, Comment, Dbc, MessageId, MultiplexIndicator, NumericValue,
    SignalExtendedValueType, ValueDescription, ValueType,
};

use crate::stray::stray;
use crate::{Field, Kind, Message, Presence, Problem, Signal};

/// All messages of a database, by identifier.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Database {
    messages: Vec<Message>,
    by_id: BTreeMap<u32, usize>,
    stray: Vec<Problem>,
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
    /// A range of zero to zero means the whole raw range, as editors write it.
    ///
    /// # Errors
    /// [`ReadError`], with the line.
    pub fn parse(text: &str, file: &str) -> Result<Self, ReadError> {
        let dbc = Dbc::try_from(text).map_err(|error| read_error(&error, text, file))?;
        check_identifiers(&dbc, text, file)?;
        let mut messages: Vec<Message> = Vec::with_capacity(dbc.messages.len());
        for message in &dbc.messages {
            messages.push(read_message(&dbc, message).map_err(|problem| ReadError {
                file: file.to_owned(),
                line: line_of_message(text, message.id),
                problem,
            })?);
        }
        let by_id = messages.iter().enumerate().rev().map(|(i, m)| (m.id, i)).collect();
        Ok(Self { messages, by_id, stray: stray(&dbc) })
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

    /// Statements about nothing declared.
    pub(crate) fn stray(&self) -> &[Problem] {
        &self.stray
    }

    /// The message of that name.
    #[must_use]
    pub fn message_named(&self, name: &str) -> Option<&Message> {
        self.messages.iter().find(|message| message.name == name)
    }
}

/// An 11-bit identifier with more bits has no frame, and the parser would cut it down to another.
fn check_identifiers(dbc: &Dbc, text: &str, file: &str) -> Result<(), ReadError> {
    const EXTENDED: u64 = 0x8000_0000;
    const STANDARD_MAX: u64 = 0x7FF;
    for (index, line) in text.lines().enumerate() {
        let mut words = line.strip_prefix("BO_ ").unwrap_or_default().split([' ', ':']);
        let (id, name) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
        // A line of a comment may look like a message; the parser knows which are.
        let is_message = dbc.messages.iter().any(|message| message.name == name);
        if let Ok(id) = id.parse::<u64>()
            && is_message
            && id & EXTENDED == 0
            && id > STANDARD_MAX
        {
            return Err(ReadError {
                file: file.to_owned(),
                line: index + 1,
                problem: format!("{name}: {id} has more than 11 bits; add 2147483648 for 29"),
            });
        }
    }
    Ok(())
}

/// Line of the first statement, comments left out, that holds what the parser quotes in `error`.
fn line_of_quoted(error: &str, text: &str) -> Option<usize> {
    let quoted = error.split('\'').nth(1)?;
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
        .or_else(|| line_of_quoted(&text, source))
        .unwrap_or(1);
    let problem = text.lines().last().unwrap_or("not a DBC").trim_start_matches([' ', '=']);
    ReadError { file: file.to_owned(), line, problem: problem.trim().to_owned() }
}

fn line_of_message(text: &str, id: MessageId) -> usize {
    let start = format!("BO_ {} ", id.raw());
    text.lines().position(|line| line.starts_with(&start)).map_or(1, |index| index + 1)
}

fn read_message(dbc: &Dbc, message: &can_dbc::Message) -> Result<Message, String> {
    let id = message.id;
    let len = u8::try_from(message.size).ok().filter(|&len| len <= 64).ok_or_else(|| {
        format!("{} has {} bytes; frames have up to 64", message.name, message.size)
    })?;
    let switch = message
        .signals
        .iter()
        .find(|s| s.multiplexer_indicator == MultiplexIndicator::Multiplexor)
        .map(|s| s.name.clone());
    let signals = message
        .signals
        .iter()
        .map(|signal| read_signal(dbc, message, signal, switch.as_deref()))
        .collect::<Result<_, _>>()?;
    let attribute = |name: &str| message_attribute(dbc, id, name);
    let comment = dbc.comments.iter().find_map(|c| match c {
        Comment::Message { id: at, comment } if *at == id => Some(comment.clone()),
        _ => None,
    });
    Ok(Message {
        id: id.raw(),
        name: message.name.clone(),
        len,
        sender: message.transmitter.clone().unwrap_or_default(),
        comment: comment.unwrap_or_default(),
        period_ms: u32::try_from(attribute("GenMsgCycleTime")).unwrap_or(0),
        data_id: u16::try_from(attribute("E2eDataId")).unwrap_or(0),
        alive: attribute("AliveCounter") != 0,
        signals,
    })
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
