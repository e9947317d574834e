//! Time, counters and limits at their edges, and what a stop or a change of mode must not carry over.

mod bench;

use bench::{Bench, LIMITS, TICK_NS, coast, strokes};
use xt28_safety::{Arms, Command, Limits, Link, Order, Phase, Reason, Verdict};

#[test]
fn time_that_runs_backwards_blocks() {
    let mut bench = Bench::armed();
    bench.now_ns -= 2 * TICK_NS;
    assert_eq!(bench.run(Order::None, coast()), Verdict::Block(Reason::ClockBackwards));
}

#[test]
fn limits_that_cannot_be_held_to_neither_arm_nor_stay_armed() {
    let unsound = [
        Limits { throttle_max: f64::NAN, ..LIMITS },
        Limits { roll_max_rad: f64::INFINITY, ..LIMITS },
        Limits { stroke_error_m: -0.1, ..LIMITS },
        Limits { counter_lag_max: LIMITS.counter_modulus - 1, ..LIMITS },
    ];
    for limits in unsound {
        let mut bench = Bench { limits, ..Bench::new() };
        assert_eq!(bench.run(Order::Arm, coast()), Verdict::Block(Reason::LimitsUnsound));
        assert_eq!(bench.state.phase(), Phase::Disarmed);
        let mut bench = Bench { limits, ..Bench::armed() };
        assert_eq!(bench.run(Order::None, coast()), Verdict::Block(Reason::LimitsUnsound));
    }
}

#[test]
fn a_late_step_is_no_leap() {
    let mut bench = Bench::armed();
    bench.now_ns += 8 * TICK_NS;
    let full = Command { throttle: 1.0, ..coast() };
    let throttle = bench.run(Order::None, full).command().unwrap().throttle;
    assert!((throttle - 0.03).abs() < 1e-9, "{throttle}");
}

#[test]
fn a_target_after_another_mode_starts_where_the_arm_is() {
    for before in [Arms::Off, Arms::Automatic, Arms::Valve([0.1; 6])] {
        let mut bench = Bench::armed();
        (0..5).for_each(|_| _ = bench.run(Order::None, Command { arms: before, ..coast() }));
        let held = bench.run(Order::None, strokes(0.25)).command().unwrap();
        let Arms::Position([Some(stroke_m), ..]) = held.arms else { panic!("{held:?}") };
        assert!((stroke_m - 0.172).abs() < 1e-9, "{before:?}: {stroke_m}");
    }
}

#[test]
fn a_brake_asked_for_before_a_stop_waits_anew_after_it() {
    let brake = Command { brake: true, ..coast() };
    let mut bench = Bench::armed();
    bench.measured.speed_m_s = 1.5;
    bench.run(Order::None, brake);
    bench.run(Order::Disarm, brake);
    (0..200).for_each(|_| _ = bench.run(Order::None, brake));
    bench.run(Order::Arm, brake);
    let first = (0..20).find_map(|_| bench.run(Order::None, brake).command());
    assert_eq!(first, Some(coast()), "it does not close at speed");
}

#[test]
fn a_counter_beyond_its_range_is_in_step_with_none() {
    let link = |sent, accepted| Link { sent: Some(sent), accepted, ..Link::default() };
    assert!(link(1, 15).in_step(3, 16) && link(3, 0).in_step(3, 16));
    assert!(!link(4, 0).in_step(3, 16) && !link(0, 1).in_step(3, 16));
    assert!(!link(3, 19).in_step(3, 16) && !link(19, 3).in_step(3, 16));
    assert!(!link(0, 0).in_step(3, 0) && !Link::default().in_step(3, 16));
}
