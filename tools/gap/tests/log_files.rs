//! Files that hold a log in other ways than plain text: packed, with something before or behind it, or
//! of another form altogether.

mod field;

use std::io::Write as _;

use field::{decoder, line, log, read};
use flate2::Compression;
use flate2::write::GzEncoder;
use xt28_gap::{FaultKind, FieldLog, GapError};

fn zipped(bytes: &[u8]) -> Vec<u8> {
    let mut gzip = GzEncoder::new(Vec::new(), Compression::fast());
    gzip.write_all(bytes).unwrap();
    gzip.finish().unwrap()
}

fn load(bytes: &[u8], accept_cut: bool) -> Result<FieldLog, GapError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.log");
    std::fs::write(&path, bytes).unwrap();
    FieldLog::load(&path, &decoder(), accept_cut)
}

#[test]
fn what_stands_behind_a_gzip_stream_is_left_out_and_said() {
    let whole = read(&log()).unwrap();
    for behind in [b"garbage".as_slice(), &[0; 512]] {
        let log = load(&[&zipped(log().as_bytes()), behind].concat(), false).unwrap();
        assert_eq!(log.all_series(), whole.all_series());
        let [fault] = log.faults() else { panic!("{:?}", log.faults()) };
        assert_eq!((fault.line, &fault.kind), (900, &FaultKind::Trailing));
    }
}

#[test]
fn gzip_streams_one_after_the_other_are_one_log() {
    let text = log();
    let (a, b) = text.split_at(text.len() / 3);
    let log = load(&[zipped(a.as_bytes()), zipped(b.as_bytes())].concat(), false).unwrap();
    assert_eq!(log.all_series(), read(&text).unwrap().all_series());
    assert_eq!(log.faults(), []);
    // Of a second stream that is not whole nobody knows what it held.
    let broken = load(&[&zipped(text.as_bytes()), [0x1F, 0x8B, 0xFF].as_slice()].concat(), false);
    assert!(broken.is_err());
}

#[test]
fn a_log_that_is_cut_says_how_to_take_what_is_there() {
    let text = log();
    let packed = zipped(text.as_bytes());
    for (cut, wanted) in
        [(&text.as_bytes()[..text.len() - 5], "a.log:900: "), (&packed[..9], "a.log:1: ")]
    {
        let error = load(cut, false).unwrap_err();
        assert!(matches!(error, GapError::Cut { .. }), "{error}");
        let error = error.to_string();
        assert!(error.contains(wanted) && error.contains("--accept-cut"), "{error}");
    }
    let error = load(&packed[..9], true).unwrap_err().to_string();
    assert!(
        error.contains("is empty: no classic CAN data frame in it; ") && error.contains("cut"),
        "{error}"
    );
}

#[test]
fn a_log_of_another_logger_is_refused_with_the_way_to_turn_it_into_one() {
    for head in
        ["LOGG", "MDF     4.10", "date Mon", ";$FILEVERSION=1.1", "timestamp,arbitration_id"]
    {
        let form = format!("{head}\n{}", log());
        for bytes in [form.clone().into_bytes(), zipped(form.as_bytes())] {
            let error = load(&bytes, true).unwrap_err().to_string();
            assert!(
                error.contains("a.log: a") && error.contains("python -m can.logconvert "),
                "{error}"
            );
            assert!(error.contains("a.log run.log` (of python-can"), "{error}");
        }
    }
}

#[test]
fn a_mark_before_the_first_line_is_no_part_of_the_log() {
    let marked = read(&format!("\u{FEFF}{}", log())).unwrap();
    assert_eq!(marked.all_series(), read(&log()).unwrap().all_series());
}

#[test]
fn what_candump_shows_on_a_screen_is_refused_with_the_way_to_record() {
    for shown in ["  can0  123   [2]  AB CD\n", " (10.000000)  can0  0CFF4027   [2]  55 AB\n"] {
        let error = read(&(line(0, "can0", "123#AB") + shown)).unwrap_err().to_string();
        assert!(error.starts_with("a.log:2: candump as on a screen"), "{error}");
        assert!(error.ends_with("record with `candump -L`"), "{error}");
    }
}
