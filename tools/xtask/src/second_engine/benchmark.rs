//! What a step costs, and what it is worth: each engine's distance from its own finest run.

use super::engine::Engine;
use super::programs::{Job, Programs};
use super::trajectory::{KINDS, Trajectory};
use crate::workspace::Outcome;

/// Steps per second that are raced.
const RATES_HZ: [u32; 3] = [60, 120, 200];
/// Steps per second of the run that errors are taken against.
const FINEST_HZ: u32 = 2000;
/// Manoeuvre of the race: drives and steers.
const MANOEUVRE: &str = "rough";
/// A plane, the same level as a grid of triangles, and rough ground as a grid.
const TERRAINS: [&str; 3] = ["flat", "flat-grid", "rough"];

/// Prints a table for each terrain.
///
/// The engines take turns, so that whatever else the machine does meets all of them alike; times
/// are of the processor, not of the clock on the wall.
///
/// # Errors
/// When a side cannot be run.
pub(crate) fn print(programs: &Programs, engines: &[Engine], repeats: u32) -> Outcome<()> {
    for terrain in TERRAINS {
        let job = |rate_hz| Job { manoeuvre: MANOEUVRE, terrain, rate_hz, mujoco: &[] };
        let mut finest: Vec<Trajectory> = Vec::new();
        for &engine in engines {
            finest.push(programs.run(engine, &job(FINEST_HZ))?.trajectory);
        }
        println!(
            "\n{terrain}: median of {repeats}; errors against own {FINEST_HZ} Hz, max / RMSE\n"
        );
        println!(
            "| engine | Hz | us/step | steps/s | x real time | {} | {} | {} |",
            KINDS[0].name, KINDS[1].name, KINDS[4].name
        );
        println!("|---|---|---|---|---|---|---|---|");
        for rate_hz in RATES_HZ {
            let mut step_ns: Vec<Vec<f64>> = vec![Vec::new(); engines.len()];
            let mut last: Vec<Option<Trajectory>> = vec![None; engines.len()];
            for _ in 0..repeats {
                for (i, &engine) in engines.iter().enumerate() {
                    let run = programs.run(engine, &job(rate_hz))?;
                    step_ns[i].push(run.step_ns);
                    last[i] = Some(run.trajectory);
                }
            }
            for (i, &engine) in engines.iter().enumerate() {
                let ns = median(&mut step_ns[i]);
                let trajectory = last[i].as_ref().ok_or("no run")?;
                let errors = errors(trajectory, &finest[i])?;
                let (steps, factor) = (1e9 / ns, 1e9 / ns / f64::from(rate_hz));
                println!(
                    "| {} | {rate_hz} | {:.1} | {steps:.0} | {factor:.0} | {errors} |",
                    engine.name(),
                    ns / 1e3,
                );
            }
        }
    }
    Ok(())
}

fn errors(trajectory: &Trajectory, finest: &Trajectory) -> Outcome<String> {
    let mut cells = Vec::new();
    for kind in [&KINDS[0], &KINDS[1], &KINDS[4]] {
        let d = trajectory.distance(finest, kind)?;
        cells.push(format!("{:.3} / {:.3}", d.max, d.rmse));
    }
    Ok(cells.join(" | "))
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 { values[middle] } else { (values[middle - 1] + values[middle]) / 2.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_of_odd_and_even_counts() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&mut [4.0, 1.0, 3.0, 2.0]), 2.5);
    }
}
