//! What a stop looks like on the bus, and orders that come before there is anything to stop.

mod bench;
mod vehicle;

use std::path::Path;

use bench::Bench;
use gateway::policy::{Hold, Script};
use gateway::{Gateway, GatewayConfig, Order, Outcome, Phase, Policy};
use vehicle::Variant;
use xt28_machine::Machine;
use xt28_safety::Limits;

const AT_ONCE: Variant =
    Variant { throttle_delay_s: 0.0, steering_delay_s: 0.0, speed_factor: 1.0, noise: false };

fn bench(arm_at_start: bool) -> Bench {
    bench_of(Box::new(Hold), arm_at_start)
}

fn bench_of(policy: Box<dyn Policy>, arm_at_start: bool) -> Bench {
    let machine = Machine::xt28();
    let config = GatewayConfig { arm_at_start, ..GatewayConfig::new(&machine) };
    Bench::new(Gateway::new(&machine, config, policy), AT_ONCE)
}

/// Ticks after an order to disarm until the brake is asked for, of a machine that rolls on at this speed.
fn ticks_to_brake(speed_m_s: f64) -> usize {
    let mut bench = bench(true);
    bench.run_until(2.0, |status| status.phase == Phase::Armed);
    bench.vehicle.speed_m_s = speed_m_s;
    bench.tick();
    bench.gateway.order(Order::Disarm);
    let brakes = |bench: &mut Bench| {
        bench.vehicle.speed_m_s = speed_m_s;
        bench.tick();
        bench.drive_target().unwrap().brake
    };
    (0..150).position(|_| brakes(&mut bench)).unwrap()
}

#[test]
fn a_stop_brakes_a_standing_machine_at_once_and_a_rolling_one_after_a_second() {
    assert_eq!(ticks_to_brake(0.0), 0);
    let waited = ticks_to_brake(0.5);
    assert!((99..=101).contains(&waited), "{waited}");
}

#[test]
fn an_order_to_disarm_outlasts_the_arming_at_the_start() {
    for order in [Order::Disarm, Order::EmergencyStop] {
        let mut bench = bench(true);
        bench.gateway.order(order);
        for _ in 0..100 {
            bench.tick();
            assert!(bench.drive_target().is_none(), "{order:?}");
        }
        assert!(bench.gateway.is_silent());
    }
}

#[test]
fn a_gateway_with_an_order_to_carry_out_is_not_silent() {
    let mut bench = bench(false);
    bench.tick();
    assert!(bench.gateway.is_silent());
    bench.gateway.order(Order::Arm);
    assert!(!bench.gateway.is_silent());
}

#[test]
fn a_script_that_is_armed_again_begins_again() {
    let text = "end_s = 0.5\n[[command]]\nat_s = 0\nfront_angle_deg = 5\n";
    let script = Script::parse(text, Path::new("test.toml"), &Limits::XT28).unwrap();
    let mut bench = bench_of(Box::new(script), true);
    bench.run_until(2.0, |status| status.outcome == Outcome::Reached);
    bench.gateway.order(Order::Disarm);
    (0..200).for_each(|_| bench.tick());
    assert_eq!(bench.gateway.outcome(), Outcome::Running);
    bench.gateway.order(Order::Arm);
    bench.run_until(5.0, |status| status.phase == Phase::Armed);
    assert_eq!(bench.gateway.outcome(), Outcome::Running);
}
