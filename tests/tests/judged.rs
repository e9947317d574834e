//! Each expectation on traces made for it: one that holds, and the nearest ones that do not.

use std::io;
use std::path::Path;

use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, Wheel};
use xt28_scenarios::trace::{Attitude, DriveCommand, EcuState, Motion};
use xt28_scenarios::{Evidence, Finding, Scenario, Trace, Truth};

/// What the one expectation `toml` finds in `trace`.
fn judge(toml: &str, trace: &Trace) -> Vec<Finding> {
    judge_with(toml, trace, None)
}

fn judge_with(toml: &str, trace: &Trace, truth: Option<&Truth>) -> Vec<Finding> {
    let text = format!("title = \"t\"\npolicy = \"hold\"\nduration_s = 10\n[[expect]]\n{toml}\n");
    let none = |_: &Path| Err(io::ErrorKind::NotFound.into());
    let scenario = Scenario::parse(&text, Path::new("t.toml"), none).expect("a good scenario");
    let machine = Machine::xt28();
    let evidence =
        Evidence { scenario: &scenario, machine: &machine, payload_kg: 0.0, trace, truth };
    scenario.expectations[0].judge(&evidence)
}

fn verdicts(toml: &str, trace: &Trace) -> Vec<bool> {
    judge(toml, trace).iter().map(Finding::passed).collect()
}

/// Ticks of 10 ms over ten seconds.
fn ticks() -> impl Iterator<Item = f64> {
    (0..1000).map(|tick| f64::from(tick) * 0.01)
}

fn trace(fill: impl Fn(&mut Trace, f64)) -> Trace {
    let mut trace = Trace::default();
    for at_s in ticks() {
        fill(&mut trace, at_s);
        trace.end_s = at_s;
    }
    trace
}

fn standing_at(x_m: f64, y_m: f64, heading_deg: f64) -> Trace {
    trace(|trace, at_s| {
        // The antenna is 0.30 m behind the front axle.
        let (sin, cos) = heading_deg.to_radians().sin_cos();
        trace.antenna_m.push(at_s, [x_m - 0.3 * cos, y_m - 0.3 * sin]);
        let heading_rad = heading_deg.to_radians();
        trace.motion.push(at_s, Motion { heading_rad, ..Motion::default() });
        trace.wheel_speed_rad_s.push(at_s, PerWheel::splat(0.0));
    })
}

#[test]
fn a_pose_is_reached_within_distance_and_heading() {
    let target = "reaches-pose = { x_m = 24.5, y_m = 4.98, heading_deg = 179, within_m = 0.3, within_deg = 9 }";
    assert_eq!(verdicts(target, &standing_at(24.3, 5.1, 179.0)), [true, true]);
    assert_eq!(verdicts(target, &standing_at(24.3, 5.1, -174.0)), [true, true]);
    assert_eq!(verdicts(target, &standing_at(24.3, 5.3, 179.0)), [false, true]);
    assert_eq!(verdicts(target, &standing_at(24.5, 5.0, 169.0)), [true, false]);
    assert_eq!(verdicts(target, &Trace::default()), [false, false]);
}

#[test]
fn standing_means_wheels_and_antenna() {
    let expect = "stands-still = { below_m_s = 0.02 }";
    assert_eq!(verdicts(expect, &standing_at(1.0, 2.0, 0.0)), [true, true]);
    let creeping = trace(|trace, at_s| trace.antenna_m.push(at_s, [0.03 * at_s, 0.0]));
    assert_eq!(verdicts(expect, &creeping), [false, false], "no wheel frames, and a drift");
    let spinning = trace(|trace, at_s| {
        // Wheels that turn against each other do not stand, though their mean does.
        let speed = PerWheel::from_fn(|wheel| 0.05 * wheel.side().sign());
        trace.wheel_speed_rad_s.push(at_s, speed);
    });
    assert_eq!(verdicts(expect, &spinning), [false, false], "and no fix says where it is");
    let stopped = trace(|trace, at_s| {
        let speed = if at_s < 7.9 { 1.0 } else { 0.0 };
        trace.wheel_speed_rad_s.push(at_s, PerWheel::splat(speed));
    });
    assert_eq!(verdicts(expect, &stopped), [true, false]);
}

/// A machine at `stroke_m` whose cylinders carry what lies above them, times `factor`.
fn standing_with_load(stroke_m: f64, factor: f64) -> Trace {
    let machine = Machine::xt28();
    let m = &machine.masses;
    let frames_kg = m.front_frame_kg + m.middle_frame_kg + m.rear_frame_kg;
    // Half of each arm hangs on its pivot.
    let sprung_n = (frames_kg + 3.0 * m.arm_kg) * GRAVITY_M_S2;
    let load_n = sprung_n / 6.0 / machine.linkage().at_stroke(stroke_m).force_ratio;
    trace(|trace, at_s| {
        trace.stroke_m.push(at_s, PerWheel::splat(stroke_m));
        trace.cylinder_load_n.push(at_s, PerWheel::splat(load_n * factor));
    })
}

#[test]
fn the_weight_is_carried_at_any_stroke() {
    let expect = "carries-weight = { from_s = 1, to_s = 2, within_percent = 1 }";
    for stroke_m in [0.0, 0.17, 0.25, 0.5] {
        let findings = judge(expect, &standing_with_load(stroke_m, 1.0));
        let sum_kn = findings[0].measured.unwrap();
        assert!((sum_kn - 166.77).abs() < 0.01, "{stroke_m}: {sum_kn}");
    }
    assert_eq!(verdicts(expect, &standing_with_load(0.17, 1.02)), [false]);
    assert_eq!(verdicts(expect, &standing_with_load(0.17, 0.98)), [false]);
    assert_eq!(verdicts(expect, &Trace::default()), [false]);
}

/// Arms that go from 0 to 0.25 m at `speed_m_s` once told so at 1 s; strokes in whole mm.
fn stepping(speed_m_s: f64) -> Trace {
    trace(|trace, at_s| {
        let target_m = if at_s < 1.0 { 0.0 } else { 0.25 };
        let stroke_m = (speed_m_s * (at_s - 1.0)).clamp(0.0, 0.25);
        let whole_mm = (stroke_m * 1e3).floor() * 1e-3;
        trace.stroke_target_m.push(at_s, PerWheel::splat(Some(target_m)));
        trace.stroke_m.push(at_s, PerWheel::splat(whole_mm));
    })
}

#[test]
fn arms_move_at_the_cap_of_their_valves() {
    let expect = "arm-speed = { wheels = [\"FR\", \"BL\"], within_percent = 5 }";
    let findings = judge(expect, &stepping(0.3 * 0.212));
    assert!((findings[0].measured.unwrap() - 0.0636).abs() < 3e-4, "{findings:?}");
    assert!(findings[0].passed());
    assert_eq!(verdicts(expect, &stepping(0.06)), [false]);
    assert_eq!(verdicts(expect, &stepping(0.07)), [false]);
    assert_eq!(verdicts(expect, &stepping(0.0)), [false], "stuck arms are slow, not missing");
    assert_eq!(verdicts(expect, &Trace::default()), [false]);
}

/// Arms that stand at 0.25 m until they are told to go to zero at 1 s, and then go at `speed_m_s`, out > 0.
fn called_in(speed_m_s: f64) -> Trace {
    trace(|trace, at_s| {
        let target_m = if at_s < 1.0 { 0.25 } else { 0.0 };
        let stroke_m = (0.25 + speed_m_s * (at_s - 1.0).max(0.0)).clamp(0.0, 0.5);
        trace.stroke_target_m.push(at_s, PerWheel::splat(Some(target_m)));
        trace.stroke_m.push(at_s, PerWheel::splat((stroke_m * 1e3).floor() * 1e-3));
    })
}

#[test]
fn arms_that_run_away_from_their_target_do_not_move_at_the_cap() {
    let expect = "arm-speed = { wheels = [\"FR\"], within_percent = 5 }";
    let cap_m_s = 0.3 * 0.212;
    assert_eq!(verdicts(expect, &called_in(-cap_m_s)), [true]);
    let away = judge(expect, &called_in(cap_m_s));
    assert!(!away[0].passed() && away[0].measured.is_some_and(|m_s| m_s < 0.0), "{away:?}");
    let out = trace(|trace, at_s| {
        let stroke_m = (0.25 - cap_m_s * (at_s - 1.0).max(0.0)).max(0.0);
        trace.stroke_target_m.push(at_s, PerWheel::splat(Some(0.5)));
        trace.stroke_m.push(at_s, PerWheel::splat((stroke_m * 1e3).floor() * 1e-3));
    });
    assert_eq!(verdicts(expect, &out), [false]);
}

/// A bend with the front joint at 10 degrees and the rear at `ratio` of it, driven at `speed_m_s`.
fn bend(ratio: f64, speed_m_s: f64) -> Trace {
    trace(|trace, at_s| {
        let front_rad = 10_f64.to_radians() * (at_s / 2.0).min(1.0);
        trace.wheel_speed_rad_s.push(at_s, PerWheel::splat(speed_m_s / 0.74));
        trace.joint_rad.push(at_s, [front_rad, ratio * front_rad]);
    })
}

#[test]
fn the_rear_joint_follows_where_it_can() {
    let expect = "rear-follows = { within = 0.02 }";
    assert_eq!(verdicts(expect, &bend(0.56, 0.5)), [true]);
    assert_eq!(verdicts(expect, &bend(0.53, 0.5)), [false]);
    assert_eq!(verdicts(expect, &bend(1.0, 0.5)), [false]);
    let slow = judge(expect, &bend(0.56, 0.05));
    assert_eq!(slow[0].measured, None, "below the speed threshold nothing is said");
}

#[test]
fn the_roll_peaks_between_its_bounds_with_its_sign() {
    let expect = "roll-peak = { from_deg = 1, to_deg = 6, end_within_deg = 0.5 }";
    let rolling = |peak_deg: f64, end_deg: f64| {
        trace(|trace, at_s| {
            let roll_deg = if (4.0..5.0).contains(&at_s) { peak_deg } else { end_deg };
            let roll_rad = roll_deg.to_radians();
            trace.attitude.push(at_s, Attitude { roll_rad, pitch_rad: 0.0 });
        })
    };
    assert_eq!(verdicts(expect, &rolling(3.0, 0.2)), [true, true]);
    assert_eq!(verdicts(expect, &rolling(-3.0, 0.2)), [false, true]);
    assert_eq!(verdicts(expect, &rolling(0.5, 0.2)), [false, true]);
    assert_eq!(verdicts(expect, &rolling(7.0, -0.6)), [false, false]);
}

/// Commands until 5 s; the state turns to safe stop `after_s` the first that is missing, and to
/// `end` at 9 s.
fn silenced(after_s: f64, end: EcuState) -> Trace {
    trace(|trace, at_s| {
        if at_s < 4.995 {
            trace.drive_target.push(at_s + 0.0002, DriveCommand::default());
        }
        let state = match at_s {
            _ if at_s < 5.0 + after_s - 0.005 => EcuState::Active,
            _ if at_s < 9.0 => EcuState::SafeStop,
            _ => end,
        };
        trace.drive_state.push(at_s + 0.0015, state);
    })
}

#[test]
fn an_ecu_stops_within_its_periods_and_stays_stopped() {
    let expect = "reaches-state = { ecu = \"drive\", state = \"safe-stop\", within_periods = 3 }";
    let found = judge(expect, &silenced(0.03, EcuState::SafeStop));
    assert_eq!(found[0].measured, Some(3.0));
    assert!(found[0].passed());
    assert_eq!(verdicts(expect, &silenced(0.04, EcuState::SafeStop)), [false]);
    assert_eq!(verdicts(expect, &silenced(0.03, EcuState::Active)), [false], "it woke up again");
    assert_eq!(verdicts(expect, &Trace::default()), [false]);
}

#[test]
fn every_wheel_name_is_known() {
    for wheel in Wheel::ALL {
        let expect = format!("arm-speed = {{ wheels = [\"{wheel}\"], within_percent = 5 }}");
        assert_eq!(judge(&expect, &Trace::default()).len(), 1);
    }
}

/// Six wheels with these loads, kN, on the cylinders of a machine at 0.25 m.
fn carrying(wheel_kn: [f64; 6]) -> Trace {
    let machine = Machine::xt28();
    let m = &machine.masses;
    let unsprung_n = (m.wheel_kg + 0.5 * m.arm_kg) * GRAVITY_M_S2;
    let ratio = machine.linkage().at_stroke(0.25).force_ratio;
    trace(|trace, at_s| {
        trace.stroke_m.push(at_s, PerWheel::splat(0.25));
        trace
            .cylinder_load_n
            .push(at_s, PerWheel(wheel_kn.map(|kn| (kn * 1e3 - unsprung_n) / ratio)));
    })
}

#[test]
fn even_ground_pressure_is_the_deviation_of_shares() {
    let expect = "even-ground-pressure = { from_s = 1, to_s = 9, below = 0.1 }";
    let alike = judge(expect, &carrying([27.8; 6]));
    assert!(alike[0].measured.unwrap() < 1e-6 && alike[0].passed());
    // Shares of 0.27, 0.15 and 0.08 a wheel: by hand 0.0787.
    let even = judge(expect, &carrying([45.0, 45.0, 25.0, 25.0, 13.333, 13.333]));
    assert!((even[0].measured.unwrap() - 0.0785).abs() < 5e-4, "{even:?}");
    assert!(even[0].passed());
    assert_eq!(verdicts(expect, &carrying([70.0, 20.0, 5.0, 40.0, 1.0, 30.0])), [false]);
    let from = "even-ground-pressure = { from_s = 1, to_s = 9, from = 0.1, below = 0.2 }";
    assert_eq!(verdicts(from, &carrying([27.8; 6])), [false], "too even to have felt the ground");
    assert_eq!(verdicts(expect, &Trace::default()), [false]);
}

#[test]
fn wheels_in_the_air_carry_nothing() {
    let expect = "unsupported = { wheels = [\"MR\", \"ML\"], from_s = 1, to_s = 9, within_kn = 1 }";
    assert_eq!(verdicts(expect, &carrying([50.0, 50.0, 0.2, -0.2, 30.0, 30.0])), [true, true]);
    assert_eq!(verdicts(expect, &carrying([50.0, 50.0, 1.5, 0.0, 30.0, 30.0])), [false, true]);
    assert_eq!(verdicts(expect, &Trace::default()), [false, false]);
}

#[test]
fn the_hardest_knock_lies_between_its_bounds() {
    let expect = "peak-load = { from_s = 2, to_s = 8, from_kn = 90, to_kn = 120 }";
    let knock = |at: f64, kn: f64| {
        trace(move |trace, at_s| {
            let mut load_n = PerWheel::splat(50e3);
            if (at_s - at).abs() < 0.02 {
                load_n[Wheel::Ml] = kn * 1e3;
            }
            trace.cylinder_load_n.push(at_s, load_n);
        })
    };
    assert_eq!(verdicts(expect, &knock(5.0, 100.0)), [true]);
    assert_eq!(verdicts(expect, &knock(5.0, 130.0)), [false]);
    assert_eq!(verdicts(expect, &knock(1.0, 100.0)), [false], "outside the window");
    assert_eq!(verdicts(expect, &Trace::default()), [false]);
}

#[test]
fn frames_clear_the_ground_only_where_the_truth_says_so() {
    let expect = "clears-ground = { from_s = 2, to_s = 8 }";
    let some = "clears-ground = { from_s = 2, to_s = 8, at_most_kn = 5 }";
    let grounding = |at: f64, force_n: f64| {
        let mut truth = Truth::default();
        for at_s in ticks() {
            let touches = (at_s - at).abs() < 0.006;
            truth.chassis_force_n.push(at_s, if touches { force_n } else { 0.0 });
        }
        truth
    };
    let passed = |toml: &str, truth: &Truth| {
        judge_with(toml, &Trace::default(), Some(truth)).iter().all(Finding::passed)
    };
    assert!(passed(expect, &grounding(5.0, 0.0)));
    assert!(!passed(expect, &grounding(5.0, 4e3)), "a touch is a touch");
    assert!(passed(some, &grounding(5.0, 4e3)));
    assert!(!passed(some, &grounding(5.0, 6e3)));
    assert!(passed(expect, &grounding(1.0, 4e3)), "outside the window");
    assert!(!passed(expect, &Truth::default()), "a truth without the frames");
    assert_eq!(verdicts(expect, &Trace::default()), [false], "no truth at all");
}

#[test]
fn level_means_both_angles_over_the_whole_window() {
    let expect = "stays-level = { from_s = 2, to_s = 8, roll_deg = 0.5, pitch_deg = 1.0 }";
    let leaning = |roll_deg: f64, pitch_deg: f64, until_s: f64| {
        trace(move |trace, at_s| {
            let (roll_deg, pitch_deg) =
                if at_s < until_s { (roll_deg, pitch_deg) } else { (0.0, 0.0) };
            let lean =
                Attitude { roll_rad: roll_deg.to_radians(), pitch_rad: pitch_deg.to_radians() };
            trace.attitude.push(at_s, lean);
        })
    };
    assert_eq!(verdicts(expect, &leaning(-5.0, 3.0, 1.9)), [true, true]);
    assert_eq!(verdicts(expect, &leaning(-5.0, 0.9, 2.1)), [false, true]);
    assert_eq!(verdicts(expect, &leaning(0.4, -1.1, 9.0)), [true, false]);
    assert_eq!(verdicts(expect, &Trace::default()), [false, false]);
}

/// An arm that goes from 0 to 0.1 m as 1 - exp(-t / `time_constant_s`), `beyond_m` too far.
fn answering(time_constant_s: f64, beyond_m: f64) -> Trace {
    trace(|trace, at_s| {
        let target_m = if at_s < 1.0 { 0.0 } else { 0.1 };
        let way = 1.0 - (-(at_s - 1.0).max(0.0) / time_constant_s).exp();
        trace.stroke_target_m.push(at_s, PerWheel::splat(Some(target_m)));
        trace.stroke_m.push(at_s, PerWheel::splat((0.1 + beyond_m) * way));
    })
}

#[test]
fn a_step_is_judged_by_rise_overshoot_and_what_is_left() {
    let expect = "step-response = { wheels = [\"FR\"], rise_s = [0.95, 1.2], overshoot_mm = 2, steady_mm = 1 }";
    // ln 9 time constants from 10 % to 90 %.
    let found = judge(expect, &answering(0.5, 0.0));
    assert!((found[0].measured.unwrap() - 0.5 * 9_f64.ln()).abs() < 0.02, "{found:?}");
    assert!(found.iter().all(Finding::passed), "{found:?}");
    assert_eq!(verdicts(expect, &answering(0.6, 0.0)), [false, false, true, true]);
    assert_eq!(verdicts(expect, &answering(0.5, 0.0015)), [true, true, true, false]);
    assert_eq!(verdicts(expect, &answering(0.5, 0.003)), [true, true, false, false]);
    assert_eq!(verdicts(expect, &answering(0.4, 0.0)), [false, false, true, true], "too quick");
    let stuck = answering(1e9, 0.0);
    assert_eq!(verdicts(expect, &stuck), [false, false, true, false]);
    let two = expect.replace("[\"FR\"]", "[\"FR\", \"BL\"]");
    let one_steps = trace(|trace, at_s| {
        let target_m = if at_s < 1.0 { 0.0 } else { 0.1 };
        let alone = |m| PerWheel::from_fn(|w| if w == Wheel::Fr { m } else { 0.0 });
        trace.stroke_target_m.push(at_s, alone(target_m).map(Some));
        trace.stroke_m.push(at_s, alone(target_m));
    });
    assert_eq!(verdicts(&two, &one_steps), [false, false, false], "BL never steps");
    assert_eq!(verdicts(expect, &Trace::default()), [false, false, false]);
}
