//! No target starts from a reading that an ECU may yet call broken.

mod bench;

use bench::{Bench, LIMITS, TICK_NS, coast, strokes};
use proptest::prelude::*;
use xt28_safety::{Arms, Command, Order, Reason, Verdict};

/// Ticks that a reading has to be steady for.
const STEADY_TICKS: u64 = LIMITS.steady_ns / TICK_NS;

/// Targets of a command that is let through.
fn targets(verdict: Verdict) -> [Option<f64>; 6] {
    match verdict.command().map(|command| command.arms) {
        Some(Arms::Position(targets)) => targets,
        other => panic!("{other:?}"),
    }
}

#[test]
fn an_arm_whose_reading_leapt_is_held_until_it_is_known_where_it_is() {
    for broken_m in [0.0, 0.29, 0.525] {
        let mut bench = Bench::armed();
        bench.measured.stroke_m[0] = broken_m;
        for _ in 0..6 {
            assert_eq!(targets(bench.run(Order::None, coast())), [None; 6]);
        }
        // Another demand while the wire is broken, which it is for 90 ms.
        for _ in 0..3 {
            let [first, rest @ ..] = targets(bench.run(Order::None, strokes(0.17)));
            assert_eq!((first, rest), (None, [Some(0.17); 5]), "{broken_m}");
        }
        bench.measured.stroke_m[0] = 0.17;
        for _ in 0..STEADY_TICKS {
            assert_eq!(targets(bench.run(Order::None, strokes(0.17)))[0], None, "{broken_m}");
        }
        assert_eq!(targets(bench.run(Order::None, strokes(0.17)))[0], Some(0.17));
    }
}

#[test]
fn a_target_that_is_under_way_goes_on_through_a_broken_wire() {
    let mut bench = Bench::armed();
    bench.run(Order::None, strokes(0.17));
    bench.measured.stroke_m[0] = 0.0;
    assert_eq!(targets(bench.run(Order::None, strokes(0.17)))[0], Some(0.17));
}

#[test]
fn arming_waits_for_readings_that_are_steady() {
    let mut bench = Bench::new();
    bench.measured.front_angle_rad = -0.43;
    bench.run(Order::Arm, coast());
    for _ in 0..7 {
        assert_eq!(bench.run(Order::None, coast()), Verdict::Block(Reason::Handshake));
    }
    bench.measured.front_angle_rad = 0.0;
    let healed_ns = bench.now_ns;
    let first = (0..100).find_map(|_| bench.run(Order::None, coast()).command()).unwrap();
    assert_eq!(
        (bench.now_ns - TICK_NS - healed_ns, first.front_angle_rad),
        (LIMITS.steady_ns, 0.0)
    );
}

#[test]
fn the_first_readings_are_waited_on_too() {
    let mut bench = Bench::at_power_up();
    let begun_ns = bench.now_ns;
    bench.run(Order::Arm, coast());
    assert!((0..100).any(|_| bench.run(Order::None, coast()).command().is_some()));
    assert_eq!(bench.now_ns - TICK_NS - begun_ns, LIMITS.steady_ns);
}

#[test]
fn a_reading_that_leaps_about_is_why_it_does_not_arm() {
    let mut bench = Bench::new();
    bench.run(Order::Arm, coast());
    let ended = (0..1000).find_map(|tick| {
        bench.measured.stroke_m[4] = if tick / 10 % 2 == 0 { 0.25 } else { 0.17 };
        let verdict = bench.run(Order::None, coast());
        (verdict != Verdict::Block(Reason::Handshake)).then_some(verdict)
    });
    assert_eq!(ended, Some(Verdict::Block(Reason::MeasurementLeaps)));
}

proptest! {
    /// Whatever breaks and heals when, and whatever is asked: a target begins where the arm is read, within a step, and
    /// has been read for long enough.
    #[test]
    fn a_target_begins_where_the_arm_has_been_for_a_while(
        spans in proptest::collection::vec((0.0..0.5_f64, 1..40_u64, any::<bool>()), 1..20),
    ) {
        let mut bench = Bench::armed();
        let (mut before, mut read_for) = (None, STEADY_TICKS);
        for (reading_m, ticks, asks) in spans {
            let leaps = (reading_m - bench.measured.stroke_m[0]).abs() > 0.03;
            read_for = if leaps { 0 } else { read_for };
            bench.measured.stroke_m[0] = reading_m;
            for _ in 0..ticks {
                let request: Command = if asks { strokes(0.1) } else { coast() };
                let target = targets(bench.run(Order::None, request))[0];
                if let (None, Some(begun_m)) = (before, target) {
                    prop_assert!(read_for >= STEADY_TICKS, "after {read_for} ticks");
                    let step_m = LIMITS.stroke_rate_m_s * 1e-9 * TICK_NS as f64;
                    let off_m: f64 = begun_m - reading_m.min(LIMITS.stroke_max_m);
                    prop_assert!(off_m.abs() <= step_m + 1e-12);
                }
                (before, read_for) = (target, read_for + 1);
            }
        }
    }
}
