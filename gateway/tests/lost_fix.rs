//! What a policy that is asked at each tick is told of where it is once the fixes stop.

mod bench;
mod vehicle;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use bench::{Bench, Faults};
use gateway::policy::Hold;
use gateway::{Gateway, GatewayConfig, Observation, Outcome, Pace, Phase, Policy};
use vehicle::Variant;
use xt28_machine::Machine;
use xt28_safety::Command;

fn armed(policy: Lookout) -> Bench {
    let machine = Machine::xt28();
    let gateway = Gateway::new(&machine, GatewayConfig::new(&machine), Box::new(policy));
    let variant =
        Variant { throttle_delay_s: 0.2, steering_delay_s: 0.2, speed_factor: 1.0, noise: true };
    let mut bench = Bench::new(gateway, variant);
    bench.run_until(2.0, |status| status.phase == Phase::Armed);
    bench
}

/// Sees whether it is told where it is, at each tick.
struct Lookout(Arc<AtomicBool>);

impl Policy for Lookout {
    fn pace(&self) -> Pace {
        Pace::Tick
    }

    fn act(&mut self, observation: &Observation) -> Option<Command> {
        self.0.store(observation.located.is_some(), Ordering::Relaxed);
        Hold.act(observation)
    }

    fn outcome(&self) -> Outcome {
        Outcome::Endless
    }
}

#[test]
fn a_policy_without_fixes_is_not_told_where_the_machine_was_long_ago() {
    let told = Arc::new(AtomicBool::new(false));
    let mut bench = armed(Lookout(Arc::clone(&told)));
    assert!(told.load(Ordering::Relaxed));
    bench.faults = Faults { gnss_silent: true, ..Faults::default() };
    let mut ticks = |count: u32| (0..count).for_each(|_| bench.tick());
    ticks(24);
    assert!(told.load(Ordering::Relaxed), "within three fixes");
    ticks(30);
    assert!(!told.load(Ordering::Relaxed));
    assert_eq!(bench.gateway.status().phase, Phase::Armed, "it does not steer by them");
}
