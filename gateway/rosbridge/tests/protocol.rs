//! The protocol without a socket: what clients say, what they hear, what reaches the owner.

use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4};
use std::time::Duration;

use proptest::prelude::*;
use serde_json::{Value, json};
use xt28_rosbridge::{Bridge, Catalogue, ClientId, Event, Heard, Service, Taken, Topic};

const CATALOGUE: Catalogue = Catalogue {
    published: &[Topic { name: "/arm/state", kind: "std_msgs/String" }],
    taken: &[Taken {
        topic: Topic { name: "/arm/goal", kind: "std_msgs/Float64" },
        distil: |message| match message["data"].as_f64() {
            Some(data) => Ok(json!(data)),
            None => Err("no number in data".to_owned()),
        },
    }],
    services: &[Service {
        name: "/arm/halt",
        kind: "std_srvs/Trigger",
        urgent: true,
        distil: |args| Ok(args.clone()),
    }],
};

const FROM: SocketAddr = SocketAddr::V4(SocketAddrV4::new(Ipv4Addr::LOCALHOST, 1));

fn bridge() -> (Bridge, ClientId) {
    let mut bridge = Bridge::new(CATALOGUE);
    let client = bridge.connect(FROM);
    (bridge, client)
}

fn said(heard: &Heard) -> Value {
    serde_json::from_str(heard.reply.as_deref().expect("a reply")).unwrap()
}

/// What is complained of, to the client and to the owner alike.
fn complaint(heard: &Heard) -> String {
    let Some(Event::Complained { why, .. }) = &heard.event else { panic!("{heard:?}") };
    let said = said(heard);
    assert_eq!((&said["op"], &said["level"]), (&json!("status"), &json!("error")));
    assert_eq!(said["msg"], json!(why));
    why.clone()
}

#[test]
fn who_subscribes_hears_it_by_the_name_he_used() {
    let (mut bridge, client) = bridge();
    let at = Duration::from_secs(3);
    let ask = r#"{"op": "subscribe", "id": 1, "topic": "arm/state", "type": "std_msgs/String"}"#;
    assert_eq!(bridge.hear(client, ask), Heard::default());
    let [(to, text)] = &bridge.publish(at, "/arm/state", json!({ "data": "up" }))[..] else {
        panic!("one text")
    };
    assert_eq!(*to, client);
    let text: Value = serde_json::from_str(text).unwrap();
    assert_eq!(text, json!({ "op": "publish", "topic": "arm/state", "msg": { "data": "up" } }));
    bridge.hear(client, r#"{"op": "unsubscribe", "id": 1, "topic": "/arm/state"}"#);
    assert!(bridge.publish(at, "/arm/state", Value::Null).is_empty());
}

#[test]
fn who_comes_late_hears_what_was_said_last() {
    let (mut bridge, client) = bridge();
    for data in ["down", "up"] {
        let message = json!({ "data": data });
        assert!(bridge.publish(Duration::ZERO, "/arm/state", message).is_empty());
    }
    let heard = bridge.hear(client, r#"{"op": "subscribe", "topic": "/arm/state"}"#);
    assert_eq!(said(&heard)["msg"], json!({ "data": "up" }));
}

#[test]
fn what_is_published_reaches_the_owner_by_its_own_name() {
    let (mut bridge, client) = bridge();
    let advertise = r#"{"op": "advertise", "topic": "/arm/goal", "type": "std_msgs/msg/Float64"}"#;
    assert_eq!(bridge.hear(client, advertise), Heard::default());
    let heard =
        bridge.hear(client, r#"{"op": "publish", "topic": "arm/goal", "msg": {"data": 0.5}}"#);
    let message = json!(0.5);
    let event = Event::Published { client, address: FROM, topic: "/arm/goal", message };
    assert_eq!(heard, Heard { reply: None, event: Some(event) });
}

#[test]
fn that_one_has_left_is_told_of_who_had_published() {
    let (mut bridge, client) = bridge();
    bridge.hear(client, r#"{"op": "publish", "topic": "/arm/goal", "msg": {"data": 0.5}}"#);
    assert_eq!(bridge.disconnect(client), Some(Event::Left(client)));
    let watcher = bridge.connect(FROM);
    bridge.hear(watcher, r#"{"op": "subscribe", "topic": "/arm/state"}"#);
    assert_eq!([watcher, client].map(|gone| bridge.disconnect(gone)), [None, None]);
}

#[test]
fn what_there_is_not_is_refused_with_what_there_is() {
    let (mut bridge, client) = bridge();
    for (text, says) in [
        (r#"{"op": "subscribe", "topic": "/arm"}"#, "there are /arm/state"),
        (r#"{"op": "publish", "topic": "/arm/state", "msg": 1}"#, "there are /arm/goal"),
        (r#"{"op": "subscribe", "topic": "/arm/state", "type": "a/B"}"#, "of std_msgs/String"),
        (r#"{"op": "advertise", "topic": "/arm/goal", "type": "a/B"}"#, "of std_msgs/Float64"),
        (r#"{"op": "subscribe", "topic": "/arm/state", "compression": "cbor"}"#, "\"none\""),
        (r#"{"op": "subscribe", "topic": "/arm/state", "fragment_size": 9}"#, "fragment_size"),
        (r#"{"op": "subscribe", "topic": "/arm/state", "throttle_rate": -1}"#, "in ms"),
        (r#"{"op": "advertise_service", "service": "/x", "type": "a/B"}"#, "unknown variant"),
        (r#"{"op": "publish", "topic": "/arm/goal", "msg": {"data": "up"}}"#, "no number in data"),
        ("hello", "not JSON"),
    ] {
        let why = complaint(&bridge.hear(client, text));
        assert!(why.contains(says), "{text}: {why}");
    }
    let heard = bridge.hear(client, r#"{"op": "call_service", "id": "c", "service": "/arm/go"}"#);
    let said = said(&heard);
    assert_eq!((&said["result"], &said["id"]), (&json!(false), &json!("c")));
    assert!(said["values"].as_str().unwrap().contains("there are /arm/halt"));
}

#[test]
fn a_client_that_wants_no_complaints_gets_none_and_the_owner_all() {
    let (mut bridge, client) = bridge();
    bridge.hear(client, r#"{"op": "set_level", "level": "none"}"#);
    let heard = bridge.hear(client, "hello");
    assert!(heard.reply.is_none() && matches!(heard.event, Some(Event::Complained { .. })));
}

#[test]
fn a_call_waits_for_the_owner_and_is_answered_as_it_was_asked() {
    let (mut bridge, client) = bridge();
    let ask =
        r#"{"op": "call_service", "id": "c:1", "service": "arm/halt", "args": {"data": true}}"#;
    let Some(Event::Called(call)) = bridge.hear(client, ask).event else { panic!("no call") };
    assert_eq!((call.service, &call.args), ("/arm/halt", &json!({ "data": true })));
    let answer =
        |answer| -> Value { serde_json::from_str(&Bridge::respond(&call, &answer)).unwrap() };
    let good = json!({ "op": "service_response", "service": "arm/halt", "id": "c:1",
                       "values": { "success": true }, "result": true });
    assert_eq!(answer(Ok(json!({ "success": true }))), good);
    let bad = answer(Err("no".to_owned()));
    assert_eq!((&bad["result"], &bad["values"]), (&json!(false), &json!("no")));
}

#[test]
fn rosapi_says_what_there_is() {
    let (mut bridge, client) = bridge();
    let mut ask = |service: &str, args: Value| -> Value {
        let call = json!({ "op": "call_service", "id": 1, "service": service, "args": args });
        said(&bridge.hear(client, &call.to_string()))["values"].clone()
    };
    assert_eq!(ask("/rosapi/topics", json!({}))["topics"], json!(["/arm/state", "/arm/goal"]));
    let kind = ask("/rosapi/topic_type", json!({ "topic": "/arm/goal" }));
    assert_eq!(kind, json!({ "type": "std_msgs/Float64" }));
    assert_eq!(ask("/rosapi/topic_type", Value::Null), json!({ "type": "" }));
    let names = ask("/rosapi/services", json!({}))["services"].clone();
    assert!(names.as_array().unwrap().contains(&json!("/arm/halt")));
    let kind = ask("/rosapi/service_type", json!({ "service": "/arm/halt" }));
    assert_eq!(kind, json!({ "type": "std_srvs/Trigger" }));
    let mut bridge = Bridge::new(CATALOGUE);
    let client = bridge.connect(FROM);
    bridge.publish(Duration::from_millis(2500), "/arm/state", Value::Null);
    let time = r#"{"op": "call_service", "service": "/rosapi/get_time"}"#;
    let time = said(&bridge.hear(client, time))["values"]["time"].clone();
    assert_eq!(time, json!({ "secs": 2, "nsecs": 500_000_000 }));
}

fn any_json() -> impl Strategy<Value = Value> {
    let name = prop_oneof![
        Just("op".to_owned()),
        Just("topic".to_owned()),
        Just("type".to_owned()),
        Just("/arm/state".to_owned()),
        Just("/arm/goal".to_owned()),
        Just("publish".to_owned()),
        Just("subscribe".to_owned()),
        Just("call_service".to_owned()),
        Just("throttle_rate".to_owned()),
        ".{0,8}",
    ];
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<f64>().prop_map(Value::from),
        any::<u64>().prop_map(Value::from),
        name.clone().prop_map(Value::from),
    ];
    leaf.prop_recursive(3, 24, 6, move |inner| {
        prop_oneof![
            proptest::collection::vec(inner.clone(), 0..6).prop_map(Value::from),
            proptest::collection::btree_map(name.clone(), inner, 0..6)
                .prop_map(|map| Value::Object(map.into_iter().collect())),
        ]
    })
}

fn any_message() -> impl Strategy<Value = String> {
    let ops = prop_oneof![
        Just("advertise"),
        Just("unadvertise"),
        Just("publish"),
        Just("subscribe"),
        Just("unsubscribe"),
        Just("call_service"),
        Just("set_level"),
        Just("shout"),
    ];
    let names = prop_oneof![Just("/arm/state"), Just("/arm/goal"), Just("/arm/halt"), Just("")];
    (ops, names, any_json(), any_json()).prop_map(|(op, name, one, two)| {
        json!({ "op": op, "topic": name, "service": name, "id": one, "type": "std_msgs/String",
                "msg": two, "args": two, "throttle_rate": two, "level": two })
        .to_string()
    })
}

proptest! {
    /// Whatever a client says, the answer is one message of the protocol or none, and a client that says nothing
    /// that is wrong is not complained of.
    #[test]
    fn any_text_is_answered_or_taken(
        texts in proptest::collection::vec(
            prop_oneof![".*", any_json().prop_map(|v| v.to_string()), any_message()],
            0..20,
        )
    ) {
        let (mut bridge, client) = bridge();
        for text in texts {
            let heard = bridge.hear(client, &text);
            if let Some(reply) = &heard.reply {
                let reply: Value = serde_json::from_str(reply).unwrap();
                let op = reply["op"].as_str().unwrap();
                prop_assert!(["status", "service_response", "publish"].contains(&op));
            }
            if let Some(Event::Published { topic, message, .. }) = &heard.event {
                prop_assert_eq!(*topic, "/arm/goal");
                prop_assert!(message.is_number());
            }
            for (to, text) in bridge.publish(Duration::ZERO, "/arm/state", json!("up")) {
                prop_assert_eq!(to, client);
                let text: Value = serde_json::from_str(&text).unwrap();
                prop_assert_eq!(&text["op"], "publish");
            }
        }
    }
}
