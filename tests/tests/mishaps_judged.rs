//! Expectations on what goes wrong: traces that hold, and the nearest ones that do not.

use std::io;
use std::path::Path;

use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_scenarios::trace::{Attitude, EcuState, Motion};
use xt28_scenarios::{Evidence, Finding, Scenario, Trace, Trouble};

/// Whether the one expectation `toml`, which makes one finding, holds of `trace`.
fn holds(toml: &str, trace: &Trace) -> bool {
    let findings = judged(toml, trace);
    assert_eq!(findings.len(), 1);
    findings.iter().all(Finding::passed)
}

/// The same of one that makes two.
fn hold(toml: &str, trace: &Trace) -> bool {
    let findings = judged(toml, trace);
    assert_eq!(findings.len(), 2);
    findings.iter().all(Finding::passed)
}

fn judged(toml: &str, trace: &Trace) -> Vec<Finding> {
    let text = format!("title = \"t\"\npolicy = \"hold\"\nduration_s = 10\n[[expect]]\n{toml}\n");
    let none = |_: &Path| Err(io::ErrorKind::NotFound.into());
    let scenario = Scenario::parse(&text, Path::new("t.toml"), none).expect("a good scenario");
    let machine = Machine::xt28();
    let evidence =
        Evidence { scenario: &scenario, machine: &machine, payload_kg: 0.0, trace, truth: None };
    scenario.expectations[0].judge(&evidence)
}

fn passing(states: &[EcuState]) -> Trace {
    let mut trace = Trace::default();
    for (i, state) in (0..).zip(states) {
        trace.arm_state.push(f64::from(i), *state);
        trace.arm_state.push(f64::from(i) + 0.5, *state);
    }
    trace
}

#[test]
fn states_are_passed_in_their_order_and_no_others() {
    use EcuState::{Active, Fault, Init, SafeStop, Standby};
    let wanted = "passes-states = { ecu = \"arms\", states = [\"standby\", \"active\", \"init\"] }";
    assert!(holds(wanted, &passing(&[Standby, Active, Init])));
    for other in [
        &[][..],
        &[Standby, Active],
        &[Standby, Init, Active],
        &[Standby, Active, Init, Standby],
        &[Standby, Fault, SafeStop, Init, Active],
    ] {
        assert!(!holds(wanted, &passing(other)), "{other:?}");
    }
}

#[test]
fn arms_hold_still_if_each_does() {
    let wanted = "holds-still = { from_s = 1.0, to_s = 2.0, within_mm = 2.5 }";
    let moving = |mm_s: f64, from_s: f64| {
        let mut trace = Trace::default();
        for tick in 0..300 {
            let at_s = f64::from(tick) * 0.01;
            let mut stroke_m = PerWheel::splat(0.17);
            stroke_m[Wheel::Ml] += (at_s - from_s).max(0.0) * mm_s * 1e-3;
            trace.stroke_m.push(at_s, stroke_m);
        }
        trace
    };
    assert!(holds(wanted, &moving(2.0, 0.0)));
    assert!(holds(wanted, &moving(60.0, 2.01)), "later is not asked for");
    assert!(!holds(wanted, &moving(3.0, 0.0)));
    assert!(!holds(wanted, &Trace::default()));
}

#[test]
fn arms_stand_between_bounds_if_each_named_does() {
    let wanted = "strokes = { wheels = [\"FR\", \"ML\"], from_s = 1.0, to_s = 2.0, from_mm = 247, to_mm = 253 }";
    let standing = |wheel: Wheel, mm: f64| {
        let mut trace = Trace::default();
        for tick in 0..300 {
            let mut stroke_m = PerWheel::splat(0.25);
            if (100..200).contains(&tick) {
                stroke_m[wheel] = mm * 1e-3;
            }
            trace.stroke_m.push(f64::from(tick) * 0.01, stroke_m);
        }
        trace
    };
    assert!(hold(wanted, &standing(Wheel::Ml, 252.0)));
    assert!(hold(wanted, &standing(Wheel::Bl, 170.0)), "not named");
    assert!(!hold(wanted, &standing(Wheel::Ml, 246.0)));
    assert!(!hold(wanted, &standing(Wheel::Fr, 254.0)));
    assert!(!hold(wanted, &Trace::default()));
}

#[test]
fn strokes_are_apart_at_one_time() {
    let wanted = "strokes-apart = { from_s = 1.0, to_s = 2.0, from_mm = 80, to_mm = 120 }";
    let apart = |mm: f64, heave_mm: f64| {
        let mut trace = Trace::default();
        for tick in 0..300 {
            // All alike, up and down: that is no ground.
            let heave_m = if tick < 150 { 0.0 } else { heave_mm * 1e-3 };
            let mut stroke_m = PerWheel::splat(0.2 + heave_m);
            stroke_m[Wheel::Br] -= mm * 1e-3;
            trace.stroke_m.push(f64::from(tick) * 0.01, stroke_m);
        }
        trace
    };
    assert!(holds(wanted, &apart(100.0, 50.0)));
    assert!(holds(wanted, &apart(-100.0, 0.0)));
    assert!(!holds(wanted, &apart(0.0, 100.0)));
    assert!(!holds(wanted, &apart(130.0, 0.0)));
    assert!(!holds(wanted, &Trace::default()));
}

#[test]
fn a_machine_drives_if_wheels_and_receiver_say_so() {
    let wanted = "drives = { from_s = 1.0, to_s = 2.0, from_m_s = 0.7, to_m_s = 0.9 }";
    let driving = |wheels_m_s: f64, receiver_m_s: f64| {
        let mut trace = Trace::default();
        // Heading north.
        let heading_rad = std::f64::consts::FRAC_PI_2;
        let velocity_m_s = [0.0, receiver_m_s, 0.0];
        for tick in 0..300 {
            let at_s = f64::from(tick) * 0.01;
            trace.motion.push(at_s, Motion { velocity_m_s, heading_rad });
            let speed_rad_s = wheels_m_s / Machine::xt28().wheels.radius_m;
            trace.wheel_speed_rad_s.push(at_s, PerWheel::splat(speed_rad_s));
        }
        trace
    };
    assert!(hold(wanted, &driving(0.8, 0.8)));
    assert!(!hold(wanted, &driving(0.8, 0.0)), "wheels that spin on the spot");
    assert!(!hold(wanted, &driving(0.0, 0.8)), "a slide");
    assert!(!hold(wanted, &driving(-0.8, -0.8)), "backwards");
    assert!(!hold(wanted, &Trace::default()));
}

#[test]
fn trouble_is_reported_after_its_cause_and_soon() {
    let wanted =
        "reports-trouble = { ecu = \"arms\", spn = 168, fmi = 1, from_s = 3.0, within_s = 0.5 }";
    let reported = |at_s: f64, code: (u32, u8)| {
        let mut trace = Trace::default();
        trace.arm_trouble.push(0.0, Trouble { codes: vec![] });
        trace.arm_trouble.push(at_s, Trouble { codes: vec![(520_192, 5), code] });
        trace
    };
    assert!(holds(wanted, &reported(3.4, (168, 1))));
    assert!(!holds(wanted, &reported(3.6, (168, 1))), "late");
    assert!(!holds(wanted, &reported(2.9, (168, 1))), "before");
    assert!(!holds(wanted, &reported(3.4, (168, 4))), "another failure");
    assert!(!holds(wanted, &Trace::default()));
}

#[test]
fn a_lean_is_its_mean_in_its_time() {
    let wanted = "leans = { roll_deg = -1.2, within_deg = 0.2, from_s = 1.0, to_s = 2.0 }";
    let leaning = |deg: f64| {
        let mut trace = Trace::default();
        for tick in 0..300 {
            let roll_rad = if tick < 100 { 0.0 } else { deg.to_radians() };
            trace.attitude.push(f64::from(tick) * 0.01, Attitude { roll_rad, pitch_rad: 0.0 });
        }
        trace
    };
    assert!(holds(wanted, &leaning(-1.1)));
    assert!(!holds(wanted, &leaning(1.2)) && !holds(wanted, &leaning(-0.9)));
    assert!(!holds(wanted, &Trace::default()));
}
