//! Statements about messages and signals that the database does not declare: a slip in a name that
//! would pass in silence, and read a float as an integer or lose a multiplexer.

use can_dbc::{Comment, Dbc, MessageId, ValueDescription};

use crate::{Harm, Problem};

/// Editors keep signals without a message here; no frame has this identifier.
const NO_MESSAGE: &str = "VECTOR__INDEPENDENT_SIG_MSG";

/// Every such statement, with the identifier it names. Those on how bits are read were meant for some
/// signal of the message, if it has that identifier.
pub(crate) fn stray(dbc: &Dbc) -> Vec<(u32, Problem)> {
    let mut problems = Vec::new();
    let mut say = |keyword: &str, id: MessageId, signal: Option<&str>, harm: Harm| {
        if declares(dbc, id, signal) {
            return;
        }
        let id = id.raw();
        let place =
            signal.map_or_else(|| format!("{keyword} {id}"), |s| format!("{keyword} {id} {s}"));
        let what = "is about nothing declared; mend its name".to_owned();
        problems.push((id, Problem { place, what, harm, signal: None }));
    };
    for statement in &dbc.signal_extended_value_type_list {
        say("SIG_VALTYPE_", statement.message_id, Some(&statement.signal_name), Harm::Misread);
    }
    for statement in &dbc.extended_multiplex {
        say("SG_MUL_VAL_", statement.message_id, Some(&statement.signal_name), Harm::Misread);
    }
    for statement in &dbc.value_descriptions {
        if let ValueDescription::Signal { message_id, name, .. } = statement {
            say("VAL_", *message_id, Some(name), Harm::Untidy);
        }
    }
    for statement in &dbc.attribute_values_message {
        say("BA_", statement.message_id, None, Harm::Untidy);
    }
    for statement in &dbc.comments {
        match statement {
            Comment::Message { id, .. } => say("CM_", *id, None, Harm::Untidy),
            Comment::Signal { message_id, name, .. } => {
                say("CM_", *message_id, Some(name), Harm::Untidy)
            }
            _ => {}
        }
    }
    problems
}

fn declares(dbc: &Dbc, id: MessageId, signal: Option<&str>) -> bool {
    dbc.messages.iter().filter(|message| message.id == id).any(|message| {
        message.name == NO_MESSAGE
            || signal.is_none_or(|name| message.signals.iter().any(|s| s.name == name))
    })
}
