//! Six arms under three stiff frames can carry a weight in many ways: the ground-pressure controller
//! keeps them from drifting into an uneven one.
//!
//! `cargo test -p xt28-scenarios --test load_split -- --nocapture` prints both runs.

use std::io::{self, Write};
use std::time::Duration;

use xt28_machine::{Levelling, Machine, PerWheel};
use xt28_scenarios::{Lockstep, Scenario, Setup};

/// What a run over the ramp in mode automatic shows.
#[derive(Debug)]
struct Run {
    /// Deviation of the wheels' true forces over their sum, mean from 10 to 63 s.
    on_the_way: f64,
    /// The same from 62 to 63 s, standing behind the ramp.
    behind: f64,
    /// Greatest roll, deg.
    roll_deg: f64,
}

/// With the weights of height, roll, pitch and ground pressure.
fn over_the_ramp(weights: [f64; 4]) -> Run {
    let mut setup = Setup::new(Scenario::find("ramp-automatic").unwrap(), None).unwrap();
    let levelling = Levelling { weights, ..setup.machine.levelling.clone() };
    setup.machine = Machine { levelling, ..setup.machine };
    let mut run = Lockstep::new(&setup, io::sink()).unwrap();
    while run.tick(&mut || Duration::ZERO).unwrap().is_some() {}
    let recording = run.finish().unwrap();
    let forces = recording.truth.unwrap().ground_force_n;
    let mean = |from_s: f64| {
        let samples = forces.between(from_s, 63.0);
        samples.iter().map(|s| deviation(&s.value)).sum::<f64>() / samples.len() as f64
    };
    let rolls = recording.trace.attitude.samples().iter().map(|s| s.value.roll_rad.abs());
    let roll_deg = rolls.fold(0.0, f64::max).to_degrees();
    Run { on_the_way: mean(10.0), behind: mean(62.0), roll_deg }
}

fn deviation(force_n: &PerWheel<f64>) -> f64 {
    let share = force_n.map(|n| n / force_n.sum());
    share.map(|s| (s - share.mean()).powi(2)).mean().sqrt()
}

#[test]
fn ground_pressure_control_keeps_the_load_together_and_levelling_alone_does_not() {
    let with = over_the_ramp([1.0; 4]);
    let without = over_the_ramp([1.0, 1.0, 1.0, 0.0]);
    writeln!(io::stderr(), "with {with:.3?}\nwithout {without:.3?}").unwrap();
    // Level both times: the split cannot be seen from the chassis.
    assert!(with.roll_deg < 1.0 && without.roll_deg < 4.0, "{with:?} {without:?}");
    // 0.080 is what the empty machine's centre of mass allows.
    assert!(with.on_the_way < 0.10 && with.behind < 0.085, "{with:?}");
    assert!(without.on_the_way > 1.2 * with.on_the_way, "{with:?} {without:?}");
    assert!(without.behind > with.behind, "{with:?} {without:?}");
}
