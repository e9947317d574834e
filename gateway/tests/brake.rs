//! The parking brake on a machine that moves: it waits to close, and nothing that moves nothing opens it.

mod bench;
mod vehicle;

use std::path::Path;

use bench::{Bench, Faults};
use gateway::policy::{Goto, Script};
use gateway::{Gateway, GatewayConfig, Order, Phase, Policy, Pose};
use vehicle::Variant;
use xt28_machine::Machine;
use xt28_safety::Limits;

const LATE: Variant =
    Variant { throttle_delay_s: 0.2, steering_delay_s: 0.2, speed_factor: 1.0, noise: true };

fn bench(policy: Box<dyn Policy>) -> Bench {
    let machine = Machine::xt28();
    Bench::new(Gateway::new(&machine, GatewayConfig::new(&machine), policy), LATE)
}

fn script(text: &str) -> Box<dyn Policy> {
    Box::new(Script::parse(text, Path::new("test.toml"), &Limits::XT28).unwrap())
}

#[test]
fn a_brake_asked_for_at_speed_closes_when_the_machine_stands() {
    let text = "[[command]]\nat_s = 0\nthrottle_percent = 50\n\
                [[command]]\nat_s = 6\nthrottle_percent = 0\nbrake = true\n\
                [[command]]\nat_s = 9\n";
    let mut bench = bench(script(text));
    bench.run_until(2.0, |status| status.phase == Phase::Armed);
    let mut fastest_m_s = 0.0_f64;
    while !bench.drive_target().unwrap().brake {
        bench.tick();
        fastest_m_s = fastest_m_s.max(bench.vehicle.speed_m_s);
        assert!(bench.now.as_secs_f64() < 12.0);
    }
    assert!(fastest_m_s > 0.7, "{fastest_m_s}");
    assert!(bench.vehicle.speed_m_s < 0.15, "{}", bench.vehicle.speed_m_s);
}

/// A wheel that reads too fast, or a machine that is pushed, is none that may be let go.
#[test]
fn frames_that_move_nothing_open_no_brake() {
    let goal = Pose { east_m: 25.0, ..Pose::default() };
    let mut rolling = bench(Box::new(Goto::new(&Machine::xt28(), goal)));
    rolling.faults = Faults { is_braked: true, ..Faults::default() };
    rolling.vehicle.speed_m_s = 0.3;
    let neutral = (0..12).filter_map(|_| {
        rolling.tick();
        rolling.vehicle.speed_m_s = 0.3;
        rolling.drive_target().filter(|target| !target.enable)
    });
    let braking: Vec<bool> = neutral.map(|target| target.brake).collect();
    assert!(braking.len() > 8 && braking.iter().all(|brake| *brake), "{braking:?}");

    // Nor does arming, for a policy that wants it closed; nor a stop, before the ECU says that it is.
    let wants = script("end_s = 60\n[[command]]\nat_s = 0.0\nbrake = true\n");
    let mut bench = bench(wants);
    let closed = |bench: &mut Bench, ticks: usize| {
        (0..ticks).all(|_| {
            bench.tick();
            bench.drive_target().is_none_or(|target| target.brake)
        })
    };
    assert!(closed(&mut bench, 100));
    assert_eq!(bench.gateway.status().phase, Phase::Armed);
    bench.gateway.order(Order::EmergencyStop);
    bench.vehicle.speed_m_s = 0.3;
    assert!(closed(&mut bench, 1) && bench.drive_target().is_some());
    for _ in 0..90 {
        bench.vehicle.speed_m_s = 0.3;
        assert!(closed(&mut bench, 1));
    }
}
