//! Gains of the automatic mode: what they cost, their stability margins, and their neighbours.
//!
//! `cargo run --release -p ecu-emu --example tune_levelling`             the machine file's gains
//! `cargo run --release -p ecu-emu --example tune_levelling -- search`   and a grid around them
//!
//! The arm ECU runs on the plant in lockstep, once with valves as they are and once 0.2 s late: the
//! longest delay of the arms that the paper measured (3.3). Gains must leave 45 degrees and 6 dB with
//! that delay; of those that do, the ones that settle soonest are chosen.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // a program: arguments, and a table

mod cost;
mod margins;
mod rig;

use xt28_machine::Machine;

use crate::cost::{Outcome, STARTS};
use crate::margins::{DIRECTIONS, Margins, loop_gain};

/// Delays that the loops must stand, ticks: as nominal, and the longest of the paper.
const DELAYS: [usize; 2] = [0, 20];

fn main() {
    let machine = Machine::xt28();
    match std::env::args().nth(1).as_deref() {
        None => report(&machine),
        Some("search") => search(&machine),
        Some(other) => {
            eprintln!("unknown argument `{other}`; give `search` or none");
            std::process::exit(2);
        }
    }
}

fn report(machine: &Machine) {
    println!("{:#?}", machine.levelling);
    for delay_ticks in DELAYS {
        println!("\nvalves {:.2} s late", delay_ticks as f64 * 0.01);
        println!("  loop                        crossover   phase   gain    delay it stands");
        for (name, direction) in DIRECTIONS {
            match Margins::of(&loop_gain(machine, &direction, delay_ticks)) {
                Some(m) => println!(
                    "  {name:26} {:6.2} rad/s {:5.0} deg {:4.1} dB {:5.2} s",
                    m.crossover_rad_s, m.phase_deg, m.gain_db, m.delay_s
                ),
                None => println!("  {name:26} no crossover between 0.3 and 24 rad/s"),
            }
        }
        println!("  from a start off in      by         settled  overshoot  left at 20 s");
        for start in STARTS {
            let o: Outcome = start.run(machine, delay_ticks);
            println!(
                "  {:22} {:8.3} {:3} {:6.2} s {:7.1} %  {:9.3} {}",
                start.name,
                o.first,
                start.unit,
                o.settling_s,
                o.overshoot_percent,
                o.last,
                start.unit
            );
        }
    }
}

/// Worst margins and total cost over a grid of the levelling gains' scale and the force gain.
fn search(machine: &Machine) {
    println!("levelling  force   phase    gain    ITAE");
    for force in [0.5, 0.75, 1.0, 1.25, 1.5] {
        for levelling in [0.5, 0.75, 1.0, 1.25, 1.5] {
            let mut tried = machine.clone();
            let gains = &mut tried.levelling;
            // The valves see the product: so the two axes of the grid are the two speeds.
            gains.force_kp_n *= force;
            gains.force_ki_n_s *= force;
            gains.force_kd_s_n *= force;
            gains.height_n_m *= levelling / force;
            gains.roll_n_rad *= levelling / force;
            gains.pitch_n_rad *= levelling / force;
            let late = DELAYS[1];
            let margins = DIRECTIONS.map(|(_, d)| Margins::of(&loop_gain(&tried, &d, late)));
            let worst = |of: fn(&Margins) -> f64| {
                margins.iter().flatten().map(of).fold(f64::INFINITY, f64::min)
            };
            let itae: f64 = STARTS.iter().map(|start| start.run(&tried, late).itae_s2).sum();
            println!(
                "{levelling:9.2} {force:6.2} {:5.0} deg {:4.1} dB {itae:6.2} s2",
                worst(|m| m.phase_deg),
                worst(|m| m.gain_db)
            );
        }
    }
}
