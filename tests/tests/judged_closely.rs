//! Each expectation where its own limits lie: what it leaves out, from when on, and which of several it takes.

use std::io;
use std::path::Path;

use xt28_bus::candump::Writer;
use xt28_dbc::messages::GnssPosition;
use xt28_machine::{Machine, PerWheel, SimTime};
use xt28_scenarios::trace::{Attitude, Fault, Motion};
use xt28_scenarios::{Evidence, Finding, Recording, Scenario, Trace, Truth};

fn parse(text: &str) -> Result<Scenario, String> {
    let none = |_: &Path| Err(io::ErrorKind::NotFound.into());
    Scenario::parse(text, Path::new("t.toml"), none).map_err(|error| error.to_string())
}

/// What the one expectation of `toml`, beside which there may be events, finds in a run of ten seconds.
fn judge(toml: &str, trace: &Trace, truth: Option<&Truth>) -> Vec<Finding> {
    let text = format!("title = \"t\"\npolicy = \"hold\"\nduration_s = 10\n{toml}\n");
    let (scenario, machine) = (parse(&text).unwrap(), Machine::xt28());
    let evidence =
        Evidence { scenario: &scenario, machine: &machine, payload_kg: 0.0, trace, truth };
    scenario.expectations[0].judge(&evidence)
}

fn verdicts(toml: &str, trace: &Trace) -> Vec<bool> {
    judge(&format!("[[expect]]\n{toml}"), trace, None).iter().map(Finding::passed).collect()
}

/// The first number that is measured.
fn measured(toml: &str, trace: &Trace) -> Option<f64> {
    judge(&format!("[[expect]]\n{toml}"), trace, None)[0].measured
}

fn trace(fill: impl Fn(&mut Trace, f64)) -> Trace {
    let mut trace = Trace::default();
    for at_s in (0..=1000).map(|tick| f64::from(tick) * 0.01) {
        fill(&mut trace, at_s);
        trace.end_s = at_s;
        trace.frames += 1;
    }
    trace
}

#[test]
fn a_pose_is_that_of_the_last_second_and_its_lean() {
    let pose =
        "reaches-pose = { x_m = 5, y_m = 0, heading_deg = 0, within_m = 0.1, within_deg = 9 }";
    let arriving = |by_s: f64, roll_rad: f64| {
        trace(|trace, at_s| {
            let up_m = Machine::xt28().sensors.gnss_antenna_m[2];
            let there = at_s >= by_s;
            let left_m = if there { up_m * roll_rad.sin() } else { 0.0 };
            trace.antenna_m.push(at_s, [if there { 4.7 } else { 0.0 }, left_m]);
            trace.motion.push(at_s, Motion::default());
            let roll_rad = if there { roll_rad } else { 0.0 };
            trace.attitude.push(at_s, Attitude { roll_rad, pitch_rad: 0.0 });
        })
    };
    assert_eq!(verdicts(pose, &arriving(8.9, 0.0)), [true, true]);
    assert_eq!(verdicts(pose, &arriving(9.5, 0.0)), [false, true]);
    assert_eq!(verdicts(pose, &arriving(8.9, 0.2)), [true, true]);
}

#[test]
fn only_a_gateway_that_died_may_lack_its_fixes() {
    let expect = "[[expect]]\nstands-still = { below_m_s = 0.02 }\n";
    let event = |what: &str| format!("[[event]]\nat_s = 5\n{what}\n{expect}");
    let still = trace(|trace, at_s| trace.wheel_speed_rad_s.push(at_s, PerWheel::splat(0.0)));
    let findings = |toml: &str| judge(toml, &still, None).len();
    assert_eq!(findings(&event("kill = \"gateway\"")), 1);
    assert_eq!(findings(&event("order = \"arm\"")), 2);
}

/// An arm that is told to go from one end to the other at 1 s, and goes at `speed_m_s` after `late_s` until
/// `until_s`; then its target is where it is.
fn going(speed_m_s: f64, late_s: f64, until_s: f64) -> Trace {
    trace(|trace, at_s| {
        let (from_m, to_m) = if speed_m_s > 0.0 { (0.0, 0.5) } else { (0.5, 0.0) };
        let gone_s = (at_s.min(until_s) - 1.0 - late_s).max(0.0);
        let stroke_m = from_m + speed_m_s * gone_s;
        let target_m = if (1.0..until_s).contains(&at_s) { to_m } else { stroke_m };
        trace.stroke_target_m.push(at_s, PerWheel::splat(Some(target_m)));
        trace.stroke_m.push(at_s, PerWheel::splat(stroke_m));
    })
}

#[test]
fn an_arm_is_fast_or_slow_once_its_valve_has_opened_either_way() {
    let expect = "arm-speed = { wheels = [\"FR\"], within_percent = 1 }";
    let cap_m_s = 0.3 * 0.212;
    for speed_m_s in [cap_m_s, -cap_m_s] {
        assert_eq!(verdicts(expect, &going(speed_m_s, 0.0, 3.0)), [true]);
        // The valve takes its time at first, and that is left out.
        assert_eq!(verdicts(expect, &going(speed_m_s, 0.19, 2.0)), [true]);
        assert_eq!(verdicts(expect, &going(speed_m_s, 0.4, 2.0)), [false]);
    }
    assert_eq!(measured(expect, &going(cap_m_s, 0.0, 1.5)), None, "too short to tell");
}

/// Bends driven at `speed_m_s`: the rear joint at the ratio that `ratio` says of the time.
fn bend(speed_m_s: f64, until_s: f64, ratio: impl Fn(f64) -> f64) -> Trace {
    trace(|trace, at_s| {
        let front_rad = if at_s < until_s { 0.2 } else { 0.0 };
        trace.wheel_speed_rad_s.push(at_s, PerWheel::splat(speed_m_s / 0.74));
        trace.joint_rad.push(at_s, [front_rad, ratio(at_s) * front_rad]);
    })
}

#[test]
fn the_rear_joint_is_judged_where_it_stands_long_enough_either_way() {
    let expect = "rear-follows = { within = 0.02 }";
    assert_eq!(verdicts(expect, &bend(0.5, 10.0, |_| 0.56)), [true]);
    assert_eq!(verdicts(expect, &bend(-0.5, 10.0, |_| 0.56)), [true], "backwards");
    assert_eq!(measured(expect, &bend(0.5, 5.0, |_| 0.56)), None, "a short bend");
    let swinging = |at_s: f64| 0.56 + 0.1 * at_s.sin();
    assert_eq!(measured(expect, &bend(0.5, 10.0, swinging)), None, "it never stands");
    let own = "rear-follows = { within = 0.02, ratio = 1.0 }";
    assert_eq!(verdicts(own, &bend(0.5, 10.0, |_| 1.0)), [true]);
}

#[test]
fn of_two_bends_the_worse_one_counts() {
    let expect = "rear-follows = { within = 0.02 }";
    // Two spans of six seconds: the second bend begins at 7 s of a run that is longer.
    let mut two = Trace::default();
    for at_s in (0..1600).map(|tick| f64::from(tick) * 0.01) {
        let front_rad = if (7.0..7.5).contains(&at_s) { 0.0 } else { 0.2 };
        let ratio = if at_s < 7.0 { 0.56 } else { 0.7 };
        two.wheel_speed_rad_s.push(at_s, PerWheel::splat(1.0));
        two.joint_rad.push(at_s, [front_rad, ratio * front_rad]);
    }
    let found = measured(expect, &two).unwrap();
    assert!((found - 0.7).abs() < 1e-6, "{found}");
}

#[test]
fn a_step_down_is_one_and_a_short_one_is_none() {
    let expect = "step-response = { wheels = [\"FR\"], rise_s = [0.95, 1.2], overshoot_mm = 2, steady_mm = 1 }";
    let lowering = |until_s: f64| {
        trace(|trace, at_s| {
            let target_m = if (1.0..until_s).contains(&at_s) { 0.1 } else { 0.2 };
            let way = 1.0 - (-(at_s - 1.0).max(0.0) / 0.5).exp();
            trace.stroke_target_m.push(at_s, PerWheel::splat(Some(target_m)));
            trace.stroke_m.push(at_s, PerWheel::splat(0.2 - 0.1 * way));
        })
    };
    assert_eq!(verdicts(expect, &lowering(10.0)), [true; 4]);
    assert_eq!(verdicts(expect, &lowering(8.0)), [false; 3], "its target stands for 7 s");
}

#[test]
fn true_forces_are_averaged_as_the_sensors_do_before_they_are_compared() {
    let expect = "[[expect]]\neven-ground-pressure = { from_s = 1, to_s = 9, below = 0.02 }";
    let mut truth = Truth::default();
    for tick in 0..=1000 {
        let kn = |even: bool| if (tick % 2 == 0) == even { 40e3 } else { 10e3 };
        let force_n = PerWheel([true, false, true, false, true, false].map(kn));
        truth.ground_force_n.push(f64::from(tick) * 0.01, force_n);
    }
    let found = judge(expect, &Trace::default(), Some(&truth));
    assert!(found[1].passed(), "{found:?}");
    assert!(!judge(expect, &Trace::default(), Some(&Truth::default()))[1].passed());
}

#[test]
fn a_log_fills_its_run_with_frames_that_decode() {
    let scenario = parse("title = \"t\"\npolicy = \"hold\"\nduration_s = 10\n").unwrap();
    let machine = Machine::xt28();
    let verdicts = |end_s: f64, faults: usize| {
        let fault = Fault { at_s: 1.0, what: "0CFF4027#: wrong".to_owned() };
        let trace = Trace { end_s, frames: 9, faults: vec![fault; faults], ..Trace::default() };
        let (scenario, machine, trace) = (&scenario, &machine, &trace);
        let evidence = Evidence { scenario, machine, payload_kg: 0.0, trace, truth: None };
        let findings = xt28_scenarios::expect::judge(&evidence);
        findings.iter().map(Finding::passed).collect::<Vec<_>>()
    };
    assert_eq!(verdicts(9.6, 0), [true, true]);
    assert_eq!(verdicts(9.4, 0), [false, true]);
    assert_eq!(verdicts(10.6, 0), [false, true]);
    assert_eq!(verdicts(10.0, 1), [true, false]);
}

#[test]
fn what_was_on_the_bus_before_the_run_has_times_below_zero() {
    let mut log = Writer::new(Vec::new(), "vcan0");
    let fix = GnssPosition { east_mm: 1.0, north_mm: 2.0 }.encode().unwrap();
    for at_ms in [99_500, 100_000, 101_250] {
        log.write(SimTime::from_millis(at_ms), &fix).unwrap();
    }
    let log = log.into_inner();
    let trace = Recording::read(log.as_slice(), "a.log", SimTime::from_millis(100_000)).unwrap();
    let at_s: Vec<f64> = trace.antenna_m.samples().iter().map(|fix| fix.at_s).collect();
    assert_eq!((at_s, trace.end_s), (vec![-0.5, 0.0, 1.25], 1.25));
}

#[test]
fn a_run_of_more_than_an_hour_is_refused() {
    let of = |duration: &str| {
        parse(&format!("title = \"t\"\npolicy = \"hold\"\nduration_s = {duration}\n"))
    };
    assert!(of("3600").is_ok());
    for duration in ["3600.1", "inf", "0", "-0.0"] {
        assert!(of(duration).unwrap_err().starts_with("t.toml:3: duration_s = "), "{duration}");
    }
}
