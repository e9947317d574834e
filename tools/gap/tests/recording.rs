//! MCAP recordings: the same log as candump's, whatever the chunks, and whatever happens to the file.

use std::collections::BTreeMap;
use std::io::{Cursor, Write as _};
use std::path::Path;
use std::sync::OnceLock;

use flate2::write::GzEncoder;
use mcap::records::MessageHeader;
use mcap::{Compression, WriteOptions};
use proptest::prelude::*;
use xt28_gap::{Decoder, FaultKind, FieldLog, GapError, Mapping};

fn decoder() -> &'static Decoder {
    static DECODER: OnceLock<Decoder> = OnceLock::new();
    DECODER.get_or_init(|| {
        let dbc = include_str!("field.dbc");
        Decoder::parse(dbc, Path::new("field.dbc"), &Mapping::default()).unwrap()
    })
}

/// Instants in ms and frames of a second's log.
fn frames() -> Vec<(u64, u32, Vec<u8>)> {
    let one = [
        (0x0CFF_4027, "5555555555551299"),
        (0x0CFF_4127, "00000000780201A6"),
        (0x18FE_1025, "2800280028002900"),
        (0x18FE_1026, "2A002B00"),
        (0x18FE_2020, "F505F5050C030C03"),
        (0x18FE_202A, "2C0F2C0F"),
        (0x18FE_202B, "28000000FAFF0A00"),
        (0x18FE_1012, "00000000640038FF"),
        (0x0CFF_5229, "FE0310C0FF020080"),
    ];
    let bytes = |hex: &str| -> Vec<u8> {
        (0..hex.len()).step_by(2).map(|i| u8::from_str_radix(&hex[i..i + 2], 16).unwrap()).collect()
    };
    (0..100).flat_map(|tick| one.map(|(id, hex)| (10_000 + tick * 10, id, bytes(hex)))).collect()
}

fn candump() -> FieldLog {
    let line = |(ms, id, data): &(u64, u32, Vec<u8>)| {
        let hex: String = data.iter().map(|byte| format!("{byte:02X}")).collect();
        format!("({}.{:03}000) can0 {id:08X}#{hex}\n", ms / 1000, ms % 1000)
    };
    let text: String = frames().iter().map(line).collect();
    FieldLog::read(text.as_bytes(), "a", decoder(), false).unwrap()
}

/// How a test writes frames.
#[derive(Clone, Copy)]
struct Style {
    ros1: bool,
    big: bool,
    stamped: bool,
    frame_id: &'static str,
    compression: Option<Compression>,
}

const ROS2: Style =
    Style { ros1: false, big: false, stamped: true, frame_id: "can0", compression: None };

fn message(style: Style, ms: u64, id: u32, data: &[u8]) -> Vec<u8> {
    let mut out = if style.ros1 { vec![7, 0, 0, 0] } else { vec![0, u8::from(!style.big), 0, 0] };
    let start = if style.ros1 { 0 } else { 4 };
    let word = |out: &mut Vec<u8>, value: u32| {
        while !style.ros1 && !(out.len() - start).is_multiple_of(4) {
            out.push(0);
        }
        out.extend(if style.big { value.to_be_bytes() } else { value.to_le_bytes() });
    };
    let stamp = if style.stamped { ms } else { 0 };
    word(&mut out, u32::try_from(stamp / 1000).unwrap());
    word(&mut out, u32::try_from(stamp % 1000 * 1_000_000).unwrap());
    let nul = usize::from(!style.ros1);
    word(&mut out, u32::try_from(style.frame_id.len() + nul).unwrap());
    out.extend(style.frame_id.as_bytes());
    out.extend(&[0][..nul]);
    word(&mut out, id);
    out.extend([0, 1, 0, u8::try_from(data.len()).unwrap()]);
    out.extend(data);
    out.resize(out.len() + 8 - data.len(), 0);
    out
}

fn recording(style: Style, broken: Option<&[u8]>) -> Vec<u8> {
    let options = WriteOptions::new().compression(style.compression).chunk_size(Some(4000));
    let mut writer = options.create(Cursor::new(Vec::new())).unwrap();
    let (name, encoding) =
        if style.ros1 { ("can_msgs/Frame", "ros1") } else { ("can_msgs/msg/Frame", "cdr") };
    let schema = writer.add_schema(name, "ros2msg", b"").unwrap();
    let none = BTreeMap::new();
    let channel_id = writer.add_channel(schema, "/from_can_bus", encoding, &none).unwrap();
    let other = writer.add_schema("sensor_msgs/msg/Imu", "ros2msg", b"").unwrap();
    let imu = writer.add_channel(other, "/imu", "cdr", &none).unwrap();
    let mut say = |channel_id: u16, ms: u64, data: &[u8]| {
        let at_ns = ms * 1_000_000;
        let header =
            MessageHeader { channel_id, sequence: 0, log_time: at_ns, publish_time: at_ns };
        writer.write_to_known_channel(&header, data).unwrap();
    };
    for (ms, id, data) in frames() {
        say(channel_id, ms, &message(style, ms, id, &data));
    }
    say(imu, 11_000, b"not for us");
    if let Some(broken) = broken {
        say(channel_id, 11_000, broken);
    }
    writer.finish().unwrap();
    writer.into_inner().into_inner()
}

fn read(bytes: &[u8], accept_cut: bool) -> Result<FieldLog, GapError> {
    FieldLog::read_mcap(bytes, "a.mcap", decoder(), accept_cut)
}

#[test]
fn a_recording_is_the_same_log_as_candump() {
    let wanted = candump();
    for style in [
        ROS2,
        Style { big: true, ..ROS2 },
        Style { stamped: false, ..ROS2 },
        Style { frame_id: "", ..ROS2 },
        Style { frame_id: "front can", compression: Some(Compression::Zstd), ..ROS2 },
        Style { compression: Some(Compression::Lz4), ..ROS2 },
        Style { ros1: true, frame_id: "can", ..ROS2 },
    ] {
        let log = read(&recording(style, None), false).unwrap();
        assert_eq!(log.all_series(), wanted.all_series());
        assert_eq!((log.frames(), log.duration_s()), (wanted.frames(), wanted.duration_s()));
        assert_eq!(log.faults(), []);
    }
}

#[test]
fn a_recording_is_known_by_its_content() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drive.log");
    std::fs::write(&path, recording(ROS2, None)).unwrap();
    let log = FieldLog::load(&path, decoder(), false).unwrap();
    assert_eq!(log.all_series(), candump().all_series());
}

#[test]
fn a_recording_may_be_packed_and_cut_within() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drive.mcap.gz");
    let mut gzip = GzEncoder::new(Vec::new(), flate2::Compression::none());
    gzip.write_all(&recording(ROS2, None)).unwrap();
    let bytes = gzip.finish().unwrap();
    std::fs::write(&path, &bytes).unwrap();
    let log = FieldLog::load(&path, decoder(), false).unwrap();
    assert_eq!(log.all_series(), candump().all_series());
    std::fs::write(&path, &bytes[..bytes.len() * 2 / 3]).unwrap();
    let error = FieldLog::load(&path, decoder(), false).unwrap_err().to_string();
    assert!(error.contains("say --accept-cut"), "{error}");
    let log = FieldLog::load(&path, decoder(), true).unwrap();
    assert!(matches!(log.faults().last().unwrap().kind, FaultKind::Cut), "{:?}", log.faults());
}

#[test]
fn error_and_remote_frames_are_counted() {
    for (flag, wanted) in [
        (2, FaultKind::PassedOver { remote: 0, error: 1, fd: 0 }),
        (0, FaultKind::PassedOver { remote: 1, error: 0, fd: 0 }),
    ] {
        let mut other = message(ROS2, 11_000, 4, &[0; 8]);
        let flags = other.len() - 12;
        other[flags + flag] = 1;
        let log = read(&recording(ROS2, Some(&other)), false).unwrap();
        let [fault] = log.faults() else { panic!("{:?}", log.faults()) };
        assert_eq!((fault.line, &fault.kind), (902, &wanted));
    }
}

#[test]
fn a_recording_that_was_cut_is_refused_unless_accepted() {
    let whole = recording(ROS2, None);
    let cut = &whole[..whole.len() / 2];
    let error = read(cut, false).unwrap_err().to_string();
    assert!(error.contains("a.mcap: at message") && error.contains("--accept-cut"), "{error}");
    let log = read(cut, true).unwrap();
    assert!(log.frames() > 100 && log.frames() < 900, "{}", log.frames());
    assert!(matches!(log.faults().last().unwrap().kind, FaultKind::Cut));
}

#[test]
fn a_message_that_is_no_frame_is_left_out_and_said() {
    for (broken, words) in [
        (&[0, 1, 0, 0, 9][..], "too short"),
        (&[0, 9, 0, 0, 9][..], "CDR representation 0009"),
        (&message(ROS2, 1, 0xFFFF_FFFF, &[])[..], "identifier FFFFFFFF is too large"),
    ] {
        let log = read(&recording(ROS2, Some(broken)), false).unwrap();
        assert_eq!(log.frames(), 900);
        let fault = log.faults()[0].to_string();
        assert!(
            fault.starts_with("a.mcap:902: no CAN frame: ") && fault.contains(words),
            "{fault}"
        );
    }
}

#[test]
fn a_recording_without_can_says_what_it_has() {
    let mut writer = mcap::Writer::new(Cursor::new(Vec::new())).unwrap();
    let schema = writer.add_schema("sensor_msgs/msg/Imu", "ros2msg", b"").unwrap();
    let channel_id = writer.add_channel(schema, "/imu", "cdr", &BTreeMap::new()).unwrap();
    let header = MessageHeader { channel_id, sequence: 0, log_time: 1, publish_time: 1 };
    writer.write_to_known_channel(&header, b"x").unwrap();
    writer.finish().unwrap();
    let error = read(&writer.into_inner().into_inner(), false).unwrap_err().to_string();
    assert!(error.contains("it has /imu (sensor_msgs/msg/Imu, cdr)"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_damage_is_read_or_refused_in_one_line(
        compressed: bool,
        cut in 0.0..1.0_f64,
        hits in prop::collection::vec((0.0..1.0_f64, any::<u8>()), 0..6),
        accept_cut: bool,
    ) {
        let compression = compressed.then_some(Compression::Zstd);
        let mut bytes = recording(Style { compression, ..ROS2 }, None);
        let at = |share: f64, len: usize| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
            { (share * len as f64) as usize }
        };
        let len = bytes.len();
        for (share, byte) in &hits {
            bytes[at(*share, len)] ^= *byte;
        }
        if cut > 0.3 {
            bytes.truncate(at(cut, len));
        }
        match read(&bytes, accept_cut) {
            Ok(log) => prop_assert!(log.frames() <= 900),
            Err(error) => prop_assert_eq!(error.to_string().lines().count(), 1),
        }
    }

    #[test]
    fn any_bytes_after_the_magic_are_refused(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let bytes = [b"\x89MCAP0\r\n".as_slice(), &bytes].concat();
        prop_assert!(read(&bytes, true).is_err());
    }
}
