//! The built-in database against frames worked out by hand: everything else that reads or writes a
//! frame reads the same database, and would be wrong with it.

use xt28_dbc::messages::{ArmStatus, ArmTarget, ArmValve, DriveStatus, DriveTarget};
use xt28_dbc::model::Database;
use xt28_dbc::{CanId, Frame, database};

/// A frame and what it says.
struct Vector {
    frame: Frame,
    name: &'static str,
    /// Where the sources give one.
    period_ms: Option<u32>,
    data_id: Option<u16>,
    says: Vec<(&'static str, f64)>,
}

fn frame(text: &str) -> Frame {
    let (id, data) = text.split_once('#').unwrap();
    let raw = u32::from_str_radix(id, 16).unwrap();
    // As candump does: three digits are 11 bits, eight are 29.
    let id = if id.len() == 3 { CanId::standard(raw as u16) } else { CanId::extended(raw) };
    let byte = |at: usize| u8::from_str_radix(&data[at..at + 2], 16).unwrap();
    let bytes: Vec<u8> = (0..data.len()).step_by(2).map(byte).collect();
    Frame::new(id.unwrap(), &bytes).unwrap()
}

fn vectors() -> Vec<Vector> {
    let mut vectors: Vec<Vector> = Vec::new();
    let lines = include_str!("wire_vectors.txt").lines();
    for line in lines.filter(|line| !line.is_empty() && !line.starts_with('#')) {
        let words: Vec<&str> = line.split_whitespace().collect();
        if line.starts_with(' ') {
            let pair = |word: &'static str| {
                let (name, value) = word.split_once('=').unwrap();
                (name, value.parse().unwrap())
            };
            vectors.last_mut().unwrap().says.extend(words.into_iter().map(pair));
        } else {
            let [bytes, name, period, data_id] = words[..] else { panic!("{line}") };
            vectors.push(Vector {
                frame: frame(bytes),
                name,
                period_ms: period.parse().ok(),
                data_id: u16::from_str_radix(data_id, 16).ok(),
                says: Vec::new(),
            });
        }
    }
    vectors
}

fn message<'a>(database: &'a Database, vector: &Vector) -> &'a xt28_dbc::model::Message {
    let message = database.message(vector.frame.id().dbc()).expect(vector.name);
    assert_eq!(message.name, vector.name);
    message
}

#[test]
fn hand_made_frames_are_decoded_as_the_contract_says() {
    let database = database();
    for vector in vectors() {
        let decoded = message(&database, &vector).decode(vector.frame.data()).unwrap();
        let names: Vec<&str> = decoded.iter().map(|(signal, _)| signal.name.as_str()).collect();
        let wanted: Vec<&str> = vector.says.iter().map(|(name, _)| *name).collect();
        assert_eq!(names, wanted, "{}", vector.name);
        for ((_, value), (name, wanted)) in decoded.iter().zip(&vector.says) {
            // The factors 0.1 and 0.01 are no sums of powers of two.
            let close = (value - wanted).abs() < 1e-9;
            assert!(close, "{}.{name}: {value} instead of {wanted}", vector.name);
        }
    }
}

#[test]
fn what_hand_made_frames_say_is_encoded_to_their_bytes() {
    let database = database();
    for vector in vectors() {
        let data = message(&database, &vector).encode(&vector.says).unwrap();
        let encoded = Frame::new(vector.frame.id(), &data).unwrap();
        assert_eq!(encoded, vector.frame, "{}", vector.name);
    }
}

#[test]
fn periods_and_data_ids_are_those_of_the_contract() {
    let database = database();
    for vector in vectors() {
        let message = message(&database, &vector);
        assert_eq!(message.data_id, vector.data_id.unwrap_or(0), "{}", vector.name);
        if let Some(period_ms) = vector.period_ms {
            assert_eq!(message.period_ms, period_ms, "{}", vector.name);
        }
    }
}

#[test]
fn modes_states_and_fixes_have_the_numbers_of_the_contract() {
    let modes = &[(0, "off"), (1, "automatic"), (2, "manual position"), (3, "manual valve")];
    let states = &[(0, "init"), (1, "standby"), (2, "active"), (3, "safe stop"), (4, "fault")];
    let database = database();
    for (name, signal, wanted) in [
        ("ArmTarget", "Mode", &modes[..]),
        ("ArmStatus", "Mode", modes),
        ("ArmStatus", "State", states),
        ("DriveStatus", "State", states),
        // What lies between is not in the contract.
        ("GnssQuality", "Fix", &[(0, "none"), (4, "rtk fixed")]),
    ] {
        let values = &database.message_named(name).unwrap().signal(signal).unwrap().values;
        for (raw, said) in wanted {
            assert!(values.contains(&(*raw, (*said).to_owned())), "{name}.{signal}: {values:?}");
        }
    }
}

/// The CRC needs the data ID, which is in none of the frame's bits.
#[test]
fn protected_frames_made_by_hand_are_believed_and_made_again() {
    let vectors = vectors();
    let frame_of =
        |name: &str| vectors.iter().find(|v| v.name == name).expect("in the table").frame;
    macro_rules! made_again {
        ($($message:ident),*) => {$(
            let frame = frame_of(stringify!($message));
            assert_eq!($message::decode(&frame).unwrap().encode().unwrap(), frame);
        )*};
    }
    made_again!(ArmTarget, DriveTarget, ArmValve, ArmStatus, DriveStatus);
}

#[test]
fn every_message_but_those_of_the_old_firmware_alone_has_a_frame_in_the_table() {
    let vectors = vectors();
    let database = database();
    for message in database.messages() {
        let listed = vectors.iter().any(|vector| vector.name == message.name);
        assert!(listed || message.comment.contains("Firmware of 2016."), "{}", message.name);
    }
}
