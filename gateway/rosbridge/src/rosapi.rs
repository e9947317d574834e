//! The services by which clients ask what there is.

use std::time::Duration;

use serde_json::{Value, json};

use crate::catalogue::{Catalogue, Service, is_name};

/// Those that are here, beside the owner's own.
pub(crate) const SERVICES: &[Service] = &[
    service("/rosapi/topics", "rosapi/Topics"),
    service("/rosapi/topic_type", "rosapi/TopicType"),
    service("/rosapi/services", "rosapi/Services"),
    service("/rosapi/service_type", "rosapi/ServiceType"),
    service("/rosapi/get_time", "rosapi/GetTime"),
];

/// One that is answered at once, so that nothing of its arguments is handed on.
const fn service(name: &'static str, kind: &'static str) -> Service {
    Service { name, kind, urgent: false, distil: |_| Ok(Value::Null) }
}

/// The answer of one of [`SERVICES`]. An unknown name has the type "", as in rosapi.
pub(crate) fn answer(service: &str, args: &Value, catalogue: &Catalogue, now: Duration) -> Value {
    let services = || catalogue.services.iter().chain(SERVICES);
    let asked = |key: &str| args.get(key).and_then(Value::as_str).unwrap_or_default();
    match service {
        "/rosapi/topics" => {
            let topics = catalogue.topics().map(|topic| topic.name);
            let kinds = catalogue.topics().map(|topic| topic.kind);
            json!({ "topics": topics.collect::<Vec<_>>(), "types": kinds.collect::<Vec<_>>() })
        }
        "/rosapi/topic_type" => {
            let found = catalogue.topics().find(|topic| is_name(asked("topic"), topic.name));
            json!({ "type": found.map_or("", |topic| topic.kind) })
        }
        "/rosapi/services" => {
            json!({ "services": services().map(|service| service.name).collect::<Vec<_>>() })
        }
        "/rosapi/service_type" => {
            let found = services().find(|service| is_name(asked("service"), service.name));
            json!({ "type": found.map_or("", |service| service.kind) })
        }
        _ => json!({ "time": { "secs": now.as_secs(), "nsecs": now.subsec_nanos() } }),
    }
}
