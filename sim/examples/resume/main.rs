//! How far a vehicle resumed from its own state drifts from the true snapshot, as a table.
//!
//! `cargo run --release -p xt28-sim --example resume`
#![allow(clippy::disallowed_macros)] // a binary prints

mod drift;

use core::time::Duration;

use drift::{Drift, with_roll_hinge};
use xt28_machine::Machine;
use xt28_sim::{Placed, RapierBodies, ReducedBodies, Solver};

fn main() {
    println!("driving over a ramp in a bend, arms moving; largest distance from the snapshot");
    println!(
        "machine               at s  warm ms  after s  stroke mm  roll/pitch mrad  position mm  joint mrad  \
         wheel mrad/s"
    );
    for (machine, with) in [(Machine::xt28(), ""), (with_roll_hinge(), ", roll hinge")] {
        table::<RapierBodies>(&machine, &format!("{}{with}", Solver::Rapier));
        table::<ReducedBodies>(&machine, &format!("{}{with}", Solver::Reduced));
    }
}

fn table<B: Placed>(machine: &Machine, which: &str) {
    for at_s in [6.0, 10.0, 14.0] {
        for warm_ms in [0, 50, 200] {
            let drift = Drift::of::<B>(machine, at_s, Duration::from_millis(warm_ms));
            for (after_s, d) in [(1, drift.after_1_s), (5, drift.after_5_s)] {
                println!(
                    "{which:20}  {at_s:4}  {warm_ms:7}  {after_s:7}  {:9.2}  {:15.2}  {:11.1}  \
                     {:10.2}  {:12.1}",
                    d.stroke_m * 1e3,
                    d.attitude_rad * 1e3,
                    d.position_m * 1e3,
                    d.joint_rad * 1e3,
                    d.wheel_rad_s * 1e3,
                );
            }
        }
    }
}
