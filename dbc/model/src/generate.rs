//! Rust source from a database: one struct a message, one enum a table of values.

use core::fmt::Write;

use crate::generate_error::GenerateError;
use crate::names::Names;
use crate::{Database, Field, Kind, Message, Signal};

/// Rust source of typed messages. Refuses a bad database, and multiplexed messages loudly.
///
/// # Errors
/// [`GenerateError`].
pub fn generate(database: &Database) -> Result<String, GenerateError> {
    let unusable = database.unusable().iter().map(|one| one.why.to_string());
    let problems = database.problems();
    let lines: Vec<String> = unusable.chain(problems.iter().map(ToString::to_string)).collect();
    if !lines.is_empty() {
        return Err(GenerateError::Problems(lines.join("\n")));
    }
    check_names(database)?;
    let mut out = String::new();
    for message in database.messages() {
        if let Some(signal) = message.signals.iter().find(|s| s.present.is_some()) {
            let place = format!("{}.{}", message.name, signal.name);
            return Err(GenerateError::Unsupported { place, what: "a multiplexed signal" });
        }
        write_message(&mut out, message);
    }
    write_table(&mut out, database);
    Ok(out)
}

/// Refuses what would not compile, while the database can still be named.
fn check_names(database: &Database) -> Result<(), GenerateError> {
    let mut types = Names::of("messages".to_owned());
    for message in database.messages() {
        types.take(type_name(&message.name))?;
        let mut fields = Names::of(message.name.clone());
        for signal in &message.signals {
            fields.take(field_name(signal))?;
            let Type::Named(name) = Type::of(message, signal) else { continue };
            types.take(name)?;
            let place = format!("{}.{}", message.name, signal.name);
            if signal.values.iter().any(|(raw, _)| !(0..=255).contains(raw)) {
                return Err(GenerateError::Unsupported {
                    place,
                    what: "a named value outside 0 to 255",
                });
            }
            let mut variants = Names::of(place);
            for (_, text) in &signal.values {
                variants.take(variant_name(text))?;
            }
        }
    }
    Ok(())
}

/// The text on one line, as a doc comment needs it.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The Rust type of a signal.
enum Type {
    Physical,
    Flag,
    Integer(&'static str),
    Named(String),
}

impl Type {
    fn of(message: &Message, signal: &Signal) -> Self {
        if !signal.is_plain_integer() {
            return Self::Physical;
        }
        if !signal.values.is_empty() {
            return Self::Named(format!("{}{}", type_name(&message.name), type_name(&signal.name)));
        }
        let signed = signal.field.kind == Kind::Signed;
        match signal.field.length {
            1 if !signed => Self::Flag,
            ..=8 => Self::Integer(if signed { "i8" } else { "u8" }),
            9..=16 => Self::Integer(if signed { "i16" } else { "u16" }),
            17..=32 => Self::Integer(if signed { "i32" } else { "u32" }),
            _ => Self::Integer(if signed { "i64" } else { "u64" }),
        }
    }

    fn name(&self) -> &str {
        match self {
            Self::Physical => "f64",
            Self::Flag => "bool",
            Self::Integer(name) => name,
            Self::Named(name) => name,
        }
    }
}

fn write_message(out: &mut String, message: &Message) {
    let name = type_name(&message.name);
    for signal in &message.signals {
        if let Type::Named(type_name) = Type::of(message, signal) {
            write_enum(out, &type_name, signal);
        }
    }
    let fields: Vec<&Signal> = message.signals.iter().filter(|s| !is_crc(message, s)).collect();
    let all_plain = fields
        .iter()
        .all(|s| matches!(Type::of(message, s), Type::Physical | Type::Integer(_) | Type::Flag));
    let default = if all_plain { ", Default" } else { "" };
    push(out, &format!("/// {} Sent by {}.", one_line(&message.comment), message.sender));
    push(out, &format!("#[derive(Clone, Copy, Debug, PartialEq{default})]"));
    push(out, &format!("pub struct {name} {{"));
    for signal in &fields {
        push(out, &format!("    /// {}", field_doc(signal)));
        push(
            out,
            &format!("    pub {}: {},", field_name(signal), Type::of(message, signal).name()),
        );
    }
    push(out, "}\n");
    push(out, &format!("impl {name} {{"));
    write_constants(out, message);
    write_encode(out, message, &fields);
    write_decode(out, message, &fields);
    push(out, "}\n");
}

fn write_constants(out: &mut String, message: &Message) {
    let id = message.id;
    let id = if id & 0x8000_0000 == 0 {
        format!("CanId::Standard(0x{id:X})")
    } else {
        format!("CanId::Extended(0x{:X})", id & 0x1FFF_FFFF)
    };
    push(out, "    /// Its identifier.");
    push(out, &format!("    pub const ID: CanId = {id};"));
    push(out, "    /// Its length, bytes.");
    push(out, &format!("    pub const DLC: u8 = {};", message.len));
    push(out, "    /// Its period.");
    push(
        out,
        &format!("    pub const PERIOD: Duration = Duration::from_millis({});", message.period_ms),
    );
    if message.data_id != 0 {
        push(out, "    /// Data ID of its end-to-end protection.");
        push(out, &format!("    pub const DATA_ID: u16 = 0x{:X};", message.data_id));
    }
    for signal in message.signals.iter().filter(|s| !is_crc(message, s)) {
        push(
            out,
            &format!(
                "    const {}: Field = {};",
                constant_name(signal),
                field_literal(&signal.field)
            ),
        );
    }
    out.push('\n');
}

fn write_encode(out: &mut String, message: &Message, fields: &[&Signal]) {
    push(out, "    /// The frame that says this: numbers rounded half away from zero.");
    push(out, "    ///");
    push(out, "    /// # Errors");
    push(out, "    /// [`EncodeError`]: a number is not finite or outside its range.");
    push(out, "    #[allow(clippy::cast_lossless)]");
    push(out, "    pub fn encode(&self) -> Result<Frame, EncodeError> {");
    push(out, &format!("        let mut data = [0_u8; {}];", message.len));
    for signal in fields {
        let (field, constant) = (field_name(signal), constant_name(signal));
        let line = match Type::of(message, signal) {
            Type::Physical => format!(
                "put(&mut data, &Self::{constant}, self.{field}, \"{}.{}\")?;",
                message.name, signal.name
            ),
            Type::Named(_) => {
                format!("Self::{constant}.set_raw(&mut data, u64::from(self.{field} as u8));")
            }
            Type::Flag => format!("Self::{constant}.set_raw(&mut data, u64::from(self.{field}));"),
            Type::Integer(_) => format!(
                "put(&mut data, &Self::{constant}, self.{field} as f64, \"{}.{}\")?;",
                message.name, signal.name
            ),
        };
        push(out, &format!("        {line}"));
    }
    if message.data_id != 0 {
        push(out, "        e2e::protect(Self::DATA_ID, &mut data);");
    }
    push(
        out,
        "        Ok(Frame::new(Self::ID, &data).expect(\"a message is no longer than a frame\"))",
    );
    push(out, "    }\n");
}

fn write_decode(out: &mut String, message: &Message, fields: &[&Signal]) {
    push(out, "    /// What a frame says.");
    push(out, "    ///");
    push(out, "    /// # Errors");
    push(
        out,
        "    /// [`DecodeError`]: another frame, another length, a bad CRC, a value out of range.",
    );
    push(out, "    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]");
    push(out, "    pub fn decode(frame: &Frame) -> Result<Self, DecodeError> {");
    push(
        out,
        &format!("        let data = expect(frame, Self::ID, Self::DLC, \"{}\")?;", message.name),
    );
    if message.data_id != 0 {
        push(out, &format!("        e2e::verify(Self::DATA_ID, data, \"{}\")?;", message.name));
    }
    push(out, "        Ok(Self {");
    for signal in fields {
        let (field, constant) = (field_name(signal), constant_name(signal));
        let place = format!("{}.{}", message.name, signal.name);
        let value = match Type::of(message, signal) {
            Type::Physical => format!("get(data, &Self::{constant}, \"{place}\")?"),
            Type::Flag => format!("Self::{constant}.raw(data) != 0"),
            Type::Integer(name) => format!("get(data, &Self::{constant}, \"{place}\")? as {name}"),
            Type::Named(name) => format!(
                "{name}::from_raw(Self::{constant}.raw(data)).ok_or(DecodeError::Value {{ \
                 signal: \"{place}\", raw: Self::{constant}.raw(data) }})?"
            ),
        };
        push(out, &format!("            {field}: {value},"));
    }
    push(out, "        })\n    }");
}

fn write_enum(out: &mut String, name: &str, signal: &Signal) {
    push(out, &format!("/// {}", one_line(&signal.comment)));
    push(out, "#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]");
    push(out, &format!("pub enum {name} {{"));
    for (i, (raw, text)) in signal.values.iter().enumerate() {
        push(out, &format!("    /// {raw}: {}.", one_line(text)));
        if i == 0 {
            push(out, "    #[default]");
        }
        push(out, &format!("    {} = {raw},", variant_name(text)));
    }
    push(out, "}\n");
    push(out, &format!("impl {name} {{"));
    push(out, "    /// All of them, in the order of the database.");
    let variants: Vec<String> =
        signal.values.iter().map(|(_, text)| format!("Self::{}", variant_name(text))).collect();
    push(
        out,
        &format!("    pub const ALL: [Self; {}] = [{}];\n", variants.len(), variants.join(", ")),
    );
    push(out, "    /// The one with that raw value.");
    push(out, "    #[must_use]");
    push(out, "    pub fn from_raw(raw: u64) -> Option<Self> {");
    push(out, "        Self::ALL.into_iter().find(|value| u64::from(*value as u8) == raw)");
    push(out, "    }\n");
    push(out, "    /// Its name in the database.");
    push(out, "    #[must_use]");
    push(out, "    pub const fn name(self) -> &'static str {");
    push(out, "        match self {");
    for (_, text) in &signal.values {
        push(out, &format!("            Self::{} => {text:?},", variant_name(text)));
    }
    push(out, "        }\n    }\n}\n");
}

fn write_table(out: &mut String, database: &Database) {
    push(out, "/// Every message: name, identifier, period.");
    push(
        out,
        &format!(
            "pub const MESSAGES: [(&str, CanId, Duration); {}] = [",
            database.messages().len()
        ),
    );
    for message in database.messages() {
        let name = type_name(&message.name);
        push(out, &format!("    (\"{}\", {name}::ID, {name}::PERIOD),", message.name));
    }
    push(out, "];");
}

fn push(out: &mut String, line: &str) {
    let _ = writeln!(out, "{line}");
}

fn is_crc(message: &Message, signal: &Signal) -> bool {
    message.data_id != 0 && signal.name == "Crc"
}

fn field_doc(signal: &Signal) -> String {
    if signal.is_plain_integer() {
        return one_line(&signal.comment);
    }
    let (field, unit) = (&signal.field, &signal.unit);
    format!(
        "{} {} to {} {unit}, {} {unit} on the wire.",
        one_line(&signal.comment),
        field.min,
        field.max,
        field.factor
    )
}

fn field_literal(field: &Field) -> String {
    format!(
        "Field {{ start: {}, length: {}, big_endian: {}, kind: Kind::{:?}, factor: {:?}, \
         offset: {:?}, min: {:?}, max: {:?} }}",
        field.start,
        field.length,
        field.big_endian,
        field.kind,
        field.factor,
        field.offset,
        field.min,
        field.max
    )
}

/// `MeanStroke` in mm becomes `mean_stroke_mm`.
fn field_name(signal: &Signal) -> String {
    let suffix = match signal.unit.as_str() {
        "" => "",
        "%" => "_percent",
        "m/s" => "_m_s",
        "mm/s" => "_mm_s",
        "deg/s" => "_deg_s",
        "degC" => "_deg_c",
        unit => return format!("{}_{}", snake(&signal.name), unit.to_lowercase()),
    };
    format!("{}{suffix}", snake(&signal.name))
}

fn constant_name(signal: &Signal) -> String {
    snake(&signal.name).to_uppercase()
}

/// `FrontAngle` to `front_angle`, `FR_A` to `fr_a`, `Pump1A` to `pump1_a`.
fn snake(name: &str) -> String {
    let mut out = String::new();
    let mut before: Option<char> = None;
    for c in name.chars() {
        let starts = c.is_ascii_uppercase()
            && before.is_some_and(|b| b.is_ascii_lowercase() || b.is_ascii_digit());
        if starts {
            out.push('_');
        }
        out.push(c.to_ascii_lowercase());
        before = Some(c);
    }
    out
}

/// `EEC1` to `Eec1`; names with lower case in them stay.
fn type_name(name: &str) -> String {
    if name.chars().any(|c| c.is_ascii_lowercase()) {
        return name.replace('_', "");
    }
    let (first, rest) = name.split_at(1.min(name.len()));
    format!("{first}{}", rest.to_lowercase())
}

/// "manual position" to `ManualPosition`.
fn variant_name(text: &str) -> String {
    text.split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .map(|word| {
            let (first, rest) = word.split_at(1);
            first.to_uppercase() + rest
        })
        .collect()
}
