//! A machine that runs onto a stump, on both solvers at several step rates: how far they part, and what pushes its frames.
//!
//! ```sh
//! cargo run --release -p xt28-sim --example grounded
//! ```
// A program: it prints.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)]

use std::sync::Arc;
use std::time::Duration;

use xt28_machine::{Machine, PerWheel};
use xt28_sim::terrain::{Extent, Grid};
use xt28_sim::{
    Actuation, Bodies, Effects, Plant, RapierBodies, ReducedBodies, Terrain, Vehicle, VehicleState,
};

/// Step rates, Hz; all have steps that end every [`SAMPLE_S`].
const RATES_HZ: [u32; 5] = [60, 120, 200, 1000, 2000];
/// When a run is looked at, s.
const SAMPLE_S: f64 = 0.05;
const SECONDS: f64 = 9.0;

fn main() {
    println!("stump 0.5 m high and 0.4 m wide, arms at 0.05 m, pumps open from 2 to 4 s");
    println!("engine   rate Hz  grounded s  peak kN  mean kN  stands m  from 2000 Hz m");
    let runs = [
        ("rapier", RATES_HZ.map(run::<RapierBodies>)),
        ("reduced", RATES_HZ.map(run::<ReducedBodies>)),
    ];
    for (name, runs) in &runs {
        let finest = &runs[RATES_HZ.len() - 1];
        for (rate_hz, run) in RATES_HZ.iter().zip(runs) {
            let Run { first_s, peak_n, mean_n, states } = run;
            let stands_m = states[states.len() - 1].position_m[0];
            let (peak_kn, mean_kn) = (peak_n / 1e3, mean_n / 1e3);
            let off_m = apart_m(states, &finest.states);
            println!(
                "{name:8} {rate_hz:7}  {first_s:10.2}  {peak_kn:7.1}  {mean_kn:7.1}  {stands_m:8.3}  {off_m:14.3}"
            );
        }
    }
    println!("\nlargest distance of rapier from reduced");
    println!("rate Hz  before it grounds m  over the run m");
    for (i, rate_hz) in RATES_HZ.iter().enumerate() {
        let [one, other] = [&runs[0].1[i], &runs[1].1[i]];
        let first_s = one.first_s.min(other.first_s);
        let free = (first_s / SAMPLE_S) as usize;
        let before_m = apart_m(&one.states[..free], &other.states[..free]);
        let over_m = apart_m(&one.states, &other.states);
        println!("{rate_hz:7}  {before_m:19.3}  {over_m:14.3}");
    }
}

struct Run {
    /// When anything but wheels first touched the ground, s.
    first_s: f64,
    /// Greatest force on the frames over a step, and its mean over the last 2 s, N.
    peak_n: f64,
    mean_n: f64,
    states: Vec<VehicleState>,
}

fn run<B: Bodies>(rate_hz: u32) -> Run {
    let on_it = |x: f64, y: f64| (2.6..=3.0).contains(&x) && y.abs() <= 0.2;
    let extent = Extent { x_m: [-10.0, 15.0], y_m: [-5.0, 5.0] };
    let grid = Grid::from_fn(extent, |x, y| if on_it(x, y) { 0.5 } else { 0.0 });
    let step = Duration::from_secs_f64(1.0 / f64::from(rate_hz));
    let mut vehicle = Vehicle::<B>::with(
        &Machine::xt28(),
        &Effects::default(),
        &Terrain::Grid(Arc::new(grid)),
        PerWheel::splat(0.05),
        step,
    );
    let steps = (SECONDS * f64::from(rate_hz)).round() as u32;
    let a_sample = (SAMPLE_S * f64::from(rate_hz)).round() as u32;
    let late = 2 * rate_hz;
    let mut run = Run { first_s: f64::INFINITY, peak_n: 0.0, mean_n: 0.0, states: Vec::new() };
    for k in 0..steps {
        let t = f64::from(k) / f64::from(rate_hz);
        let pump = ((t - 2.0) / 2.0).clamp(0.0, 1.0);
        vehicle.step(&Actuation { pump_displacement: [pump; 2], ..Actuation::idle(1200.0) });
        let s = vehicle.state();
        if s.chassis_force_n > 0.0 {
            run.first_s = run.first_s.min(t);
        }
        run.peak_n = run.peak_n.max(s.chassis_force_n);
        if k >= steps - late {
            run.mean_n += s.chassis_force_n / f64::from(late);
        }
        if (k + 1) % a_sample == 0 {
            run.states.push(*s);
        }
    }
    run
}

/// Largest distance between two runs at the same moments, m.
fn apart_m(a: &[VehicleState], b: &[VehicleState]) -> f64 {
    let both = a.iter().zip(b).map(|(a, b)| {
        let square = a.position_m.iter().zip(b.position_m).map(|(a, b)| (a - b).powi(2));
        square.sum::<f64>().sqrt()
    });
    both.fold(0.0, f64::max)
}
