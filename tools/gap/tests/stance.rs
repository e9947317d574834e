//! What shows in how a machine stands: put into our own plant, named again from its logs with place and
//! size, by the stance alone.

use std::io::{self, Write as _};
use std::path::Path;

use xt28_gap::diagnosis::{Evidence, Fit, Generator, Knob, Signals, search};
use xt28_gap::{About, Decoder, FieldLog, Mapping, Replay};
use xt28_machine::Machine;
use xt28_sim::effects::{CATALOGUE, Effect, Overlay, Scope};
use xt28_sim::{Effects, Solver};

/// Best fits by the stance alone on our plant's answer to a field log's commands, with `overlay` in it;
/// none where the logs are not there.
#[allow(clippy::disallowed_macros)] // A test that skips says so.
fn fits(overlay: &str, runs: &[&str]) -> Option<Vec<Fit>> {
    let folder =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/field-data/aux/nominal");
    if !folder.exists() {
        let _ = writeln!(io::stdout(), "SKIPPED: {} is not there", folder.display());
        return None;
    }
    let effects =
        Overlay::parse(overlay, Path::new("test")).unwrap().effects(&Machine::xt28()).unwrap();
    let machine = Machine::xt28();
    let decoder = Decoder::load(&folder.join("xt28-field.dbc"), &Mapping::default()).unwrap();
    let answer = |name: &&str| {
        let path = folder.join(name);
        let log = FieldLog::load(&path, &decoder, false).unwrap();
        let terrain = About::terrain_of(&folder.join("about.toml"), &path).unwrap();
        let replay = Replay::run(&log, &machine, &effects, Solver::Reduced, &terrain).unwrap();
        let mut series = replay.all_series().clone();
        let commands = log.all_series().iter().filter(|(channel, _)| channel.is_command());
        series.extend(commands.map(|(channel, samples)| (*channel, samples.clone())));
        Signals::of_series("ours", &series, log.duration_s(), terrain).unwrap()
    };
    let runs: Vec<Signals> = runs.iter().map(answer).collect();
    let stance = vec![Generator::Stance];
    let evidence = Evidence::watching(stance, &runs, &machine, Effects::default(), &Knob::all());
    let heard = |effect: &&'static Effect| {
        Scope::ALL.iter().any(|scope| Generator::Stance.hears(effect, *scope))
    };
    let candidates: Vec<&'static Effect> = CATALOGUE.iter().filter(heard).collect();
    Some(search(&evidence, &candidates))
}

const STANDING: [&str; 2] = ["run-1-arm_step.log.gz", "run-2-multisine.log.gz"];

/// The best fit must be of this name and scope, its first value within a share of the true one.
fn assert_found(name: &str, scope: &str, parameter: &str, value: f64, share: f64) {
    let place = if scope.is_empty() { String::new() } else { format!("scope = \"{scope}\"\n") };
    let overlay = format!("[[effect]]\nname = \"{name}\"\n{place}{parameter} = {value:e}");
    let Some(fits) = fits(&overlay, &STANDING) else { return };
    let best = fits.first().expect("something explains it");
    let place = if scope.is_empty() { "all" } else { scope };
    assert_eq!(
        (best.hypothesis.effect.name, best.hypothesis.scope.to_string().as_str()),
        (name, place),
        "{fits:?}"
    );
    assert!(best.log_evidence > 10.0, "{name}: {}", best.log_evidence);
    assert!((best.values[0] / value - 1.0).abs() < share, "{name}: {:?}", best.values);
}

#[test]
fn a_load_in_the_bunk_is_found() {
    assert_found("payload", "", "mass_kg", 4000.0, 0.1);
}

#[test]
fn one_soft_tyre_is_found() {
    assert_found("soft-tyres", "ML", "stiffness_n_m", 5.0e5, 0.15);
}

#[test]
fn misread_strokes_of_an_axle_are_found() {
    assert_found("stroke-bias", "rear", "bias_m", 0.012, 0.1);
}

#[test]
fn a_bent_bracket_of_the_inertial_unit_is_found() {
    assert_found("imu-offset", "", "roll_rad", 0.03, 0.15);
}

#[test]
fn misread_pressures_of_an_axle_are_found() {
    assert_found("pressure-bias", "middle", "bias_pa", 8.0e5, 0.2);
}

#[test]
fn nothing_is_found_where_nothing_is_wrong() {
    let Some(fits) = fits("effect = []", &STANDING) else { return };
    for fit in &fits {
        assert!(fit.log_evidence < 6.0, "{fit:?}");
    }
}
