//! Arming, blocking and stopping, one rule a test.

mod bench;

use bench::{Bench, LIMITS, TICK_NS, coast, strokes};
use xt28_safety::{Arms, Clamps, Command, Order, Phase, Reason, Stream, Verdict};

#[test]
fn nothing_leaves_before_the_handshake_is_through() {
    let mut bench = Bench::new();
    assert_eq!(bench.run(Order::None, coast()), Verdict::Block(Reason::Disarmed));
    for _ in 1..LIMITS.handshake_steps {
        assert_eq!(bench.run(Order::Arm, coast()), Verdict::Block(Reason::Handshake));
    }
    assert!(bench.run(Order::None, coast()).command().is_some());
}

#[test]
fn an_ecu_that_accepts_nothing_is_never_armed() {
    let mut bench = Bench::new();
    bench.run(Order::Arm, coast());
    let mut last = None;
    for _ in 0..600 {
        let mut input = bench.input(Order::None, coast());
        input.drive.accepted = 3;
        last = Some(bench.feed(&input));
    }
    assert_eq!(last, Some(Verdict::Block(Reason::HandshakeTimeout)));
}

#[test]
fn an_arm_order_with_a_dead_stream_stays_silent_and_says_why() {
    let mut bench = Bench::new();
    let mut input = bench.input(Order::Arm, coast());
    input.arm.heard_at_ns = None;
    assert_eq!(bench.feed(&input), Verdict::Block(Reason::Stale(Stream::ArmStatus)));
    assert_eq!(bench.state.phase(), Phase::Disarmed);
}

#[test]
fn an_ecu_that_never_gets_ready_is_named() {
    let mut bench = Bench::new();
    bench.run(Order::Arm, coast());
    let mut last = None;
    for _ in 0..600 {
        let mut input = bench.input(Order::None, coast());
        input.drive.ready = false;
        last = Some(bench.feed(&input));
    }
    assert_eq!(last, Some(Verdict::Block(Reason::DriveEcuNotReady)));
}

#[test]
fn an_order_to_arm_after_a_stop_learns_what_stands_against_it() {
    let mut bench = Bench::armed();
    let mut input = bench.input(Order::None, coast());
    input.measured.roll_rad = 0.5;
    assert_eq!(bench.feed(&input), Verdict::Block(Reason::Roll));
    let mut input = bench.input(Order::Arm, coast());
    input.stamps.observation_ns = None;
    assert_eq!(bench.feed(&input), Verdict::Block(Reason::Stale(Stream::Observation)));
    assert_eq!(bench.state.phase(), Phase::Blocked(Reason::Roll));
}

#[test]
fn deadlines_hold_to_the_nanosecond() {
    for (late_ns, blocked) in [(0, false), (1, true)] {
        let mut bench = Bench::armed();
        let mut input = bench.input(Order::None, coast());
        input.drive.heard_at_ns = Some(bench.now_ns - LIMITS.status.span_ns() - late_ns);
        let verdict = bench.feed(&input);
        assert_eq!(verdict == Verdict::Block(Reason::Stale(Stream::DriveStatus)), blocked);
    }
}

#[test]
fn a_stamp_from_the_future_is_not_fresh() {
    let mut bench = Bench::armed();
    let mut input = bench.input(Order::None, coast());
    input.stamps.sensors_ns = Some(bench.now_ns + 1);
    assert_eq!(bench.feed(&input), Verdict::Block(Reason::Stale(Stream::Sensors)));
}

#[test]
fn each_hazard_blocks_and_stays_blocked_until_re_armed() {
    type Spoil = fn(&mut xt28_safety::Input);
    let hazards: [(Spoil, Reason); 10] = [
        (|i| i.bus_ok = false, Reason::BusFault),
        (|i| i.alone = false, Reason::NotAlone),
        (|i| i.stamps.observation_ns = None, Reason::Stale(Stream::Observation)),
        (|i| i.stamps.policy_ns = None, Reason::Stale(Stream::Policy)),
        (|i| i.measured.stroke_m[3] = f64::NAN, Reason::MeasurementNotFinite),
        (|i| i.measured.roll_rad = -19_f64.to_radians(), Reason::Roll),
        (|i| i.measured.pitch_rad = 26_f64.to_radians(), Reason::Pitch),
        (|i| i.arm.ready = false, Reason::ArmEcuNotReady),
        (|i| i.drive.ready = false, Reason::DriveEcuNotReady),
        (|i| i.request.as_mut().unwrap().throttle = f64::NAN, Reason::RequestNotFinite),
    ];
    for (spoil, reason) in hazards {
        let mut bench = Bench::armed();
        let mut input = bench.input(Order::None, coast());
        spoil(&mut input);
        assert_eq!(bench.feed(&input), Verdict::Block(reason));
        assert_eq!(bench.run(Order::None, coast()), Verdict::Block(reason), "must latch");
        assert_eq!(bench.run(Order::Arm, coast()), Verdict::Block(Reason::Handshake));
    }
}

#[test]
fn an_ecu_that_stops_accepting_blocks_within_its_deadline() {
    let mut bench = Bench::armed();
    let start_ns = bench.now_ns;
    loop {
        let mut input = bench.input(Order::None, coast());
        input.arm.accepted = 0;
        input.arm.sent = Some(7);
        if bench.feed(&input) == Verdict::Block(Reason::NotAcknowledged) {
            break;
        }
        assert!(bench.now_ns - start_ns <= LIMITS.acknowledgement.span_ns() + 2 * TICK_NS);
    }
}

#[test]
fn an_emergency_stop_outlasts_orders_to_arm() {
    let mut bench = Bench::armed();
    let stopped = Verdict::Block(Reason::EmergencyStop);
    assert_eq!(bench.run(Order::EmergencyStop, coast()), stopped);
    assert_eq!(bench.run(Order::Arm, coast()), stopped);
    assert_eq!(bench.run(Order::Disarm, coast()), stopped);
    assert_eq!(bench.run(Order::Release, coast()), Verdict::Block(Reason::Disarmed));
    assert_eq!(bench.run(Order::Arm, coast()), Verdict::Block(Reason::Handshake));
}

#[test]
fn a_step_in_the_policy_is_a_ramp_at_the_arm() {
    let mut bench = Bench::armed();
    let mut before = 0.17;
    for tick in 0..20 {
        let Some(Command { arms: Arms::Position(s), .. }) =
            bench.run(Order::None, strokes(0.25)).command()
        else {
            panic!("blocked at tick {tick}")
        };
        let now = s[0].unwrap();
        assert!(now >= before && now - before <= LIMITS.stroke_rate_m_s * 0.010 + 1e-12);
        before = now;
    }
    assert!((before - 0.21).abs() < 1e-9, "{before}");
}

#[test]
fn a_target_leads_the_arm_by_no_more_than_its_error_limit() {
    let mut bench = Bench::armed();
    bench.measured.stroke_m = [0.02; 6];
    for _ in 0..200 {
        bench.run(Order::None, strokes(0.25));
    }
    let Some(Command { arms: Arms::Position(s), .. }) =
        bench.run(Order::None, strokes(0.25)).command()
    else {
        panic!("blocked")
    };
    assert!((s[5].unwrap() - 0.12).abs() < 1e-9, "{s:?}");
}

#[test]
fn throttle_grows_slowly_and_falls_at_once() {
    let mut bench = Bench::armed();
    let full = Command { throttle: 1.0, ..coast() };
    let first = bench.run(Order::None, full).command().unwrap().throttle;
    assert!((first - 0.01).abs() < 1e-9, "{first}");
    for _ in 0..200 {
        bench.run(Order::None, full);
    }
    assert_eq!(bench.run(Order::None, full), Verdict::Allow(full));
    let back = Command { throttle: -1.0, ..coast() };
    let reverse = bench.run(Order::None, back).command().unwrap().throttle;
    assert!((reverse + 0.01).abs() < 1e-9, "{reverse}");
    assert_eq!(bench.run(Order::None, coast()), Verdict::Allow(coast()));
}

#[test]
fn the_brake_takes_the_throttle_away() {
    let mut bench = Bench::armed();
    let both = Command { throttle: 0.5, brake: true, ..coast() };
    let held = bench.run(Order::None, both).command().unwrap();
    assert!(held.throttle == 0.0 && held.brake);
}

#[test]
fn the_brake_waits_for_a_machine_that_moves_but_not_for_ever() {
    let brake = Command { brake: true, ..coast() };
    let mut bench = Bench::armed();
    for speed_m_s in [1.5, -1.5] {
        bench.measured.speed_m_s = speed_m_s;
        let waits = Clamps { brake: true, ..Clamps::default() };
        assert_eq!(bench.run(Order::None, brake), Verdict::Clamp(coast(), waits));
    }
    bench.measured.speed_m_s = 0.05;
    assert_eq!(bench.run(Order::None, brake), Verdict::Allow(brake));
    bench.measured.speed_m_s = 0.5;
    assert_eq!(bench.run(Order::None, brake), Verdict::Allow(brake), "what is closed stays closed");
    assert_eq!(bench.run(Order::None, coast()), Verdict::Allow(coast()));
    let ticks = (0..200).take_while(|_| bench.run(Order::None, brake) != Verdict::Allow(brake));
    assert_eq!(ticks.count() as u64 * TICK_NS, LIMITS.brake_wait_ns);
}

#[test]
fn what_cannot_be_measured_forbids_arming_and_stops_where_it_lasts() {
    type Spoil = fn(&mut Bench);
    for spoil in
        [(|b| b.measured.stroke_m[3] = 0.7) as Spoil, |b| b.measured.front_angle_rad = -0.9]
    {
        let mut bench = Bench::new();
        spoil(&mut bench);
        let refused = Verdict::Block(Reason::MeasurementImplausible);
        assert_eq!(bench.run(Order::Arm, coast()), refused);
        let mut bench = Bench::armed();
        let sound = bench.measured;
        spoil(&mut bench);
        let lasts = |bench: &mut Bench| {
            (0..100)
                .take_while(|_| bench.run(Order::None, coast()) == Verdict::Allow(coast()))
                .count()
        };
        let span = usize::try_from(LIMITS.steady_ns / TICK_NS).unwrap();
        assert_eq!(lasts(&mut bench), span);
        assert_eq!(bench.run(Order::None, coast()), refused);
        // A glitch is ridden through.
        let mut bench = Bench::armed();
        spoil(&mut bench);
        bench.run(Order::None, coast());
        bench.measured = sound;
        assert_eq!(lasts(&mut bench), 100);
    }
}

#[test]
fn arming_opens_no_brake_that_is_to_stay_closed() {
    for is_braked in [true, false] {
        let mut bench = Bench { is_braked, ..Bench::new() };
        // Pushed, or so a wheel says: one that is open waits.
        bench.measured.speed_m_s = 0.3;
        let brake = Command { brake: true, ..coast() };
        bench.run(Order::Arm, brake);
        let first = (0..20).find_map(|_| bench.run(Order::None, brake).command()).unwrap();
        assert_eq!(first.brake, is_braked);
    }
}

#[test]
fn a_wire_that_breaks_moves_no_target() {
    let mut bench = Bench::armed();
    bench.measured.front_angle_rad = -0.35;
    let ask = Command { front_angle_rad: -0.35, ..strokes(0.17) };
    for _ in 0..200 {
        bench.run(Order::None, ask);
    }
    bench.measured.stroke_m[2] = 0.545;
    bench.measured.front_angle_rad = 0.436;
    let held = bench.run(Order::None, ask).command().unwrap();
    let Arms::Position([_, _, Some(stroke_m), ..]) = held.arms else { panic!("{held:?}") };
    assert_eq!((stroke_m, held.front_angle_rad), (0.17, -0.35));
}

#[test]
fn a_target_waits_for_an_arm_that_does_not_follow() {
    let mut bench = Bench::armed();
    let last_m = |bench: &mut Bench, asked_m: f64| {
        let held = (0..200).map(|_| bench.run(Order::None, strokes(asked_m))).last();
        let Some(Arms::Position([Some(stroke_m), ..])) =
            held.and_then(|held| held.command()).map(|held| held.arms)
        else {
            panic!("{held:?}")
        };
        stroke_m
    };
    bench.measured.stroke_m[0] = 0.05;
    assert!((last_m(&mut bench, 0.25) - 0.15).abs() < 1e-9);
    bench.measured.stroke_m[0] = 0.02;
    assert!((last_m(&mut bench, 0.25) - 0.15).abs() < 1e-9, "pushed away, it comes back");
    assert!(last_m(&mut bench, 0.0).abs() < 1e-9);
}

#[test]
fn a_valve_is_not_opened_against_an_end_stop() {
    let mut bench = Bench::armed();
    bench.measured.stroke_m = [0.249, 0.001, 0.1, 0.1, 0.1, 0.1];
    let open = Command { arms: Arms::Valve([0.2, -0.2, 0.2, -0.2, 0.9, -0.9]), ..coast() };
    let held = bench.run(Order::None, open).command().unwrap();
    assert_eq!(held.arms, Arms::Valve([0.0, 0.0, 0.2, -0.2, 0.3, -0.3]));
}
