//! Processor time of the six arms' hydraulics for a step: nominal, with each effect, with all.
//!
//! ```sh
//! cargo run --release -p xt28-sim --example arm_blocks
//! ```
// A program: it prints and reads the clock.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)]

use std::hint::black_box;

use rustix::time::{ClockId, clock_gettime};
use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::effects::{Block, CATALOGUE, Effect, Scope};
use xt28_sim::{Arm, ArmInput, CylinderMotion, Effects, FlowSharing};

const DT_S: f64 = 0.005;
/// Steps that are timed at once.
const STEPS: u32 = 20_000;
/// Times they are timed; the quickest counts, for others use the machine too.
const REPEATS: u32 = 20;

fn main() {
    let arms: Vec<&Effect> = CATALOGUE.iter().filter(|e| e.block == Block::Arms).collect();
    println!("| effects | ns a step of six arms |\n|---|---|");
    println!("| none | {:.0} |", step_ns(&Effects::default()));
    for effect in &arms {
        println!("| {} | {:.0} |", effect.name, step_ns(&half_way(&[effect])));
    }
    println!("| all | {:.0} |", step_ns(&half_way(&arms)));
}

/// Every parameter of these effects half way to the end of its range.
fn half_way(effects: &[&Effect]) -> Effects {
    let mut values = Effects::default();
    for p in effects.iter().flat_map(|effect| effect.parameters) {
        p.set(&mut values, Scope::All, 0.5 * (p.neutral + p.range[1]));
    }
    if effects.iter().any(|effect| effect.name == "pump-flow-limit") {
        values.pump_flow.flow_m3_s = 0.001;
    }
    values
}

fn step_ns(effects: &Effects) -> f64 {
    let machine = Machine::xt28();
    let arms = PerWheel::from_fn(|w| Arm::new(&machine, &effects.arms[w]));
    let flow = FlowSharing::new(&machine, effects.pump_flow);
    let mut states = PerWheel::from_fn(|w| arms[w].settled(0.2, 5e4, DT_S));
    let mut best_ns = f64::INFINITY;
    for _ in 0..REPEATS {
        let start_s = thread_s();
        for step in 0..STEPS {
            // A triangle of 2 s: no trigonometry in what is timed.
            let phase = f64::from(step % 400) / 200.0 - 1.0;
            let inputs = PerWheel::from_fn(|w| ArmInput {
                command: 0.6 * phase.abs() - 0.3,
                load_n: arms[w].oil_force_n(&states[w], &motion(phase)),
                motion: motion(phase),
            });
            let speeds = PerWheel::from_fn(|w| arms[w].open(&mut states[w], &inputs[w], DT_S));
            let share = flow.share(speeds.map(|v| flow.cylinder_m3_s(v)).sum());
            for w in Wheel::ALL {
                black_box(arms[w].fill(&mut states[w], &inputs[w], share * speeds[w], DT_S));
            }
        }
        best_ns = best_ns.min((thread_s() - start_s) * 1e9 / f64::from(STEPS));
    }
    best_ns
}

fn motion(phase: f64) -> CylinderMotion {
    let stroke_rate_m_s = 0.02_f64.copysign(phase);
    CylinderMotion { stroke_m: 0.18 + 0.02 * phase.abs(), stroke_rate_m_s }
}

/// Processor time of this thread, s.
fn thread_s() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}
