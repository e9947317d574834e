//! Logs as loggers really write them: of several sources, out of order by a little.

mod field;

use field::{frames, line, log, read};
use proptest::prelude::*;
use xt28_gap::FaultKind;

/// Lines in order of how late each was written: frame `i` by `late_us[i]`.
fn written_late(late_us: &[u32]) -> String {
    let mut lines: Vec<(u32, String)> = frames()
        .into_iter()
        .zip(late_us.iter().cycle())
        .enumerate()
        .map(|(i, ((us, frame), late_us))| (us + late_us, line(us, ["can0", "can1"][i % 2], frame)))
        .collect();
    lines.sort_by_key(|(written_us, _)| *written_us);
    lines.into_iter().map(|(_, line)| line).collect()
}

#[test]
fn two_interfaces_a_few_microseconds_apart_lose_no_frame() {
    let log_of_two = read(&written_late(&[0, 300, 7])).unwrap();
    assert_eq!(log_of_two.faults(), []);
    assert_eq!(log_of_two.all_series(), read(&log()).unwrap().all_series());
}

#[test]
fn a_source_that_is_far_behind_is_put_in_order_and_said() {
    let late = read(&written_late(&[0, 0, 0, 40_000])).unwrap();
    assert_eq!(late.all_series(), read(&log()).unwrap().all_series());
    let [fault] = late.faults() else { panic!("{:?}", late.faults()) };
    assert!(matches!(fault.kind, FaultKind::OutOfOrder { by_s, .. } if by_s > 0.03), "{fault}");
    assert!(fault.to_string().contains("are put in order"), "{fault}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, ..ProptestConfig::default() })]

    #[test]
    fn however_sources_within_the_window_are_merged_the_log_is_the_same(
        late_us in prop::collection::vec(0_u32..=100_000, 1..40),
    ) {
        let (merged, wanted) = (read(&written_late(&late_us)).unwrap(), read(&log()).unwrap());
        prop_assert_eq!(merged.all_series(), wanted.all_series());
        prop_assert_eq!(merged.duration_s(), wanted.duration_s());
        let sound = |kind: &FaultKind| matches!(kind, FaultKind::OutOfOrder { .. });
        prop_assert!(merged.faults().iter().all(|fault| sound(&fault.kind)));
    }
}
