//! A log that begins while the machine moves says of it what one that begins at rest does, but for its first seconds.

mod own_logs;

use own_logs::{SETTLE, read, text_of};
use xt28_gap::diagnosis::{FieldRun, Generator};
use xt28_machine::Machine;
use xt28_sim::Effects;

/// What of a run is not judged where it begins underway, residuals: five seconds.
const SETTLES: usize = 50;

/// A machine that goes ahead for 8 s, stands for 4 and goes back; in a log from `from_s` on.
fn driven(from_s: f64) -> FieldRun {
    let command = |tick: u64| {
        let s = tick.saturating_sub(SETTLE) as f64 * 0.01;
        let throttle_percent = match s {
            s if (1.0..8.0).contains(&s) => 60.0,
            s if (12.0..17.0).contains(&s) => -50.0,
            _ => 0.0,
        };
        ([170.0; 6], throttle_percent, 0.0)
    };
    let whole = text_of(&command, 2_000, &Effects::default());
    let stamp_s = |line: &&str| line[1..].split(')').next().unwrap().parse::<f64>().unwrap();
    // The first frame of a log made up is of 1 s.
    let kept: String =
        whole.lines().filter(|l| stamp_s(l) >= 1.0 + from_s).map(|l| format!("{l}\n")).collect();
    read("straight", &kept, true)
}

/// The largest residual, in floors, and how many are judged of the first and of the other ones.
fn judged(run: &FieldRun) -> (f64, [usize; 2]) {
    let (machine, effects) = (Machine::xt28(), Effects::default());
    let (mut most, mut counts) = (0.0_f64, [0; 2]);
    for generator in Generator::all().into_iter().filter(|of| *of != Generator::Bus) {
        for residual in generator.residuals(&run.signals, &machine, &effects) {
            for (k, value) in residual.values.iter().enumerate().filter(|(_, v)| v.is_finite()) {
                most = most.max(value.abs());
                counts[usize::from(k >= SETTLES)] += 1;
            }
        }
    }
    (most, counts)
}

#[test]
fn what_was_before_a_log_is_not_laid_to_the_machine() {
    let (whole, counts) = judged(&driven(0.0));
    assert!(whole < 6.0 && counts.iter().all(|count| *count > 500), "{whole} {counts:?}");
    // In full drive, as it brakes, and as it goes back.
    for from_s in [4.0, 8.1, 8.6, 12.5] {
        let (most, [first, others]) = judged(&driven(from_s));
        assert!(most < 1.1 * whole, "{most} of a log from {from_s} s on, {whole} of all of it");
        assert!(first == 0 && others > 500, "{from_s}: {first} {others}");
    }
}
