//! What nobody looked at has not been seen to hold: windows that a log covers in part, and readings that are none.

use std::io;
use std::path::Path;

use xt28_machine::{Machine, PerWheel};
use xt28_scenarios::trace::{Attitude, Motion};
use xt28_scenarios::{Evidence, Finding, Scenario, Trace, Truth};

fn scenario(toml: &str) -> Scenario {
    let text = format!("title = \"t\"\npolicy = \"hold\"\nduration_s = 10\n[[expect]]\n{toml}\n");
    let none = |_: &Path| Err(io::ErrorKind::NotFound.into());
    Scenario::parse(&text, Path::new("t.toml"), none).expect("a good scenario")
}

/// Whether the one expectation `toml` holds of all that it judges.
fn holds(toml: &str, trace: &Trace, truth: Option<&Truth>) -> bool {
    let (scenario, machine) = (scenario(toml), Machine::xt28());
    let evidence =
        Evidence { scenario: &scenario, machine: &machine, payload_kg: 0.0, trace, truth };
    let findings = scenario.expectations[0].judge(&evidence);
    assert!(!findings.is_empty());
    findings.iter().all(Finding::passed)
}

/// A level machine that stands and weighs what it should, heard of where `heard` says so; a run of ten seconds.
fn standing(heard: impl Fn(f64) -> bool) -> (Trace, Truth) {
    let machine = Machine::xt28();
    let m = &machine.masses;
    let frames_kg = m.front_frame_kg + m.middle_frame_kg + m.rear_frame_kg;
    let sprung_n = (frames_kg + 3.0 * m.arm_kg) * xt28_machine::GRAVITY_M_S2;
    let load_n = sprung_n / 6.0 / machine.linkage().at_stroke(0.25).force_ratio;
    let wheel_n = machine.mass_kg() * xt28_machine::GRAVITY_M_S2 / 6.0;
    let (mut trace, mut truth) = (Trace::default(), Truth::default());
    for at_s in (0..=1000).map(|tick| f64::from(tick) * 0.01) {
        trace.end_s = at_s;
        trace.antenna_m.push(at_s, [1.0, 2.0]);
        if heard(at_s) {
            trace.stroke_m.push(at_s, PerWheel::splat(0.25));
            trace.cylinder_load_n.push(at_s, PerWheel::splat(load_n));
            trace.attitude.push(at_s, Attitude::default());
            trace.motion.push(at_s, Motion::default());
            trace.wheel_speed_rad_s.push(at_s, PerWheel::splat(0.0));
            truth.ground_force_n.push(at_s, PerWheel::splat(wheel_n));
            truth.chassis_force_n.push(at_s, 0.0);
        }
    }
    (trace, truth)
}

const WINDOWED: [&str; 12] = [
    "stays-level = { from_s = 2, to_s = 8, roll_deg = 1, pitch_deg = 1 }",
    "leans = { from_s = 2, to_s = 8, roll_deg = 0, within_deg = 1 }",
    "holds-still = { from_s = 2, to_s = 8, within_mm = 1 }",
    "peak-load = { from_s = 2, to_s = 8, from_kn = 1, to_kn = 900 }",
    "carries-weight = { from_s = 2, to_s = 8, within_percent = 2 }",
    "even-ground-pressure = { from_s = 2, to_s = 8, below = 0.1 }",
    "clears-ground = { from_s = 2, to_s = 8 }",
    "unsupported = { wheels = [\"FR\"], from_s = 2, to_s = 8, within_kn = 99 }",
    "stands-still = { below_m_s = 0.02, over_s = 8 }",
    "strokes = { wheels = [\"FR\"], from_s = 2, to_s = 8, from_mm = 249, to_mm = 251 }",
    "strokes-apart = { from_s = 2, to_s = 8, from_mm = 0, to_mm = 1 }",
    "drives = { from_s = 2, to_s = 8, from_m_s = 0, to_m_s = 0.1 }",
];

#[test]
fn a_window_that_was_looked_at_in_part_does_not_hold() {
    let (trace, truth) = standing(|_| true);
    for toml in WINDOWED {
        assert!(holds(toml, &trace, Some(&truth)), "{toml}");
    }
    let silences: [fn(f64) -> bool; 3] =
        [|at_s| at_s < 7.0, |at_s| at_s > 3.0, |at_s| !(4.0..6.0).contains(&at_s)];
    for heard in silences {
        let (trace, truth) = standing(heard);
        for toml in WINDOWED {
            assert!(!holds(toml, &trace, Some(&truth)), "{toml}");
        }
    }
    // Frames that were lost here and there are no silence.
    let (trace, truth) = standing(|at_s| (at_s * 4.0).fract() < 0.3);
    for toml in WINDOWED {
        assert!(holds(toml, &trace, Some(&truth)), "{toml}");
    }
}

#[test]
fn the_truth_alone_is_asked_for_the_whole_window_too() {
    let (trace, _) = standing(|_| true);
    let (_, truth) = standing(|at_s| at_s < 5.0);
    for toml in &WINDOWED[4..8] {
        assert!(holds(toml, &trace, None) || toml.starts_with("clears-ground"), "{toml}");
        assert!(!holds(toml, &trace, Some(&truth)), "{toml}");
    }
}

#[test]
fn a_roll_is_looked_at_all_through_the_run() {
    let toml = "roll-peak = { from_deg = 0, to_deg = 1, end_within_deg = 1 }";
    assert!(holds(toml, &standing(|_| true).0, None));
    assert!(!holds(toml, &standing(|at_s| at_s < 9.0).0, None), "nobody saw its end");
    assert!(!holds(toml, &standing(|at_s| !(3.0..4.0).contains(&at_s)).0, None));
}

#[test]
fn a_plant_that_lost_its_figures_has_cleared_nothing() {
    let (trace, whole) = standing(|_| true);
    for lost in [0, 500, 1000] {
        let mut truth = Truth::default();
        for (at, sample) in whole.chassis_force_n.samples().iter().enumerate() {
            truth.chassis_force_n.push(sample.at_s, if at == lost { f64::NAN } else { 0.0 });
        }
        let toml = "clears-ground = { from_s = 0, to_s = 10, at_most_kn = 5 }";
        assert!(!holds(toml, &trace, Some(&truth)), "{lost}");
    }
}

#[test]
fn one_fix_shows_no_drift() {
    let (mut trace, _) = standing(|_| true);
    let toml = "stands-still = { below_m_s = 0.02, over_s = 0.2 }";
    trace.antenna_m = Default::default();
    trace.antenna_m.push(9.9, [1.0, 2.0]);
    assert!(!holds(toml, &trace, None));
    trace.antenna_m.push(10.0, [1.0, 2.0]);
    assert!(holds(toml, &trace, None));
}

#[test]
fn a_log_without_a_frame_covers_no_run() {
    let mut scenario = scenario("holds-still = { from_s = 0, to_s = 1, within_mm = 1 }");
    scenario.expectations.clear();
    scenario.duration_s = 0.4;
    let (machine, mut trace) = (Machine::xt28(), Trace::default());
    let passed = |trace: &Trace| {
        let evidence = Evidence {
            scenario: &scenario,
            machine: &machine,
            payload_kg: 0.0,
            trace,
            truth: None,
        };
        xt28_scenarios::expect::judge(&evidence).iter().all(Finding::passed)
    };
    assert!(!passed(&trace));
    trace.frames = 1;
    assert!(passed(&trace));
}
