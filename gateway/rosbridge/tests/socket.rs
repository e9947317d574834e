//! A server and its clients on sockets of this machine.
#![allow(clippy::disallowed_methods)] // real sockets take real time

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tungstenite::protocol::frame::coding::CloseCode;
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{ClientRequestBuilder, Message, WebSocket};
use xt28_rosbridge::{Catalogue, Event, Server, Service, Taken, Topic};

const CATALOGUE: Catalogue = Catalogue {
    published: &[Topic { name: "/state", kind: "std_msgs/String" }],
    taken: &[Taken {
        topic: Topic { name: "/goal", kind: "std_msgs/Float64" },
        distil: |message| Ok(message.clone()),
    }],
    services: &[Service {
        name: "/halt",
        kind: "std_srvs/Trigger",
        urgent: true,
        distil: |args| Ok(args.clone()),
    }],
};
/// So long without an answer is no busy machine any more.
const PATIENCE: Duration = Duration::from_secs(20);

type Client = WebSocket<MaybeTlsStream<TcpStream>>;

fn server() -> Server {
    Server::open(SocketAddr::from(([127, 0, 0, 1], 0)), CATALOGUE).unwrap()
}

fn connect(server: &Server) -> Client {
    let (client, _) = tungstenite::connect(format!("ws://{}/", server.address())).unwrap();
    if let MaybeTlsStream::Plain(stream) = client.get_ref() {
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
    }
    client
}

fn say(client: &mut Client, message: &Value) {
    client.send(Message::text(message.to_string())).unwrap();
}

fn hear(client: &mut Client) -> Value {
    loop {
        if let Message::Text(text) = client.read().unwrap() {
            return serde_json::from_str(&text).unwrap();
        }
    }
}

/// Everything that was said before has been taken once this is answered.
fn catch_up(client: &mut Client) {
    say(client, &json!({ "op": "call_service", "id": "up", "service": "/rosapi/get_time" }));
    assert_eq!(hear(client)["id"], "up");
}

#[test]
fn topics_and_services_go_both_ways() {
    let server = server();
    let mut client = connect(&server);
    say(&mut client, &json!({ "op": "subscribe", "topic": "/state" }));
    catch_up(&mut client);
    server.publish(Duration::from_secs(1), "/state", json!({ "data": "up" }));
    assert_eq!(hear(&mut client)["msg"], json!({ "data": "up" }));
    // As bytes, which some clients send.
    let goal = json!({ "op": "publish", "topic": "/goal", "msg": { "data": 2 } }).to_string();
    client.send(Message::binary(goal.into_bytes())).unwrap();
    let Some(Event::Published { message, .. }) = server.event(PATIENCE) else { panic!() };
    assert_eq!(message, json!({ "data": 2 }));
    say(&mut client, &json!({ "op": "call_service", "id": 1, "service": "/halt" }));
    let Some(Event::Called(call)) = server.event(PATIENCE) else { panic!() };
    let caller = call.client;
    server.respond(call, Ok(json!({ "success": true })));
    assert_eq!(hear(&mut client)["values"], json!({ "success": true }));
    client.close(None).unwrap();
    while client.read().is_ok() {}
    assert_eq!(server.event(PATIENCE), Some(Event::Left(caller)));
    assert_eq!(server.event(Duration::ZERO), None);
}

#[test]
fn clients_do_not_hear_one_another_and_hear_the_end() {
    let server = server();
    let [mut one, mut two] = [(); 2].map(|()| connect(&server));
    say(&mut one, &json!({ "op": "subscribe", "topic": "/state" }));
    catch_up(&mut one);
    catch_up(&mut two);
    server.publish(Duration::ZERO, "/state", json!(1));
    assert_eq!(hear(&mut one)["msg"], json!(1));
    catch_up(&mut two);
    drop(server);
    for mut client in [one, two] {
        assert!(matches!(client.read(), Ok(Message::Close(_))));
    }
}

#[test]
fn what_is_no_websocket_or_a_page_of_another_host_is_turned_away() {
    let server = server();
    let mut plain = TcpStream::connect(server.address()).unwrap();
    plain.set_read_timeout(Some(PATIENCE)).unwrap();
    plain.write_all(b"GET / HTTP/1.1\r\nHost: x\r\n\r\n").unwrap();
    let mut answer = Vec::new();
    let _ = plain.read_to_end(&mut answer);
    assert!(!answer.starts_with(b"HTTP/1.1 101"));
    let address = format!("ws://{}/", server.address());
    let from = |origin: &str| {
        let request = ClientRequestBuilder::new(address.parse().unwrap());
        tungstenite::connect(request.with_header("Origin", origin))
    };
    assert!(from("https://example.com").unwrap_err().to_string().contains("403"));
    assert!(from("http://localhost:8000").is_ok());
}

#[test]
fn a_full_house_lets_in_who_can_shake_hands() {
    let server = server();
    let idle: Vec<_> = (0..40).map(|_| TcpStream::connect(server.address()).unwrap()).collect();
    let mut client = connect(&server);
    catch_up(&mut client);
    drop(idle);
}

#[test]
fn who_finds_no_place_is_told_of() {
    let server = server();
    let mut clients: Vec<_> = (0..16).map(|_| connect(&server)).collect();
    clients.iter_mut().for_each(catch_up);
    assert!(tungstenite::connect(format!("ws://{}/", server.address())).is_err());
    let Some(Event::Complained { why, .. }) = server.event(PATIENCE) else {
        panic!("nothing told")
    };
    assert_eq!(why, "turned a client away: 16 are connected already");
    clients.truncate(15);
    // Its place is free once the server has seen it go.
    let begun = Instant::now();
    let mut late = loop {
        match tungstenite::connect(format!("ws://{}/", server.address())) {
            Ok((late, _)) => break late,
            Err(error) => assert!(begun.elapsed() < PATIENCE, "{error}"),
        }
    };
    catch_up(&mut late);
}

#[test]
fn a_call_is_answered_though_its_client_said_too_much_before() {
    let server = server();
    let mut client = connect(&server);
    say(&mut client, &json!({ "op": "set_level", "level": "none" }));
    for n in 0..500 {
        say(&mut client, &json!({ "op": "publish", "topic": "/goal", "msg": n }));
    }
    say(&mut client, &json!({ "op": "call_service", "id": 1, "service": "/halt" }));
    catch_up(&mut client);
    let Some(Event::Called(call)) = server.event(PATIENCE) else { panic!("no call first") };
    server.respond(call, Ok(json!({})));
    assert_eq!(hear(&mut client)["result"], true);
    // Of more calls than anybody takes the rest is refused, and said to be.
    for n in 0..100 {
        say(&mut client, &json!({ "op": "call_service", "id": n, "service": "/halt" }));
    }
    assert_eq!(hear(&mut client)["values"], "too much at a time");
}

#[test]
fn a_client_that_does_not_read_is_let_go_and_the_others_hear_on() {
    let server = server();
    let [mut lazy, mut keen] = [(); 2].map(|()| connect(&server));
    for client in [&mut lazy, &mut keen] {
        say(client, &json!({ "op": "subscribe", "topic": "/state" }));
        catch_up(client);
    }
    let long = "x".repeat(1 << 20);
    let begun = Instant::now();
    let mut let_go = false;
    while !let_go && begun.elapsed() < PATIENCE {
        server.publish(Duration::ZERO, "/state", json!(long));
        assert_eq!(hear(&mut keen)["msg"], json!(long));
        while let Some(event) = server.event(Duration::ZERO) {
            let_go |=
                matches!(event, Event::Complained { why, .. } if why.contains("does not read"));
        }
    }
    assert!(let_go);
    catch_up(&mut keen);
}

/// The longest that is taken is taken; of one that came in many pieces not all has been read when it is refused.
#[test]
fn one_whose_message_is_too_long_is_told_so_before_it_is_let_go() {
    let server = server();
    let mut client = connect(&server);
    let call = |text: String| json!({ "op": "call_service", "id": "up", "service": "/rosapi/get_time", "args": text });
    let spare = 4096 - call(String::new()).to_string().len();
    say(&mut client, &call("x".repeat(spare)));
    assert_eq!(hear(&mut client)["id"], "up");
    for size in [4097, 5127, 20_000] {
        let mut client = connect(&server);
        client.send(Message::text("x".repeat(size))).unwrap();
        let Ok(Message::Close(Some(goodbye))) = client.read() else { panic!("no goodbye") };
        let told = format!("message of {size} bytes, 4096 at most");
        assert_eq!((goodbye.code, goodbye.reason.as_str()), (CloseCode::Size, told.as_str()));
        let Some(Event::Complained { why, .. }) = server.event(PATIENCE) else { panic!("no word") };
        assert_eq!(why, told);
    }
    let mut client = connect(&server);
    client.send(Message::binary(vec![0xFF; 9])).unwrap();
    let Ok(Message::Close(Some(goodbye))) = client.read() else { panic!("no goodbye") };
    assert_eq!(goodbye.code, CloseCode::Invalid);
}

/// Frames without bytes, none of them the last of its message.
#[test]
fn a_message_without_end_holds_up_nobody() {
    let server = server();
    let mut calm = connect(&server);
    let client = connect(&server);
    let MaybeTlsStream::Plain(stream) = client.get_ref() else { panic!("a plain stream") };
    let mut stream = stream.try_clone().unwrap();
    let begun = Instant::now();
    let endless = std::thread::spawn(move || {
        let _ = stream.write_all(&[0x01, 0x81, 0, 0, 0, 0, b'x']);
        let frames = [0x00, 0x80, 0, 0, 0, 0].repeat(4096);
        while begun.elapsed() < PATIENCE && stream.write_all(&frames).is_ok() {}
    });
    while begun.elapsed() < Duration::from_secs(1) {
        catch_up(&mut calm);
    }
    drop(server);
    endless.join().unwrap();
    assert!(begun.elapsed() < PATIENCE, "it went on for {:?}", begun.elapsed());
}

#[test]
fn one_who_shouts_is_told_so_and_the_others_are_served() {
    let server = server();
    let [mut loud, mut calm] = [(); 2].map(|()| connect(&server));
    for n in 0..2000 {
        say(&mut loud, &json!({ "op": "publish", "topic": "/goal", "msg": n }));
    }
    catch_up(&mut calm);
    // Nobody took an event meanwhile.
    let said = hear(&mut loud);
    assert_eq!((&said["op"], &said["msg"]), (&json!("status"), &json!("too much at a time")));
    say(&mut calm, &json!({ "op": "call_service", "id": 1, "service": "/halt" }));
    catch_up(&mut calm);
    let taken: Vec<_> = std::iter::from_fn(|| server.event(Duration::ZERO)).collect();
    assert!(matches!(taken.first(), Some(Event::Called(_))) && taken.len() <= 18, "{taken:?}");
}
