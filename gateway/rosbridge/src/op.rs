//! One message of a client, read from its text.

use serde::Deserialize;
use serde_json::Value;

/// What a client wants, as the protocol has it. Keys that are not listed (a subscription's `queue_length`, a
/// publisher's `latch`) change nothing here and are passed over.
#[derive(Debug, Deserialize)]
#[serde(tag = "op", rename_all = "snake_case")]
pub(crate) enum Op {
    Advertise {
        topic: String,
        #[serde(rename = "type")]
        kind: String,
    },
    Unadvertise {
        topic: String,
    },
    Publish {
        topic: String,
        msg: Value,
    },
    Subscribe {
        topic: String,
        #[serde(default, rename = "type")]
        kind: Option<String>,
        /// Least time between two messages, ms.
        #[serde(default)]
        throttle_rate: Option<f64>,
        #[serde(default)]
        fragment_size: Option<u64>,
        #[serde(default)]
        compression: Option<String>,
    },
    Unsubscribe {
        topic: String,
    },
    CallService {
        service: String,
        #[serde(default)]
        args: Value,
    },
    SetLevel {
        level: Level,
    },
}

/// How much of what is wrong a client wants to be told, most first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Level {
    Info,
    Warning,
    Error,
    None,
}

impl Level {
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Info => "info",
            Self::Warning => "warning",
            Self::Error => "error",
            Self::None => "none",
        }
    }
}

/// A message, with what the client calls it by.
#[derive(Debug)]
pub(crate) struct Message {
    pub(crate) id: Option<Value>,
    pub(crate) op: Op,
}

/// A text that is no message, and what is wrong with it.
#[derive(Debug)]
pub(crate) struct Unread {
    pub(crate) id: Option<Value>,
    pub(crate) why: String,
}

/// Longest identifier, bytes.
const ID_MAX: usize = 256;

/// Reads a text.
pub(crate) fn read(text: &str) -> Result<Message, Unread> {
    let value: Value = serde_json::from_str(text).map_err(|error| Unread {
        id: None,
        why: format!("not JSON: {error} (NaN and infinity have no form in it)"),
    })?;
    let id = match value.get("id") {
        None | Some(Value::Null) => None,
        Some(id @ Value::Number(_)) => Some(id.clone()),
        Some(Value::String(id)) if id.len() <= ID_MAX => Some(Value::from(id.as_str())),
        Some(_) => {
            let why = format!("an id is a number or a string of at most {ID_MAX} bytes");
            return Err(Unread { id: None, why });
        }
    };
    match Op::deserialize(value) {
        Ok(op) => Ok(Message { id, op }),
        Err(error) => Err(Unread { id, why: error.to_string() }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_roslibpy_sends_is_read() {
        let text = r#"{"op": "subscribe", "id": "subscribe:/a:1", "type": "std_msgs/String", "topic": "/a",
            "compression": "none", "throttle_rate": 100, "queue_length": 0}"#;
        let Message { id, op } = read(text).unwrap();
        assert_eq!(id, Some(Value::from("subscribe:/a:1")));
        assert!(matches!(op, Op::Subscribe { throttle_rate: Some(100.0), .. }), "{op:?}");
    }

    #[test]
    fn what_is_none_is_said_to_be() {
        for (text, says) in [
            ("", "EOF"),
            ("[]", "op"),
            (r#"{"topic": "/a"}"#, "missing field `op`"),
            (r#"{"op": "shout"}"#, "unknown variant `shout`, expected one of `advertise`"),
            (r#"{"op": "publish", "topic": "/a"}"#, "missing field `msg`"),
            (r#"{"op": "publish", "topic": "/a", "msg": {"x": NaN}}"#, "NaN and infinity"),
        ] {
            let why = read(text).unwrap_err().why;
            assert!(why.contains(says), "{text}: {why}");
        }
        for id in ["[]", "{}", "true", &format!("{:?}", "x".repeat(257))] {
            let text = format!(r#"{{"op": "unsubscribe", "topic": "/a", "id": {id}}}"#);
            assert!(read(&text).unwrap_err().why.contains("256 bytes"), "{id}");
        }
        assert_eq!(read(r#"{"op": "shout", "id": 7}"#).unwrap_err().id, Some(Value::from(7)));
    }
}
