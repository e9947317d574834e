//! Independent environments on more and more threads: steps a second, and the efficiency of it; each
//! thread with environments of its own, then all of them as a fleet, as a trainer steps them.
//!
//! Steps a second are by the clock on the wall, so they mean something on an idle machine only. The
//! processor's time for a step and how often a thread gave the processor up of its own accord are
//! told as well: where others are busy they still show whether threads hinder one another.
//!
//! ```sh
//! cargo run --release -p xt28-sim --example scaling
//! ```
// A program: it prints and reads the clock.
#![allow(clippy::disallowed_methods, clippy::disallowed_macros)]

use std::thread;
use std::time::{Duration, Instant};

use rayon::ThreadPoolBuilder;
use rustix::time::{ClockId, clock_gettime};
use xt28_machine::{Machine, PerWheel};
use xt28_sim::{
    Actuation, Bodies, Effects, Fleet, Plant, RapierBodies, ReducedBodies, Terrain, Vehicle,
};

/// Steps per second of simulated time.
const RATE_HZ: u32 = 120;
/// Environments a thread.
const ENVIRONMENTS: usize = 4;
/// Steps of each environment that are timed.
const STEPS: usize = 1200;
/// Environments a thread of a fleet: fewer, and calling its threads together is a share of the work.
const OF_A_FLEET: usize = 32;
/// Steps that a fleet makes a call: a policy is asked twenty times a second.
const STEPS_A_CALL: u32 = RATE_HZ / 20;
/// Calls of a fleet that are timed.
const CALLS: usize = 40;
/// Times each number of threads is measured; the quickest counts, for others use the machine too.
const REPEATS: usize = 5;

fn main() -> Result<(), String> {
    let rough = concat!(env!("CARGO_MANIFEST_DIR"), "/../tools/yardstick/rough.toml");
    let ground = Terrain::load(rough.as_ref()).map_err(|error| error.to_string())?;
    let cores = thread::available_parallelism().map_or(1, usize::from);
    println!(
        "\n{ENVIRONMENTS} environments a thread at {RATE_HZ} Hz on rough ground, {cores} cores\n"
    );
    let heading = "| engine | threads | steps/s | efficiency | processor us/step | waits |";
    println!("{heading}\n|---|---|---|---|---|---|");
    measure("rapier", cores, |threads| pace::<RapierBodies>(&ground, threads));
    measure("reduced", cores, |threads| pace::<ReducedBodies>(&ground, threads));
    println!("\nAs a fleet, {OF_A_FLEET} environments a thread, {STEPS_A_CALL} steps a call\n");
    println!("{heading}\n|---|---|---|---|---|---|");
    measure("rapier", cores, |threads| fleet_pace::<RapierBodies>(&ground, threads));
    measure("reduced", cores, |threads| fleet_pace::<ReducedBodies>(&ground, threads));
    Ok(())
}

/// Prints a row for each number of threads: 1, 2, 4 and so on to one a core.
fn measure(name: &str, cores: usize, pace: impl Fn(usize) -> Pace) {
    let counts = (0..).map(|power| 1 << power).take_while(|&threads| threads <= cores);
    let counts: Vec<usize> = counts.collect();
    let mut best = vec![Pace { steps_per_s: 0.0, processor_us: f64::MAX, waits: 0 }; counts.len()];
    // Numbers of threads take turns, so that a busy moment does not meet one of them alone.
    for _ in 0..REPEATS {
        for (best, &threads) in best.iter_mut().zip(&counts) {
            let pace = pace(threads);
            best.steps_per_s = best.steps_per_s.max(pace.steps_per_s);
            best.processor_us = best.processor_us.min(pace.processor_us);
            best.waits = best.waits.max(pace.waits);
        }
    }
    for (pace, &threads) in best.iter().zip(&counts) {
        let Pace { steps_per_s, processor_us, waits } = pace;
        #[allow(clippy::cast_precision_loss)]
        let efficiency = steps_per_s / (best[0].steps_per_s * threads as f64);
        println!(
            "| {name} | {threads} | {steps_per_s:.0} | {efficiency:.2} | {processor_us:.1} | {waits} |"
        );
    }
}

/// How quick one number of threads is.
#[derive(Clone, Copy)]
struct Pace {
    /// All threads' steps over the time that the slowest of them took.
    steps_per_s: f64,
    /// Processor time of a step, mean over the threads, us.
    processor_us: f64,
    /// Times that all threads together waited for something other than the processor.
    waits: u64,
}

#[allow(clippy::cast_precision_loss)]
fn pace<B: Bodies + Send>(ground: &Terrain, threads: usize) -> Pace {
    let drive = driving();
    let mut groups: Vec<Vec<Vehicle<B>>> =
        (0..threads).map(|_| (0..ENVIRONMENTS).map(|_| settled(ground)).collect()).collect();
    let work = |group: &mut Vec<Vehicle<B>>| {
        let (begun_us, begun_waits) = (processor_us(ClockId::ThreadCPUTime), waits());
        for _ in 0..STEPS {
            group.iter_mut().for_each(|vehicle| vehicle.step(&drive));
        }
        (processor_us(ClockId::ThreadCPUTime) - begun_us, waits() - begun_waits)
    };
    let begun = Instant::now();
    let (took_us, waits) = thread::scope(|scope| {
        let running: Vec<_> = groups.iter_mut().map(|group| scope.spawn(|| work(group))).collect();
        let ended = running.into_iter().map(|thread| thread.join().expect("a step does not panic"));
        ended.fold((0.0, 0), |sum, (us, waits)| (sum.0 + us, sum.1 + waits))
    });
    let steps = (threads * ENVIRONMENTS * STEPS) as f64;
    let steps_per_s = steps / begun.elapsed().as_secs_f64();
    Pace { steps_per_s, processor_us: took_us / steps, waits }
}

/// The same of a fleet. Its threads are the pool's, so what each of them had of
/// the processor, and waited, is taken together from what the process did.
#[allow(clippy::cast_precision_loss)]
fn fleet_pace<B: Bodies + Send>(ground: &Terrain, threads: usize) -> Pace {
    let drive = driving();
    let size = threads * OF_A_FLEET;
    let mut fleet: Fleet<B> = (0..size).map(|_| settled(ground)).collect();
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be made");
    let begun_us = processor_us(ClockId::ProcessCPUTime);
    let begun = Instant::now();
    let waits = pool.install(|| {
        (0..CALLS).for_each(|_| fleet.step(STEPS_A_CALL, |_, _| drive));
        pool.broadcast(|_| waits()).iter().sum()
    });
    let took_s = begun.elapsed().as_secs_f64();
    let steps = (size * CALLS) as f64 * f64::from(STEPS_A_CALL);
    let processor_us = (processor_us(ClockId::ProcessCPUTime) - begun_us) / steps;
    Pace { steps_per_s: steps / took_s, processor_us, waits }
}

fn driving() -> Actuation {
    Actuation { pump_displacement: [0.8; 2], ..Actuation::idle(1200.0) }
}

/// An environment that has stood for a second.
fn settled<B: Bodies>(ground: &Terrain) -> Vehicle<B> {
    let (machine, effects) = (Machine::xt28(), Effects::default());
    let step = Duration::from_secs_f64(1.0 / f64::from(RATE_HZ));
    let mut vehicle = Vehicle::with(&machine, &effects, ground, PerWheel::splat(0.17), step);
    (0..RATE_HZ).for_each(|_| vehicle.step(&Actuation::idle(1200.0)));
    vehicle
}

/// Times that this thread has given the processor up of its own accord; 0 where Linux does not tell.
fn waits() -> u64 {
    let status = std::fs::read_to_string("/proc/thread-self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("voluntary_ctxt_switches:"));
    line.and_then(|count| count.trim().parse().ok()).unwrap_or(0)
}

/// Time that this thread, or the process, has had of the processor, us.
#[allow(clippy::cast_precision_loss)]
fn processor_us(whose: ClockId) -> f64 {
    let now = clock_gettime(whose);
    now.tv_sec as f64 * 1e6 + now.tv_nsec as f64 / 1e3
}
