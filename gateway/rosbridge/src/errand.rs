//! What the owner of a server wants of its thread.

use std::time::Duration;

use serde_json::Value;

use crate::bridge::{Call, ClientId};

/// One thing to be done.
pub(crate) enum Errand {
    Publish { at: Duration, topic: &'static str, message: Value },
    Respond { call: Call, answer: Result<Value, String> },
    Complain { client: ClientId, why: String },
    End,
}
