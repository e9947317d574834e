//! Logs there and back, cut anywhere, and made of anything.

use core::time::Duration;

use proptest::prelude::*;
use xt28_bus::candump::{Precision, ReadError, Reader, Writer};
use xt28_dbc::{CanId, Frame};
use xt28_machine::SimTime;

fn any_frame() -> impl Strategy<Value = Frame> {
    let id = prop_oneof![
        (0..=0x7FF_u16).prop_map(CanId::Standard),
        (0..=0x1FFF_FFFF_u32).prop_map(CanId::Extended),
    ];
    let data = proptest::collection::vec(any::<u8>(), 0..=8);
    (id, data).prop_map(|(id, data)| Frame::new(id, &data).unwrap())
}

/// Times up to the year 2100.
fn any_entries() -> impl Strategy<Value = Vec<(SimTime, Frame)>> {
    let at = (0..4_102_444_800_000_000_000_u64).prop_map(SimTime::from_nanos);
    proptest::collection::vec((at, any_frame()), 0..20)
}

fn log(entries: &[(SimTime, Frame)], precision: Precision) -> Vec<u8> {
    let mut writer = Writer::new(Vec::new(), "can0").with_precision(precision);
    entries.iter().for_each(|(at, frame)| writer.write(*at, frame).unwrap());
    writer.into_inner()
}

proptest! {
    #[test]
    fn what_is_written_is_read(entries in any_entries()) {
        let log = log(&entries, Precision::Nanos);
        let read: Vec<_> = Reader::new(&log[..], "a.log").map(Result::unwrap).collect();
        prop_assert!(read.iter().all(|record| &*record.interface == "can0"));
        let read: Vec<_> = read.iter().map(|record| (record.at, record.frame)).collect();
        prop_assert_eq!(read, entries);
    }

    #[test]
    fn six_digits_keep_whole_microseconds_and_order(entries in any_entries()) {
        let log = log(&entries, Precision::Micros);
        let read = Reader::new(&log[..], "a.log").map(|record| record.unwrap().at.as_nanos());
        let cut = entries.iter().map(|(at, _)| at.as_nanos() / 1_000 * 1_000);
        prop_assert!(read.eq(cut));
    }

    #[test]
    fn the_start_is_added_exactly(
        at_ns in 0..1_000_000_000_000_u64,
        start_us in 0..4_000_000_000_000_000_u64,
        frame in any_frame(),
    ) {
        let start = Duration::from_micros(start_us);
        let mut writer =
            Writer::new(Vec::new(), "can0").starting_at(start).with_precision(Precision::Nanos);
        writer.write(SimTime::from_nanos(at_ns), &frame).unwrap();
        let log = writer.into_inner();
        let record = Reader::new(&log[..], "a.log").next().unwrap().unwrap();
        prop_assert_eq!(record.at.as_nanos(), at_ns + start_us * 1_000);
    }

    #[test]
    fn a_log_cut_anywhere_gives_the_lines_before_and_one_error(
        entries in any_entries(),
        cut in any::<prop::sample::Index>(),
    ) {
        let log = log(&entries, Precision::Micros);
        let cut = cut.index(log.len() + 1);
        let log = &log[..cut];
        let whole = log.iter().filter(|&&byte| byte == b'\n').count();
        let at_a_line_end = log.last().is_none_or(|&last| last == b'\n');

        let mut strict: Vec<_> = Reader::new(log, "a.log").collect();
        if !at_a_line_end {
            let error = strict.pop().unwrap().unwrap_err();
            let is_cut = matches!(error, ReadError::Cut { line, .. } if line == whole as u64 + 1);
            prop_assert!(is_cut, "{}", error);
        }
        prop_assert_eq!(strict.iter().filter(|record| record.is_ok()).count(), whole);
        prop_assert_eq!(strict.len(), whole);

        let mut lenient = Reader::new(log, "a.log").accepting_cut();
        prop_assert_eq!(lenient.by_ref().filter(Result::is_ok).count(), whole);
        prop_assert_eq!(lenient.cut_line(), (!at_a_line_end).then_some(whole as u64 + 1));
    }

    #[test]
    fn arbitrary_bytes_are_read_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..600)) {
        let results: Vec<_> = Reader::new(&bytes[..], "a.log").accepting_cut().collect();
        // An error is the last thing said, and it is said in one line.
        prop_assert!(results.iter().rev().skip(1).all(Result::is_ok));
        for error in results.into_iter().filter_map(Result::err) {
            prop_assert!(!error.to_string().contains('\n'));
        }
    }

    /// Nearly right lines get further into the parser than noise does.
    #[test]
    fn nearly_right_lines_are_read_or_refused(
        line in "\\(?[0-9]{0,21}\\.?[0-9]{0,11}\\)? ?(can0)? ?[0-9a-fA-FR]{0,9}#{0,2}[0-9a-fA-FR_]{0,20}( [RTX])?"
    ) {
        let line = format!("{line}\n");
        Reader::new(line.as_bytes(), "a.log").for_each(drop);
    }
}
