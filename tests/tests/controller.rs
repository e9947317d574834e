//! A controller outside, over rosbridge, at the wheel of a run in lockstep.

use std::io;
use std::net::{SocketAddr, TcpStream};
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use serde_json::{Value, json};
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};
use xt28_scenarios::{Controller, Driven, Lockstep, Recording, RunError, Scenario, Setup, Terms};

/// So long without an answer is no busy machine any more.
const PATIENCE: Duration = Duration::from_secs(60);

fn setup(name: &str, pace: &str) -> Setup {
    let mut scenario = Scenario::find(name).unwrap();
    scenario.drive_by(&format!("rosbridge:0{pace}")).unwrap();
    let setup = Setup::new(scenario, None).unwrap();
    setup.ensure_startable().unwrap();
    setup
}

/// A run, and all that was said on the way.
struct Drive {
    recording: Recording,
    told: Vec<String>,
}

impl Drive {
    fn driven(&self) -> &Driven {
        self.recording.driven.as_ref().unwrap()
    }
}

/// Runs under a controller that is started once the address is known.
fn drive<T>(setup: &Setup, start: impl FnOnce(SocketAddr) -> T) -> Result<(Drive, T), RunError> {
    let told = Arc::new(Mutex::new(Vec::new()));
    let controller = listening(setup, PATIENCE, &told);
    let started = start(controller.address());
    let mut run = Lockstep::with_controller(setup, controller, io::sink())?;
    while run.tick(&mut || Duration::ZERO)?.is_some() {}
    let recording = run.finish()?;
    let told = std::mem::take(&mut *told.lock().unwrap());
    Ok((Drive { recording, told }, started))
}

fn listening(setup: &Setup, patience: Duration, told: &Arc<Mutex<Vec<String>>>) -> Controller {
    let told = Arc::clone(told);
    let hearer = Box::new(move |_, what: &str| told.lock().unwrap().push(what.to_owned()));
    Controller::open(setup, Terms { patience, waits_for_each: true }, hearer).unwrap().unwrap()
}

struct Client(WebSocket<MaybeTlsStream<TcpStream>>);

impl Client {
    fn connect(address: SocketAddr) -> Self {
        let mut client = Self(tungstenite::connect(format!("ws://{address}/")).unwrap().0);
        client.say(&json!({ "op": "subscribe", "topic": "/xt28/observation" }));
        client
    }

    fn say(&mut self, message: &Value) {
        // One whose server is gone has nobody to say it to.
        let _ = self.0.send(Message::text(message.to_string()));
    }

    fn act(&mut self, seen: &Value, action: [f64; 8]) {
        let msg = json!({ "seq": seen["seq"], "action": action });
        self.say(&json!({ "op": "publish", "topic": "/xt28/action", "msg": msg }));
    }

    /// The next message; none once the run is over.
    fn hear(&mut self) -> Option<Value> {
        loop {
            match self.0.read() {
                Ok(Message::Text(text)) => return Some(serde_json::from_str(&text).unwrap()),
                Ok(_) => {}
                Err(_) => return None,
            }
        }
    }

    /// The next observation.
    fn see(&mut self) -> Option<Value> {
        loop {
            let heard = self.hear()?;
            if heard["op"] == "publish" {
                return Some(heard["msg"].clone());
            }
        }
    }
}

/// A controller that does `step` with each observation, and leaves once that says no.
fn controller(
    address: SocketAddr,
    mut step: impl FnMut(&mut Client, &Value) -> bool + Send + 'static,
) -> JoinHandle<()> {
    thread::spawn(move || {
        let mut client = Client::connect(address);
        while let Some(seen) = client.see() {
            if !step(&mut client, &seen) {
                break;
            }
        }
    })
}

const ONWARD: [f64; 8] = [0.4, 0.0, 0.36, 0.36, 0.36, 0.36, 0.36, 0.36];
const BACK: [f64; 8] = [-1.0; 8];

#[test]
fn a_controller_that_falls_silent_stops_the_machine() {
    let setup = setup("straight-25m", "");
    let (drive, thread) = drive(&setup, |address| {
        controller(address, |client, seen| {
            client.act(seen, ONWARD);
            seen["time_s"].as_f64().unwrap() < 8.0
        })
    })
    .unwrap();
    thread.join().unwrap();
    let stop = drive.driven().safety_stop.as_ref().expect("a safety stop");
    assert_eq!(stop.reason, "policy silent");
    assert!((8.0..8.7).contains(&stop.at_s), "{}", stop.at_s);
    assert!(drive.told.iter().any(|why| why.contains("has left")), "{:?}", drive.told);
}

/// Drives ahead; at the tenth observation it says what `rubbish` makes of that one, before its answer.
fn drive_saying(rubbish: impl Fn(&Value) -> Vec<Value> + Send + Clone + 'static) -> Drive {
    let setup = setup("straight-25m", "");
    let (drive, thread) = drive(&setup, |address| {
        controller(address, move |client, seen| {
            if seen["seq"] == 30 {
                for message in rubbish(seen) {
                    client.say(&message);
                    let told = client.hear().unwrap();
                    let refused = told["op"] == "status" || told["result"] == false;
                    assert!(refused, "{message}: {told}");
                }
            }
            client.act(seen, ONWARD);
            true
        })
    })
    .unwrap();
    thread.join().unwrap();
    drive
}

#[test]
fn what_is_no_action_is_refused_with_the_remedy_and_moves_nothing() {
    let action = |msg| json!({ "op": "publish", "topic": "/xt28/action", "msg": msg });
    let spoiled = drive_saying(move |seen| {
        let all = [
            json!({ "action": ONWARD }),
            json!({ "seq": seen["seq"], "action": [0.0, 1.0] }),
            json!({ "seq": seen["seq"], "action": ONWARD, "speed": 1 }),
            json!({ "seq": 1000, "action": ONWARD }),
            json!({ "seq": 0, "action": ONWARD }),
            json!({ "seq": 29, "action": BACK }),
            json!([0.0]),
            json!({ "seq": seen["seq"], "action": ONWARD, "\u{1b}[31mred\n": 1 }),
        ];
        let finish = json!({ "op": "call_service", "id": 1, "service": "/xt28/finish" });
        all.map(action).into_iter().chain([finish]).collect()
    });
    let clean = drive_saying(|_| Vec::new());
    assert_eq!(spoiled.recording.log_sha256, clean.recording.log_sha256);
    assert_eq!(spoiled.driven().outcome, "endless");
    assert!(!spoiled.told.iter().any(|why| why.contains(char::is_control)), "{:?}", spoiled.told);
    for says in ["missing field `seq`", "invalid length 2", "unknown field `speed`", "1000 yet"] {
        assert!(spoiled.told.iter().any(|why| why.contains(says)), "{says}: {:?}", spoiled.told);
    }
}

#[test]
fn a_task_is_ended_by_who_drives_and_by_nobody_before() {
    let setup = setup("straight-25m", "");
    let (drive, thread) = drive(&setup, |address| {
        controller(address, |client, seen| {
            let call =
                json!({ "op": "call_service", "id": 1, "service": "/xt28/finish", "args": [true] });
            client.say(&call);
            let first = seen["seq"] == 1;
            assert_eq!(client.hear().unwrap()["result"], !first);
            client.act(seen, ONWARD);
            first
        })
    })
    .unwrap();
    thread.join().unwrap();
    // From then on nobody answers, and nothing stops a machine that only stands.
    assert_eq!((drive.driven().outcome.as_str(), &drive.driven().safety_stop), ("reached", &None));
    assert!(drive.told.iter().any(|what| what.ends_with(" drives")), "{:?}", drive.told);
    assert!(drive.told.iter().any(|what| what.contains("can end its task")), "{:?}", drive.told);
}

#[test]
fn one_drives_and_everybody_may_stop() {
    let setup = setup("straight-25m", "");
    let (drive, thread) = drive(&setup, |address| {
        let mut other = None;
        controller(address, move |client, seen| {
            let time_s = seen["time_s"].as_f64().unwrap();
            if time_s > 4.0 && other.is_none() {
                let mut client = Client::connect(address);
                let seen = client.see().unwrap();
                client.act(&seen, [1.0; 8]);
                let told = client.hear().unwrap();
                assert_eq!(told["msg"], "another controller drives");
                client.say(&json!({ "op": "call_service", "id": 1,
                                    "service": "/xt28/emergency_stop" }));
                while client.hear().unwrap()["op"] != "service_response" {}
                other = Some(client);
            }
            client.act(seen, ONWARD);
            true
        })
    })
    .unwrap();
    thread.join().unwrap();
    let stop = drive.driven().safety_stop.as_ref().expect("a stop");
    assert_eq!(stop.reason, "emergency stop");
    assert!((4.0..4.3).contains(&stop.at_s), "{}", stop.at_s);
}

#[test]
fn who_waits_to_drive_does_not_take_over_a_machine_that_moves() {
    let setup = setup("straight-25m", "");
    let (drive, thread) = drive(&setup, |address| {
        thread::spawn(move || {
            let mut driver = Client::connect(address);
            let mut other = loop {
                let seen = driver.see().unwrap();
                if seen["time_s"].as_f64().unwrap() > 4.0 {
                    // Both have seen it; one leaves without an answer.
                    break Client::connect(address);
                }
                driver.act(&seen, ONWARD);
            };
            drop(driver);
            while let Some(seen) = other.see() {
                other.act(&seen, BACK);
            }
        })
    })
    .unwrap();
    thread.join().unwrap();
    let stop = drive.driven().safety_stop.as_ref().expect("a safety stop");
    assert_eq!(stop.reason, "policy silent");
    assert!((4.0..4.7).contains(&stop.at_s), "{}", stop.at_s);
}

#[test]
fn an_observation_is_answered_once_so_that_a_hasty_controller_drives_the_same_twice() {
    let setup = setup("turn-left", "");
    let once = || {
        let (drive, thread) = drive(&setup, |address| {
            controller(address, |client, seen| {
                client.act(seen, ONWARD);
                client.act(seen, [0.0; 8]);
                true
            })
        })
        .unwrap();
        thread.join().unwrap();
        assert!(drive.told.iter().any(|why| why.contains("answered already")), "{:?}", drive.told);
        drive.recording.log_sha256
    };
    assert_eq!(once(), once());
}

#[test]
fn at_each_tick_a_controller_sees_the_machine_without_fixes_between() {
    let setup = setup("bumpy-field", ",tick");
    let (drive, thread) = drive(&setup, |address| {
        let (mut count, mut last_s) = (0, 0.0);
        controller(address, move |client, seen| {
            let time_s = seen["time_s"].as_f64().unwrap();
            assert!(count == 0 || (time_s - last_s - 0.01).abs() < 1e-9, "{last_s} {time_s}");
            let map = seen["height_map_m"].as_array().map(Vec::len);
            assert_eq!(map, seen["located"].is_object().then_some(600));
            (count, last_s) = (count + 1, time_s);
            client.act(seen, [0.0; 8]);
            count < 500
        })
    })
    .unwrap();
    thread.join().unwrap();
    assert_eq!(drive.driven().safety_stop.as_ref().unwrap().reason, "policy silent");
}

#[test]
fn nobody_at_the_wheel_is_said_after_a_while() {
    let setup = setup("straight-25m", "");
    let controller = listening(&setup, Duration::from_millis(50), &Arc::default());
    let mut run = Lockstep::with_controller(&setup, controller, io::sink()).unwrap();
    let error = loop {
        match run.tick(&mut || Duration::ZERO) {
            Ok(ticked) => assert!(ticked.is_some(), "the run went on without a controller"),
            Err(error) => break error.to_string(),
        }
    };
    assert!(error.contains("ws://127.0.0.1:") && error.contains("within 50ms"), "{error}");
    assert!(error.contains("nobody has answered an observation yet (1 is asked)"), "{error}");
    // Where nothing listens there is nothing to wait for.
    let error = Lockstep::new(&setup, io::sink()).err().unwrap().to_string();
    assert!(error.contains("--policy: ") && error.contains("xt28 run"), "{error}");
}
