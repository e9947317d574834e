//! Diagnosis on logs of a second plant, and on what our own plant does with an effect put in.

use std::collections::BTreeMap;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use xt28_gap::diagnosis::{Evidence, Generator, Hypothesis, Knob, Signals, search};
use xt28_gap::{About, Channel, Decoder, FieldLog, Mapping, Replay, Series, Terrain};
use xt28_machine::{Machine, Wheel};
use xt28_sim::effects::{CATALOGUE, Overlay, Scope};
use xt28_sim::{Effects, Solver};

#[allow(clippy::disallowed_macros)] // A test that skips says so.
fn field_data() -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/field-data");
    if !path.exists() {
        let _ = writeln!(io::stdout(), "SKIPPED: {} is not there", path.display());
        return None;
    }
    Some(path)
}

fn log(folder: &Path, name: &str) -> (FieldLog, Terrain) {
    let decoder = Decoder::load(&folder.join("xt28-field.dbc"), &Mapping::default()).unwrap();
    let path = folder.join(name);
    let about = folder.join("about.toml");
    let terrain =
        if about.exists() { About::terrain_of(&about, &path).unwrap() } else { Terrain::Flat };
    (FieldLog::load(&path, &decoder, false).unwrap(), terrain)
}

fn gaps(folder: &Path, names: &[&str]) -> Vec<(Generator, Option<f64>)> {
    let runs: Vec<Signals> = names
        .iter()
        .map(|name| {
            let (log, terrain) = log(folder, name);
            Signals::new(&log, terrain).unwrap()
        })
        .collect();
    let evidence = Evidence::new(&runs, &Machine::xt28(), Effects::default(), &Knob::tolerances());
    evidence.gaps()
}

#[test]
fn a_sound_machine_leaves_nothing_to_explain() {
    let Some(data) = field_data() else { return };
    let names = ["run-1-arm_step.log.gz", "run-3-s_turn.log.gz", "run-4-straight.log.gz"];
    for (generator, gap) in gaps(&data.join("dev/dev-05"), &names) {
        assert!(gap.is_none_or(|gap| gap < 3.2), "{generator}: {gap:?}");
    }
}

/// One machine of the set has leaking front arms, as its answer says.
#[test]
fn leaking_front_arms_show_on_the_front_arms() {
    let Some(data) = field_data() else { return };
    let gaps = gaps(&data.join("dev/dev-01"), &["run-1-arm_step.log.gz"]);
    let of = |wheel| {
        let found = gaps.iter().find(|(generator, _)| *generator == Generator::ArmStroke(wheel));
        found.and_then(|(_, gap)| *gap).expect("every arm is watched")
    };
    for leaking in [Wheel::Fr, Wheel::Fl] {
        for sound in [Wheel::Mr, Wheel::Ml, Wheel::Br, Wheel::Bl] {
            assert!(of(leaking) > 4.5 * of(sound), "{leaking} {sound}: {gaps:?}");
        }
    }
}

/// The commands of a field log on our own plant with an effect: the fit must find its size.
fn fitted(effect: &str, scope: Scope, run: &str, overlay: &str) -> Option<(f64, Vec<f64>)> {
    fitted_after(effect, scope, run, overlay, |_| ())
}

/// The same on what is left of a log after `spoil`.
fn fitted_after(
    effect: &str,
    scope: Scope,
    run: &str,
    overlay: &str,
    spoil: impl Fn(&mut BTreeMap<Channel, Series>),
) -> Option<(f64, Vec<f64>)> {
    let folder = field_data()?.join("aux/nominal");
    let (log, terrain) = log(&folder, run);
    let overlay = Overlay::parse(overlay, Path::new("test")).unwrap();
    let machine = Machine::xt28();
    let replay =
        Replay::run(&log, &machine, &overlay.effects(&machine).unwrap(), Solver::Rapier, &terrain)
            .unwrap();
    let mut series = replay.all_series().clone();
    for (channel, samples) in log.all_series() {
        if channel.is_command() {
            series.insert(*channel, samples.clone());
        }
    }
    spoil(&mut series);
    let signals = Signals::of_series("ours", &series, log.duration_s(), terrain).unwrap();
    let runs = [signals];
    let evidence = Evidence::new(&runs, &machine, Effects::default(), &Knob::all());
    let fits = search(&evidence, &CATALOGUE.iter().collect::<Vec<_>>());
    let best = fits.first().expect("something explains it");
    let Hypothesis { effect: found, scope: place } = best.hypothesis;
    assert_eq!((found.name, place), (effect, scope));
    Some((best.log_evidence, best.values.clone()))
}

/// The same where the evidence is more than `nats`, and each value as near to what was put in as is said.
fn finds(effect: &str, scope: Scope, run: &str, overlay: &str, nats: f64, sizes: &[[f64; 2]]) {
    let Some((evidence, values)) = fitted(effect, scope, run, overlay) else { return };
    assert!(evidence > nats, "{evidence}");
    for (value, [put_in, within]) in values.iter().zip(sizes) {
        assert!((value - put_in).abs() < *within, "{values:?}");
    }
}

#[test]
fn a_delay_put_into_our_plant_is_found_with_its_size() {
    let overlay = "[[effect]]\nname = \"arm-delay\"\nscope = \"front\"\ndelay_s = 0.2";
    let front = Scope::Axle(xt28_machine::Axle::Front);
    finds("arm-delay", front, "run-1-arm_step.log.gz", overlay, 20.0, &[[0.2, 0.04]]);
}

#[test]
fn a_late_throttle_put_into_our_plant_is_found_with_its_size() {
    let overlay = "[[effect]]\nname = \"throttle-delay\"\ndelay_s = 0.3";
    finds("throttle-delay", Scope::All, "run-4-straight.log.gz", overlay, 20.0, &[[0.3, 0.06]]);
}

#[test]
fn late_steering_is_told_from_slow_steering() {
    let overlay = "[[effect]]\nname = \"steer-delay\"\ndelay_s = 0.3";
    finds("steer-delay", Scope::All, "run-3-s_turn.log.gz", overlay, 20.0, &[[0.3, 0.06]]);
}

#[test]
fn a_weak_and_late_follower_is_found_in_the_rear_controller() {
    let overlay = "[[effect]]\nname = \"rear-follower-lag\"\ntime_constant_s = 0.8\n\
                   ratio_factor = 0.75";
    let sizes = [[0.8, 0.1], [0.75, 0.03]];
    finds("rear-follower-lag", Scope::All, "run-3-s_turn.log.gz", overlay, 20.0, &sizes);
}

#[test]
fn the_wheel_that_misreads_is_told_by_the_others() {
    let middle_right = Scope::Wheel(Wheel::Mr);
    let overlay = "[[effect]]\nname = \"wheel-speed-scale\"\nscope = \"MR\"\nfactor = 0.93";
    let run = "run-4-straight.log.gz";
    finds("wheel-speed-scale", middle_right, run, overlay, 10.0, &[[0.93, 0.015]]);
}

/// At rest rolling resistance holds a part of what the pumps would have to.
#[test]
fn a_slope_under_a_machine_that_stands_is_found_with_its_size() {
    let overlay = "[[effect]]\nname = \"terrain-slope\"\ngrade_x_rad = 0.03\n\
                   grade_y_rad = 0.02";
    let sizes = [[0.03, 0.004], [0.02, 0.004]];
    finds("terrain-slope", Scope::All, "run-1-arm_step.log.gz", overlay, 10.0, &sizes);
}

fn random_bools(len: usize, share: f64) -> Vec<bool> {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    (0..len).map(|_| random.random_bool(share)).collect()
}

/// Commands that are not in the log did not reach the ECUs.
#[test]
fn lost_commands_are_counted_and_taken_for_nothing_else() {
    let lose = |series: &mut BTreeMap<Channel, Series>| {
        // Signals of one frame are lost together.
        let lost = random_bools(8192, 0.08);
        for (channel, samples) in series {
            if channel.is_command() {
                let kept = samples.iter().zip(&lost).filter(|(_, lost)| !**lost);
                *samples = kept.map(|(sample, _)| sample).collect();
            }
        }
    };
    let run = "run-1-arm_step.log.gz";
    let Some((evidence, values)) = fitted_after("frame-loss", Scope::All, run, "effect = []", lose)
    else {
        return;
    };
    assert!(evidence > 50.0, "{evidence}");
    // Of 3200 commands chance loses half a per cent more or less.
    assert!((values[0] - 0.08).abs() < 0.015, "{values:?}");
}
