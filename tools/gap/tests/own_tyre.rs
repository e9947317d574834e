//! A machine whose file says other numbers than the built-in one is judged by its own: nothing is wrong with a tyre
//! that is as soft as its machine file says.

mod own_logs;

use xt28_gap::diagnosis::{Evidence, Hypothesis, Inquiry, Knob, Onset};
use xt28_machine::{Machine, Wheel};
use xt28_sim::Effects;

/// A tyre of a forwarder, as soft as it is, N/m.
const SOFT_N_M: f64 = 6.0e5;

#[test]
fn a_tolerance_of_a_soft_tyre_is_one_of_it() {
    let run = own_logs::run("arms", &Effects::default(), true);
    let mut machine = Machine::xt28();
    machine.vehicle.tyre_stiffness_n_m = SOFT_N_M;
    let inquiry = Inquiry::new(machine, vec![run]);
    let own = inquiry.believed.wheels[Wheel::Fr].soft_tyre.stiffness_n_m;
    assert!((own - SOFT_N_M).abs() < 1e-6, "{own}");
    // A hypothesis that changes nothing costs what the base does.
    let runs: Vec<_> = inquiry.runs.iter().map(|run| run.signals.clone()).collect();
    let tolerances = Knob::tolerances();
    let evidence = Evidence::new(&runs, &inquiry.machine, inquiry.believed.clone(), &tolerances);
    for hypothesis in Hypothesis::of(&inquiry.catalogue) {
        let neutral: Vec<f64> = hypothesis.effect.parameters.iter().map(|p| p.neutral).collect();
        let gain = hypothesis.gain(&evidence, Onset::ALWAYS, &neutral);
        assert!(gain.abs() < 1e-6, "{} {}: {gain}", hypothesis.effect.name, hypothesis.scope);
    }
}
