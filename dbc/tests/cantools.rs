//! Our codec against cantools, value by value, on our database and on one with everything odd in it.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // a test finds its oracle and says when it has none

use std::io::{self, Write};
use std::process::{Command, Stdio};

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use xt28_dbc::model::{Database, Message, Signal};
use xt28_dbc::{CanId, Frame, messages};

const CASES_PER_MESSAGE: usize = 200;

fn python_with_cantools() -> Option<&'static str> {
    let found = Command::new("python3")
        .args(["-c", "import cantools"])
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success());
    if found {
        return Some("python3");
    }
    assert!(
        std::env::var_os("CI").is_none(),
        "CI needs python3 with cantools (pip install cantools)"
    );
    let _ = writeln!(io::stdout(), "SKIPPED: python3 has no cantools; pip install cantools");
    None
}

/// A random allowed value of a signal, on its raw grid.
fn value(signal: &Signal, random: &mut ChaCha8Rng) -> f64 {
    let field = &signal.field;
    if field.is_float() {
        return f64::from(random.random_range(-1.0e6_f32..1.0e6));
    }
    loop {
        let value = field.physical(random.random::<u64>() & u64::MAX >> (64 - field.length));
        if (field.min..=field.max).contains(&value) {
            return value;
        }
    }
}

/// Random values of the signals that are there together.
fn values(message: &Message, random: &mut ChaCha8Rng) -> Vec<(String, f64)> {
    let mut data = vec![0; usize::from(message.len)];
    let mut values: Vec<(String, f64)> = Vec::new();
    // Switches stand before what they select in both databases.
    for signal in &message.signals {
        if message.is_present(signal, &data) {
            let mut value = value(signal, random);
            if signal.is_switch {
                // Keep to the values that select something.
                let raws: Vec<u64> = message
                    .signals
                    .iter()
                    .filter_map(|s| s.present.as_ref())
                    .filter(|p| p.switch == signal.name)
                    .flat_map(|p| p.ranges.iter().flat_map(|&(low, high)| low..=high))
                    .collect();
                value = field_value(signal, raws[random.random_range(0..raws.len())]);
            }
            signal.field.write(&mut data, value).unwrap();
            values.push((signal.name.clone(), value));
        }
    }
    values
}

fn field_value(signal: &Signal, raw: u64) -> f64 {
    signal.field.physical(raw)
}

fn json(path: &str, message: &str, values: &[(String, f64)], data: &[u8]) -> String {
    let values: Vec<String> = values.iter().map(|(n, v)| format!("\"{n}\": {v:?}")).collect();
    let hex: String = data.iter().map(|byte| format!("{byte:02x}")).collect();
    let values = values.join(", ");
    format!(
        "{{\"dbc\": \"{path}\", \"message\": \"{message}\", \"values\": {{{values}}}, \"data\": \"{hex}\"}}\n"
    )
}

#[test]
fn cantools_encodes_and_decodes_the_same() {
    let Some(python) = python_with_cantools() else { return };
    let mut random = ChaCha8Rng::seed_from_u64(28);
    let mut cases = String::new();
    for path in ["xt28.dbc", "tests/oracle.dbc"] {
        let database = Database::parse(&std::fs::read_to_string(path).unwrap(), path).unwrap();
        for message in database.messages() {
            for _ in 0..CASES_PER_MESSAGE {
                let values = values(message, &mut random);
                let named: Vec<(&str, f64)> =
                    values.iter().map(|(n, v)| (n.as_str(), *v)).collect();
                let data = message.encode(&named).unwrap();
                let back = message.decode(&data).unwrap();
                assert_eq!(back.len(), values.len());
                cases += &json(path, &message.name, &values, &data);
            }
        }
    }
    let mut oracle = Command::new(python)
        .arg("tests/oracle.py")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = oracle.stdin.take().unwrap();
    let writer = std::thread::spawn(move || input.write_all(cases.as_bytes()));
    let output = oracle.wait_with_output().unwrap();
    writer.join().unwrap().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}");
    let expected = (messages::MESSAGES.len() + 4) * CASES_PER_MESSAGE;
    assert_eq!(said.trim(), format!("{expected} cases, 0 differ"));
}

/// The generated types and the run-time model must be one and the same conversion.
#[test]
fn generated_types_agree_with_the_database() {
    let database = xt28_dbc::database();
    let message = database.message(messages::WheelSpeedSigned::ID.dbc()).unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(3);
    for _ in 0..1000 {
        let mut speed = || f64::from(random.random_range(-512_i32..=511)) * 0.1;
        let typed = messages::WheelSpeedSigned {
            fr_rpm: speed(),
            fl_rpm: speed(),
            mr_rpm: speed(),
            ml_rpm: speed(),
            br_rpm: speed(),
            bl_rpm: speed(),
            counter: 9,
        };
        let frame = typed.encode().unwrap();
        let named = [
            ("FR", typed.fr_rpm),
            ("FL", typed.fl_rpm),
            ("MR", typed.mr_rpm),
            ("ML", typed.ml_rpm),
            ("BR", typed.br_rpm),
            ("BL", typed.bl_rpm),
            ("Counter", 9.0),
        ];
        assert_eq!(message.encode(&named).unwrap(), frame.data());
        let back = messages::WheelSpeedSigned::decode(&frame).unwrap();
        assert_eq!(back.encode().unwrap(), frame);
    }
}

#[test]
fn a_value_that_no_frame_can_say_is_refused() {
    let target = messages::DriveTarget::default();
    for throttle_percent in [f64::NAN, f64::INFINITY, 100.2, -100.2] {
        let bad = messages::DriveTarget { throttle_percent, ..target };
        let error = bad.encode().unwrap_err().to_string();
        assert!(error.starts_with("DriveTarget.Throttle: "), "{error}");
    }
    let short = Frame::new(CanId::Extended(0x0CFF_4127), &[0; 7]).unwrap();
    let error = messages::DriveTarget::decode(&short).unwrap_err().to_string();
    assert_eq!(error, "DriveTarget: 7 bytes instead of 8");
}
