//! What was asked before the kernel was armed, or before it was armed this time, moves nothing.

mod bench;
mod vehicle;

use bench::Bench;
use gateway::policy::{External, Goto, Seat};
use gateway::{Action, Gateway, GatewayConfig, Order, Pace, Phase, Policy, Pose};
use vehicle::Variant;
use xt28_machine::Machine;

const AT_ONCE: Variant =
    Variant { throttle_delay_s: 0.0, steering_delay_s: 0.0, speed_factor: 1.0, noise: false };

fn bench(policy: Box<dyn Policy>) -> Bench {
    let machine = Machine::xt28();
    Bench::new(Gateway::new(&machine, GatewayConfig::new(&machine), policy), AT_ONCE)
}

fn is_armed(bench: &Bench) -> bool {
    bench.gateway.status().phase == Phase::Armed
}

/// Answers the newest observation with everything that an action can ask for.
fn answer(bench: &Bench, seat: &Seat, seen: Option<u64>) {
    if let Some(seq) = seen.or_else(|| seat.take().map(|seen| seen.seq)) {
        seat.answer(bench.now, seq, Action([1.0; 8])).unwrap();
    }
}

/// Throttle and joint that are sent, and whether an arm has a target.
fn sent(bench: &Bench) -> (f64, f64, bool) {
    let (drive, arm) = (bench.drive_target().unwrap(), bench.arm_target().unwrap());
    (drive.throttle_percent, drive.front_angle_deg, arm.fr_mm < 500.0)
}

#[test]
fn an_answer_to_what_was_seen_before_arming_moves_nothing() {
    let (policy, seat) = External::new(&Machine::xt28(), Pace::Fix);
    let mut bench = bench(Box::new(policy));
    let arm = |bench: &mut Bench| {
        while !is_armed(bench) {
            answer(bench, &seat, None);
            bench.tick();
        }
    };
    arm(&mut bench);
    // Until the next fix what was asked before is all there is.
    for _ in 0..5 {
        assert_eq!(sent(&bench), (0.0, 0.0, false));
        bench.tick();
    }
    let rolls = |bench: &mut Bench| {
        (0..100).any(|_| {
            answer(bench, &seat, None);
            bench.tick();
            sent(bench).0 > 20.0
        })
    };
    assert!(rolls(&mut bench), "an answer to what is seen while it is armed");

    // Stopped and armed again at once: what was seen before the stop is answered late.
    let late = loop {
        bench.tick();
        if let Some(seen) = seat.take() {
            break seen.seq;
        }
    };
    bench.gateway.order(Order::Disarm);
    bench.tick();
    assert!(!is_armed(&bench));
    bench.gateway.order(Order::Arm);
    answer(&bench, &seat, Some(late));
    for _ in 0..25 {
        bench.tick();
        if is_armed(&bench) {
            let (throttle, _, has_target) = sent(&bench);
            assert!(throttle == 0.0 && !has_target);
        }
    }
    assert!(is_armed(&bench), "{:?}", bench.gateway.status().blocked);
    assert!(rolls(&mut bench));
}

#[test]
fn a_drive_that_was_stopped_goes_on_with_what_is_seen_once_it_is_armed_again() {
    let goal = Pose { east_m: 25.0, ..Pose::default() };
    let mut bench = bench(Box::new(Goto::new(&Machine::xt28(), goal)));
    (0..400).for_each(|_| bench.tick());
    assert!(sent(&bench).0 > 20.0);
    bench.gateway.order(Order::Disarm);
    (0..30).for_each(|_| bench.tick());
    bench.gateway.order(Order::Arm);
    while !is_armed(&bench) {
        bench.tick();
    }
    assert_eq!(sent(&bench).0, 0.0, "it has not been asked since");
    (0..100).for_each(|_| bench.tick());
    assert!(sent(&bench).0 > 20.0);
}
