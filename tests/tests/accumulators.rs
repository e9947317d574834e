//! The accumulators take the edge off a kerb: the same run with them, and with shut cylinders that
//! have nothing but their oil.
//!
//! `cargo test -p xt28-scenarios --test accumulators -- --nocapture` prints both.

use std::io::{self, Write};
use std::time::Duration;

use xt28_machine::{Machine, PerWheel};
use xt28_scenarios::{Lockstep, Scenario, Series, Setup};

/// Stiffness of a shut bore chamber without its accumulator, N/m: oil of 1.2 GPa on 78.5 cm2, in a
/// column of 0.17 m of stroke and 0.07 m of piping (assumed).
const OIL_ALONE_N_M: f64 = 1.2e9 * 0.00785 / 0.24;

/// The hardest knock of a run.
#[derive(Clone, Copy, Debug)]
struct Knock {
    /// Greatest force of the ground on a wheel that stands, before the run begins, kN.
    standing_kn: f64,
    /// Greatest force of the ground on a wheel, kN.
    ground_kn: f64,
    /// Greatest load of a cylinder as the bus says it, kN.
    cylinder_kn: f64,
}

fn up_the_kerb(lock_stiffness_n_m: f64) -> Knock {
    let mut setup = Setup::new(Scenario::find("kerb").unwrap(), None).unwrap();
    let mut machine: Machine = setup.machine;
    machine.hydraulics.lock_stiffness_n_m = lock_stiffness_n_m;
    setup.machine = machine;
    let mut run = Lockstep::new(&setup, io::sink()).unwrap();
    while run.tick(&mut || Duration::ZERO).unwrap().is_some() {}
    let recording = run.finish().unwrap();
    let (ground, load) = (recording.truth.unwrap().ground_force_n, recording.trace.cylinder_load_n);
    let greatest = |series: &Series<PerWheel<f64>>, from_s, to_s| {
        let all = series.between(from_s, to_s).iter().flat_map(|s| s.value.0);
        all.fold(0.0, f64::max) * 1e-3
    };
    Knock {
        standing_kn: greatest(&ground, 0.0, 0.5),
        ground_kn: greatest(&ground, 2.0, 18.0),
        cylinder_kn: greatest(&load, 2.0, 18.0),
    }
}

#[test]
fn the_accumulators_take_the_edge_off_a_kerb() {
    let with = up_the_kerb(Machine::xt28().hydraulics.lock_stiffness_n_m);
    let without = up_the_kerb(OIL_ALONE_N_M);
    writeln!(io::stderr(), "with {with:.1?}\nwithout {without:.1?}").unwrap();
    // The wheel itself hits the edge with nothing but its tyre; what lies above it is spared. The
    // cylinders are seen through the ECU's 1 Hz filter, which takes its own share of every knock.
    assert!(with.ground_kn < 0.80 * without.ground_kn, "{with:?} {without:?}");
    let above_standing_kn = |knock: &Knock| knock.ground_kn - knock.standing_kn;
    assert!(above_standing_kn(&with) < 0.5 * above_standing_kn(&without), "{with:?} {without:?}");
    assert!(with.cylinder_kn < 0.92 * without.cylinder_kn, "{with:?} {without:?}");
}
