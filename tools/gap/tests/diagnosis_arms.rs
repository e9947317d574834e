//! The arms' residuals: silent on a sound machine of another make, telling on our own with a fault.

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use xt28_gap::diagnosis::{
    Belief, Evidence, Fit, Generator, Hypothesis, Knob, Onset, Signals, search,
};
use xt28_gap::{About, Channel, Decoder, FieldLog, Mapping, Replay, Series, Terrain};
use xt28_machine::{Axle, Machine, Wheel};
use xt28_sim::effects::{Effect, Overlay, Scope, find};
use xt28_sim::{Effects, Solver};

#[allow(clippy::disallowed_macros)] // A test that skips says so.
fn nominal() -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/field-data/aux/nominal");
    if !path.exists() {
        let _ = writeln!(io::stdout(), "SKIPPED: {} is not there", path.display());
        return None;
    }
    Some(path)
}

fn log(name: &str) -> Option<(FieldLog, Terrain)> {
    let folder = nominal()?;
    let decoder = Decoder::load(&folder.join("xt28-field.dbc"), &Mapping::default()).unwrap();
    let path = folder.join(name);
    let terrain = About::terrain_of(&folder.join("about.toml"), &path).unwrap();
    Some((FieldLog::load(&path, &decoder, false).unwrap(), terrain))
}

fn signals(name: &str) -> Option<Signals> {
    let (log, terrain) = log(name)?;
    Some(Signals::new(&log, terrain).unwrap())
}

fn rms(generator: Generator, signals: &Signals) -> f64 {
    let residual = &generator.residuals(signals, &Machine::xt28(), &Effects::default())[0].values;
    let heard: Vec<f64> = residual.iter().copied().filter(|r| r.is_finite()).collect();
    (heard.iter().map(|r| r * r).sum::<f64>() / heard.len() as f64).sqrt()
}

#[test]
fn arms_of_a_sound_machine_of_another_make_leave_less_than_a_floor() {
    for run in ["run-1-arm_step.log.gz", "run-2-multisine.log.gz", "run-5-ramp.log.gz"] {
        let Some(signals) = signals(run) else { return };
        for wheel in Wheel::ALL {
            let stroke = rms(Generator::ArmStroke(wheel), &signals);
            assert!((0.1..1.0).contains(&stroke), "{run} {wheel}: {stroke}");
            // The position PI is known to the milliampere.
            let opening = rms(Generator::ArmEcu(wheel), &signals);
            assert!(opening < 0.01, "{run} {wheel}: {opening}");
        }
    }
}

#[test]
fn a_load_read_twenty_times_a_second_is_compared_when_it_is_read() {
    let Some((log, terrain)) = log("run-1-arm_step.log.gz") else { return };
    let mut series = log.all_series().clone();
    let of_chamber = |c: &Channel| matches!(c, Channel::BorePressure(_) | Channel::RodPressure(_));
    series.retain(|channel, _| !of_chamber(channel));
    let signals = Signals::of_series("held", &series, log.duration_s(), terrain).unwrap();
    assert!(signals.chamber_pa.iter().all(|(_, [bore, rod])| bore.is_empty() && rod.is_empty()));
    for wheel in Wheel::ALL {
        let stroke = rms(Generator::ArmStroke(wheel), &signals);
        assert!(stroke < 1.5, "{wheel}: {stroke}");
    }
}

/// Fits of `rivals` at every scope to our machine with `overlay` on the commands of a field log; best
/// first.
fn ranked(run: &str, overlay: &str, rivals: &[&str]) -> Option<Vec<Fit>> {
    let (log, terrain) = log(run)?;
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
    let runs = [Signals::of_series("ours", &series, log.duration_s(), terrain).unwrap()];
    let evidence = Evidence::new(&runs, &machine, Effects::default(), &Knob::all());
    let rivals: Vec<&Effect> = rivals.iter().map(|name| find(name).unwrap()).collect();
    Some(search(&evidence, &rivals))
}

fn assert_first(fits: &[Fit], effect: &str, scope: Scope, near: f64, within: f64) {
    let first = &fits[0];
    let found = (first.hypothesis.effect.name, first.hypothesis.scope);
    assert_eq!(found, (find(effect).unwrap().name, scope), "{:?}", &fits[..2]);
    assert!(first.log_evidence > 20.0, "{first:?}");
    assert!((first.values[0] - near).abs() < within, "{first:?}");
}

const FRONT: Scope = Scope::Axle(Axle::Front);

#[test]
fn a_leak_is_no_gain_and_no_deadband() {
    let overlay = "[[effect]]\nname = \"leakage-drift\"\nscope = \"front\"\nrate_m_s = 0.008";
    let rivals = ["leakage-drift", "valve-gain", "valve-deadband"];
    let Some(fits) = ranked("run-1-arm_step.log.gz", overlay, &rivals) else { return };
    assert_first(&fits, "leakage-drift", FRONT, 0.008, 0.0008);
}

#[test]
fn a_lag_is_no_delay_and_no_play() {
    let overlay = "[[effect]]\nname = \"valve-lag\"\nscope = \"FR\"\ntime_constant_s = 0.2";
    let rivals = ["valve-lag", "arm-delay", "valve-hysteresis"];
    let Some(fits) = ranked("run-2-multisine.log.gz", overlay, &rivals) else { return };
    assert_first(&fits, "valve-lag", Scope::Wheel(Wheel::Fr), 0.2, 0.03);
}

#[test]
fn a_short_pump_is_no_gain_and_no_lag() {
    let overlay = "[[effect]]\nname = \"pump-flow-limit\"\nflow_m3_s = 0.0008";
    let rivals = ["pump-flow-limit", "valve-gain", "valve-lag"];
    let Some(fits) = ranked("run-1-arm_step.log.gz", overlay, &rivals) else { return };
    assert_first(&fits, "pump-flow-limit", Scope::All, 0.0008, 0.0001);
}

#[test]
fn another_gain_of_the_position_control_shows_on_the_ecu_alone() {
    let overlay = "[[effect]]\nname = \"arm-gain\"\nscope = \"front\"\nkp_factor = 1.3";
    let rivals = ["arm-gain", "valve-gain", "arm-delay"];
    let Some(fits) = ranked("run-2-multisine.log.gz", overlay, &rivals) else { return };
    assert_first(&fits, "arm-gain", FRONT, 1.3, 0.03);
}

/// A field log whose pressure sensor on the left middle arm reads `bias_pa` too much from `from_s` on,
/// through the ECU's filter; a frame holds no pressure below none.
fn biased(run: &str, bias_pa: f64, from_s: f64) -> Option<Signals> {
    let (log, terrain) = log(run)?;
    let mut series = log.all_series().clone();
    let sound = &series[&Channel::BorePressure(Wheel::Ml)];
    let mut read = Series::default();
    for (at_s, pa) in sound.iter() {
        let share = 1.0 - (-(at_s - from_s).max(0.0) / 0.164).exp();
        read.push(at_s, (pa + share * bias_pa).max(0.0));
    }
    series.insert(Channel::BorePressure(Wheel::Ml), read);
    Some(Signals::of_series("biased", &series, log.duration_s(), terrain).unwrap())
}

/// Bias of the left middle sensor from `from_s` on that explains `signals` best, Pa, and what the arm's
/// stroke then leaves, in floors.
fn found_bias(signals: Signals, from_s: f64) -> (f64, f64) {
    let (runs, machine) = ([signals], Machine::xt28());
    let generators = vec![Generator::ArmStroke(Wheel::Ml), Generator::Stance];
    let none = Effects::default();
    let evidence = Evidence::watching(generators, &runs, &machine, none, &Knob::tolerances());
    let effect = find("pressure-bias").unwrap();
    let hypothesis = Hypothesis { effect, scope: Scope::Wheel(Wheel::Ml) };
    let onset = Onset::in_every_run(from_s);
    let fit = hypothesis.refit(&evidence, onset, &[-1.0e5]);
    let effects = hypothesis.applied(&Effects::default(), &fit.values);
    let left = evidence.left(Belief { onset, ..(&effects).into() });
    (fit.values[0], left[0].square.sqrt())
}

#[test]
fn a_pressure_that_jumps_is_followed() {
    let Some(signals) = biased("run-3-s_turn.log.gz", -8.0e5, 12.0) else { return };
    let (bias_pa, left) = found_bias(signals, 12.0);
    // Frames that weigh otherwise take a part of it.
    assert!((bias_pa + 8.0e5).abs() < 1.6e5, "{bias_pa}");
    assert!(left < 1.0, "{left}");
}

#[test]
fn a_pressure_at_the_end_of_its_scale_says_nothing() {
    // The middle arms hang in this run: 0.36 MPa less 0.8 MPa is no pressure that a frame can hold.
    let Some(signals) = biased("run-1-arm_step.log.gz", -8.0e5, 0.0) else { return };
    let clipped = signals.chamber_pa[Wheel::Ml][0].iter().filter(|pa| **pa <= 0.0).count();
    assert!(clipped > 100, "{clipped}");
    let (bias_pa, _) = found_bias(signals, 0.0);
    // As a zero it would be a bias of -0.36 MPa.
    assert!(bias_pa.abs() < 1.0e5, "{bias_pa}");
}
