//! Whatever the bits: nothing outside the limits leaves, and nothing at all unless armed.

mod bench;

use bench::{Bench, LIMITS, TICK_NS};
use proptest::prelude::*;
use xt28_safety::{
    Arms, Command, Deadline, Input, Limits, Link, Measured, Order, Stamps, State, Verdict, step,
};

/// Any bit pattern, with the awkward ones often.
fn bits() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => -1.5..1.5_f64,
        2 => any::<u64>().prop_map(f64::from_bits),
        1 => any::<u32>().prop_map(|b| f64::from(f32::from_bits(b))),
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(-f64::MAX),
        1 => Just(-0.0),
    ]
}

/// Finite, over the whole exponent range: passes the finiteness check and meets the limits.
fn finite() -> impl Strategy<Value = f64> {
    prop_oneof![2 => -1.5..1.5_f64, 1 => bits().prop_map(|x| if x.is_finite() { x } else { 0.3 })]
}

/// Where a sensor in order can have an arm.
fn stroke_m() -> impl Strategy<Value = f64> + Clone {
    LIMITS.stroke_read_m[0]..=LIMITS.stroke_read_m[1]
}

fn command(number: impl Strategy<Value = f64> + Clone) -> impl Strategy<Value = Command> {
    let arms = prop_oneof![
        Just(Arms::Off),
        Just(Arms::Automatic),
        proptest::array::uniform6(proptest::option::of(number.clone())).prop_map(Arms::Position),
        proptest::array::uniform6(number.clone()).prop_map(Arms::Valve),
    ];
    (number.clone(), number, arms, any::<bool>()).prop_map(
        |(throttle, front_angle_rad, arms, brake)| Command {
            throttle,
            front_angle_rad,
            arms,
            brake,
        },
    )
}

fn order() -> impl Strategy<Value = Order> {
    prop_oneof![
        Just(Order::None),
        Just(Order::Arm),
        Just(Order::Disarm),
        Just(Order::EmergencyStop),
        Just(Order::Release),
    ]
}

fn measured() -> impl Strategy<Value = Measured> {
    (proptest::array::uniform6(bits()), bits(), bits(), bits(), bits()).prop_map(
        |(stroke_m, front_angle_rad, speed_m_s, roll_rad, pitch_rad)| Measured {
            stroke_m,
            front_angle_rad,
            speed_m_s,
            roll_rad,
            pitch_rad,
        },
    )
}

fn link() -> impl Strategy<Value = Link> {
    (any::<Option<u64>>(), any::<bool>(), any::<Option<u8>>(), any::<u8>()).prop_map(
        |(heard_at_ns, ready, sent, accepted)| Link { heard_at_ns, ready, sent, accepted },
    )
}

prop_compose! {
    fn any_input()(
        order in order(), request in proptest::option::of(command(bits().boxed())),
        measured in measured(), arm in link(), drive in link(),
        stamps in any::<[Option<u64>; 3]>(),
        (bus_ok, alone, is_braked) in any::<(bool, bool, bool)>(),
    ) -> Input {
        let [sensors_ns, observation_ns, policy_ns] = stamps;
        Input { order, request, measured, is_braked, arm, drive, bus_ok, alone,
            stamps: Stamps { sensors_ns, observation_ns, policy_ns } }
    }
}

/// Limits that can be held to, from none at all to no limit; the machine stands level within them.
fn sound_limits() -> impl Strategy<Value = Limits> {
    let limit = prop_oneof![4 => 0.0..2.0_f64, 1 => Just(0.0), 1 => Just(1e300)];
    (proptest::array::uniform10(limit), 0.01..1.0_f64).prop_map(|(floats, lean)| {
        let [s0, s1, s2, o, t0, t1, a0, a1, a2, b] = floats;
        let limits = Limits {
            stroke_max_m: s0,
            stroke_rate_m_s: s1,
            stroke_error_m: s2,
            opening_max: o,
            throttle_max: t0,
            throttle_rate_s: t1,
            angle_max_rad: a0,
            angle_rate_rad_s: a1,
            angle_error_rad: a2,
            brake_speed_m_s: b,
            roll_max_rad: lean,
            pitch_max_rad: lean,
            ..LIMITS
        };
        assert!(limits.are_sound());
        limits
    })
}

fn assert_within(limits: &Limits, command: &Command) {
    assert!(command.is_finite(), "{command:?}");
    assert!(command.throttle.abs() <= limits.throttle_max);
    assert!(!command.brake || command.throttle == 0.0);
    assert!(command.front_angle_rad.abs() <= limits.angle_max_rad);
    match command.arms {
        Arms::Off | Arms::Automatic => {}
        Arms::Position(s) => {
            assert!(s.iter().flatten().all(|s| (0.0..=limits.stroke_max_m).contains(s)), "{s:?}");
        }
        Arms::Valve(o) => assert!(o.iter().all(|o| o.abs() <= limits.opening_max), "{o:?}"),
    }
}

fn check(limits: &Limits, state: State, verdict: &Verdict) {
    match verdict.command() {
        Some(command) => {
            assert!(state.is_armed(), "a command left a kernel that is not armed");
            assert_within(limits, &command);
        }
        None => assert!(!state.is_armed(), "armed yet blocked"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn any_sequence_of_any_inputs_is_answered_within_the_limits(
        inputs in proptest::collection::vec((any_input(), any::<u64>()), 1..20),
    ) {
        let mut state = State::new();
        for (input, now_ns) in inputs {
            let (next, verdict) = step(&LIMITS, state, &input, now_ns);
            check(&LIMITS, next, &verdict);
            state = next;
        }
    }

    #[test]
    fn an_armed_kernel_lets_nothing_outside_the_limits_through(
        requests in proptest::collection::vec((command(finite().boxed()), 0..100_000_000_u64), 1..40),
        stroke_m in proptest::array::uniform6(stroke_m()), front_angle_rad in -0.7..0.7_f64,
    ) {
        let mut bench = Bench::armed();
        bench.measured.stroke_m = stroke_m;
        bench.measured.front_angle_rad = front_angle_rad;
        for (request, late_ns) in requests {
            bench.now_ns += late_ns;
            let verdict = bench.run(Order::None, request);
            check(&LIMITS, bench.state, &verdict);
        }
    }

    #[test]
    fn rates_hold_whatever_is_asked_and_measured_and_nothing_goes_where_nobody_asked(
        steps in proptest::collection::vec(
            (command(finite().boxed()), proptest::array::uniform6(stroke_m()), -0.7..0.7_f64, finite()), 2..60),
    ) {
        let mut bench = Bench::armed();
        let mut before: Option<Command> = None;
        for (request, stroke_m, front_angle_rad, speed_m_s) in steps {
            bench.measured = Measured { stroke_m, front_angle_rad, speed_m_s, ..bench.measured };
            let Some(now) = bench.run(Order::None, request).command() else {
                panic!("{:?}", bench.state)
            };
            if let Some(before) = before {
                let dt_s = 1e-9 * TICK_NS as f64;
                let turned = (now.front_angle_rad - before.front_angle_rad).abs();
                prop_assert!(turned <= LIMITS.angle_rate_rad_s * dt_s + 1e-12);
                let grown = now.throttle.abs() - before.throttle.abs();
                prop_assert!(grown <= LIMITS.throttle_rate_s * dt_s + 1e-12);
                let asked = request.front_angle_rad.clamp(-LIMITS.angle_max_rad, LIMITS.angle_max_rad);
                let off_rad = |held: &Command| (held.front_angle_rad - asked).abs();
                prop_assert!(off_rad(&now) <= off_rad(&before) + 1e-12);
                if let (Arms::Position(a), Arms::Position(b), Arms::Position(asked)) =
                    (now.arms, before.arms, request.arms)
                {
                    for ((a, b), asked) in a.iter().zip(b).zip(asked) {
                        if let (Some(a), Some(b), Some(asked)) = (a, b, asked) {
                            prop_assert!((a - b).abs() <= LIMITS.stroke_rate_m_s * dt_s + 1e-12);
                            let asked = asked.clamp(0.0, LIMITS.stroke_max_m);
                            prop_assert!((a - asked).abs() <= (b - asked).abs() + 1e-12);
                        }
                    }
                }
            }
            before = Some(now);
        }
    }

    #[test]
    fn sound_limits_hold_whatever_they_are(
        limits in sound_limits(), front_angle_rad in -0.5..0.5_f64,
        requests in proptest::collection::vec(command(finite().boxed()), 1..40),
    ) {
        let mut bench = Bench::armed_within(limits);
        bench.measured.front_angle_rad = front_angle_rad;
        for request in requests {
            let verdict = bench.run(Order::None, request);
            check(&limits, bench.state, &verdict);
            prop_assert!(bench.state.is_armed(), "{:?}", verdict);
        }
    }

    #[test]
    fn limits_of_any_bits_never_panic(
        floats in proptest::array::uniform12(bits()), periods in any::<u32>(),
        period_ns in any::<u64>(), modulus in any::<u8>(), lag in any::<u8>(),
        inputs in proptest::collection::vec(any_input(), 1..4),
    ) {
        let every = Deadline { period_ns, periods };
        let [s0, s1, s2, o, t0, t1, a0, a1, a2, r, p, b] = floats;
        let limits = Limits {
            stroke_max_m: s0, stroke_rate_m_s: s1, stroke_error_m: s2, opening_max: o,
            throttle_max: t0, throttle_rate_s: t1, angle_max_rad: a0, angle_rate_rad_s: a1,
            angle_error_rad: a2, brake_speed_m_s: b, brake_wait_ns: period_ns, roll_max_rad: r, pitch_max_rad: p, status: every, sensors: every,
            observation: every, policy: every, acknowledgement: every, handshake_steps: 1,
            handshake_max_ns: period_ns, counter_lag_max: lag, counter_modulus: modulus,
            step_max_ns: period_ns, stroke_read_m: [p, s0], angle_read_rad: a0, steady_ns: period_ns,
        };
        let mut state = State::new();
        for input in inputs {
            let (next, verdict) = step(&limits, state, &input, period_ns);
            check(&limits, next, &verdict);
            state = next;
        }
    }
}
