//! Ground that leans as a whole: known, it is believed in as an effect of that size would be, and explains
//! how the machine stands.

mod made_up;

use std::io::{self, Write as _};
use std::path::Path;

use made_up::{series, signals, swinging};
use xt28_gap::diagnosis::{Generator, Residual, Signal, Signals};
use xt28_gap::{Channel, Decoder, FieldLog, Mapping, Replay, Terrain};
use xt28_machine::{Machine, Wheel};
use xt28_sim::effects::TerrainSlope;
use xt28_sim::terrain::Plane;
use xt28_sim::{Effects, Solver};

const RISE: [f64; 2] = [0.06, -0.04];

fn sloping() -> Terrain {
    Terrain::Plane(Plane { height_m: 0.0, rise: RISE })
}

#[test]
fn a_slope_that_is_known_is_one_that_is_believed_in() {
    let mut all = swinging();
    for w in Wheel::ALL {
        all.insert(Channel::WheelSpeed(w), series(|t| if t > 4.0 { 1.0 } else { 0.0 }));
    }
    all.insert(Channel::Heading, series(|_| 0.7));
    let machine = Machine::xt28();
    let [grade_x_rad, grade_y_rad] = RISE.map(f64::atan);
    let believed =
        Effects { slope: TerrainSlope { grade_x_rad, grade_y_rad }, ..Effects::default() };
    let [level] = signals(&all);
    let slope = Signals::of_series("made up", &all, level.duration_s(), sloping()).unwrap();
    for generator in [Generator::Stance, Generator::Drive, Generator::Travel] {
        let known = generator.residuals(&slope, &machine, &Effects::default());
        let other = generator.residuals(&level, &machine, &believed);
        for (known, other) in known.iter().zip(&other) {
            for (a, b) in known.values.iter().zip(&other.values) {
                let alike = (a - b).abs() < 1e-6 || (a.is_nan() && b.is_nan());
                assert!(alike, "{generator:?} {}: {a} {b}", known.signal);
            }
        }
    }
}

fn rms(residuals: &[Residual], signal: Signal) -> f64 {
    let of = residuals.iter().find(|residual| residual.signal == signal).expect("it is there");
    let finite: Vec<f64> = of.values.iter().copied().filter(|v| v.is_finite()).collect();
    assert!(finite.len() > 50, "{signal}: {} samples", finite.len());
    (finite.iter().map(|v| v * v).sum::<f64>() / finite.len() as f64).sqrt()
}

#[test]
#[allow(clippy::disallowed_macros)] // A test that skips says so.
fn a_machine_on_a_slope_that_is_known_stands_as_it_should() {
    let folder =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/field-data/aux/nominal");
    if !folder.exists() {
        let _ = writeln!(io::stdout(), "SKIPPED: {} is not there", folder.display());
        return;
    }
    let machine = Machine::xt28();
    let decoder = Decoder::load(&folder.join("xt28-field.dbc"), &Mapping::default()).unwrap();
    for name in ["run-1-arm_step.log.gz", "run-3-s_turn.log.gz"] {
        let log = FieldLog::load(&folder.join(name), &decoder, false).unwrap();
        let sound = Effects::default();
        let replay = Replay::run(&log, &machine, &sound, Solver::Reduced, &sloping()).unwrap();
        let mut all = replay.all_series().clone();
        let commands = log.all_series().iter().filter(|(channel, _)| channel.is_command());
        all.extend(commands.map(|(channel, samples)| (*channel, samples.clone())));
        // It begins to the east; from there wheels and joints tell how it heads.
        all.insert(Channel::Heading, [(0.0, 0.0)].into_iter().collect());
        let left = |ground| {
            let run = Signals::of_series("ours", &all, log.duration_s(), ground).unwrap();
            let residuals = Generator::Stance.residuals(&run, &machine, &sound);
            [Signal::Roll, Signal::Pitch].map(|signal| rms(&residuals, signal))
        };
        let (known, unknown) = (left(sloping()), left(Terrain::Flat));
        assert!(known.iter().all(|floors| *floors < 3.0), "{name}: {known:?}");
        assert!(unknown.iter().all(|floors| *floors > 10.0), "{name}: {unknown:?}");
    }
}
