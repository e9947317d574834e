//! Our side of `cargo xtask second-engine`: one manoeuvre as CSV on stdout, its cost on stderr.
//!
//! ```sh
//! cargo run --release -p xt28-sim --example trajectory -- run rapier turn 120
//! ```
// A program: it prints, reads its arguments and exits.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)]

mod manoeuvre;

use std::fmt::Write as _;
use std::time::Duration;

use manoeuvre::{Manoeuvre, Sample, terrain};
use rustix::time::{ClockId, clock_gettime};
use xt28_machine::{Machine, PerWheel};
use xt28_sim::{Bodies, Effects, Plant, RapierBodies, ReducedBodies, Terrain, Vehicle};

const USAGE: &str = "usage: trajectory engines | grid TERRAIN | start TERRAIN | run ENGINE MANOEUVRE HZ [TERRAIN [MACHINE]]";
/// Our engines, by name.
const ENGINES: [&str; 2] = ["rapier", "reduced"];

fn main() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["engines"] => println!("{}", ENGINES.join("\n")),
        ["grid", name] => print!("{}", ascii_grid(&terrain(name)?)),
        ["start", name] => println!("{}", start(&terrain(name)?)?),
        ["run", engine, manoeuvre, rate, ref rest @ ..] => {
            let manoeuvre = Manoeuvre::load(manoeuvre)?;
            let rate_hz = rate.parse().map_err(|error| format!("{rate}: {error}"))?;
            let ground = terrain(rest.first().unwrap_or(&manoeuvre.terrain.as_str()))?;
            let machine = match rest.get(1) {
                Some(path) => Machine::load(path.as_ref()).map_err(|error| error.to_string())?,
                None => Machine::xt28(),
            };
            match engine {
                "rapier" => run::<RapierBodies>(&machine, &manoeuvre, &ground, rate_hz),
                "reduced" => run::<ReducedBodies>(&machine, &manoeuvre, &ground, rate_hz),
                other => return Err(format!("no engine `{other}`; {USAGE}")),
            }
        }
        _ => return Err(USAGE.to_owned()),
    }
    Ok(())
}

/// Where the machine is set down: position in m, yaw, roll and pitch in rad.
fn start(ground: &Terrain) -> Result<String, String> {
    let strokes = PerWheel::splat(Manoeuvre::load("settle")?.start_stroke_m);
    let vehicle = Vehicle::new(&Machine::xt28(), ground, strokes);
    let s = vehicle.state();
    let [x, y, z] = s.position_m;
    Ok(format!("{x},{y},{z},{},{},{}", s.yaw_rad, s.roll_rad, s.pitch_rad))
}

/// Prints the trajectory and what a step took of the processor.
fn run<B: Bodies>(machine: &Machine, manoeuvre: &Manoeuvre, ground: &Terrain, rate_hz: u32) {
    let strokes = PerWheel::splat(manoeuvre.start_stroke_m);
    let step = Duration::from_secs_f64(1.0 / f64::from(rate_hz));
    let effects = Effects::default();
    let mut vehicle = Vehicle::<B>::with(machine, &effects, ground, strokes, step);
    manoeuvre.settle(&mut vehicle, rate_hz);
    let mut samples = Vec::new();
    let begun = processor_ns();
    manoeuvre.drive(&mut vehicle, rate_hz, |sample| samples.push(sample));
    let took_ns = processor_ns() - begun;

    println!("{}", Sample::header());
    for sample in &samples {
        let numbers: Vec<String> = sample.numbers().iter().map(|n| format!("{n:.9}")).collect();
        println!("{}", numbers.join(","));
    }
    let steps = manoeuvre.steps(rate_hz)[1];
    #[allow(clippy::cast_precision_loss)]
    let step_ns = took_ns as f64 / steps as f64;
    eprintln!("{{\"steps\": {steps}, \"step_ns\": {step_ns}}}");
}

/// Time that this thread has had of the processor, ns.
fn processor_ns() -> i64 {
    let now = clock_gettime(ClockId::ThreadCPUTime);
    now.tv_sec * 1_000_000_000 + now.tv_nsec
}

/// The ground within reach of every manoeuvre as an ESRI ASCII grid, northern row first. Heights
/// are printed so that they read back as the very same `f32`.
#[allow(clippy::cast_possible_truncation)]
fn ascii_grid(ground: &Terrain) -> String {
    // In grid steps: x from -15 to 25 m, y from -15 to 15 m.
    let (columns, rows) = (-150..=250_i32, -150..=150_i32);
    let (count_x, count_y) = (columns.clone().count(), rows.clone().count());
    let mut text = format!("ncols {count_x}\nnrows {count_y}\n");
    text.push_str("xllcenter -15\nyllcenter -15\ncellsize 0.1\n");
    for row in rows.rev() {
        for column in columns.clone() {
            let height = ground.height_m(f64::from(column) / 10.0, f64::from(row) / 10.0) as f32;
            let _ = write!(text, "{height} ");
        }
        text.push('\n');
    }
    text
}
