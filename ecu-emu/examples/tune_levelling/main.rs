//! Gains of the automatic mode: what they cost, their stability margins, and their neighbours.
//!
//! `cargo run --release -p ecu-emu --example tune_levelling`             the machine file's gains
//! `cargo run --release -p ecu-emu --example tune_levelling -- search`   each gain at multiples of it
//!
//! The arm ECU runs on the plant in lockstep, once with valves as they are and once 0.2 s late: the
//! longest delay of the arms that the paper measured (3.3). Gains must leave 45 degrees and 6 dB with
//! that delay; of those that do, the ones that settle soonest are chosen.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)] // a program: arguments, and a table

mod cost;
mod margins;
mod rig;

use xt28_machine::{Levelling, Machine};

use crate::cost::{Outcome, STARTS};
use crate::margins::{DIRECTIONS, Margins, loop_gain};

/// Delays that the loops must stand, ticks: as nominal, and the longest of the paper.
const DELAYS: [usize; 2] = [0, 20];
/// Margins that gains must leave with the longer one.
const PHASE_MIN_DEG: f64 = 45.0;
const GAIN_MIN_DB: f64 = 6.0;

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

/// One gain, what it moves, and the start that shows it.
struct Knob {
    name: &'static str,
    scale: fn(&mut Levelling, f64),
    /// Index into the directions of which the margins are looked at.
    direction: usize,
    /// Index into the starts.
    start: usize,
}

/// The four controllers. The last one sets the speed at which load shifts; it scales the request of
/// the others along, so those are scaled back.
const KNOBS: [Knob; 4] = [
    Knob { name: "height", scale: |g, by| g.height_n_m *= by, direction: 0, start: 0 },
    Knob { name: "roll", scale: |g, by| g.roll_n_rad *= by, direction: 1, start: 1 },
    Knob { name: "pitch", scale: |g, by| g.pitch_n_rad *= by, direction: 2, start: 2 },
    Knob {
        name: "ground pressure",
        scale: |g, by| {
            g.force_kp_n *= by;
            g.force_ki_n_s *= by;
            g.force_kd_s_n *= by;
            g.height_n_m /= by;
            g.roll_n_rad /= by;
            g.pitch_n_rad /= by;
        },
        direction: 4,
        start: 3,
    },
];

/// Margins and cost of each gain at multiples of what it is, the others as they are, late valves.
fn search(machine: &Machine) {
    let late = DELAYS[1];
    println!("gain               times   phase    gain    settled    ITAE");
    for knob in KNOBS {
        for by in [0.5, 0.7, 0.85, 1.0, 1.2, 1.4, 1.7, 2.0] {
            let mut tried = machine.clone();
            (knob.scale)(&mut tried.levelling, by);
            let (_, direction) = DIRECTIONS[knob.direction];
            let Some(m) = Margins::of(&loop_gain(&tried, &direction, late)) else { continue };
            let o = STARTS[knob.start].run(&tried, late);
            let stable = m.phase_deg >= PHASE_MIN_DEG && m.gain_db >= GAIN_MIN_DB;
            println!(
                "{:18} {by:5.2} {:5.0} deg {:4.1} dB {:6.2} s {:7.2} s2 {}",
                knob.name,
                m.phase_deg,
                m.gain_db,
                o.settling_s,
                o.itae_s2,
                if stable { "" } else { "too little margin" }
            );
        }
    }
}
