//! Effects on the emulated machine, seen where a service tool would see them: on the bus.

use std::path::Path;

use ecu_emu::{Emulator, EmulatorConfig, TICK};
use xt28_dbc::e2e::AliveCounter;
use xt28_dbc::messages::{
    ArmStatus, ArmStatusState, ArmTarget, ArmTargetMode, Attitude, DriveCurrent, DriveTarget, Eec1,
    PosFront, PosMidRear, RefCurrentFront, RefCurrentRear, WheelSpeedJoint, WheelSpeedSigned,
};
use xt28_dbc::{Frame, Outbox};
use xt28_machine::{Machine, SimTime, Wheel};
use xt28_sim::effects::{CATALOGUE, Effect, Entry, Overlay, Scope};
use xt28_sim::{Effects, Terrain, VehicleState};

/// The frames of 14 s: arms go from 170 to 220 mm at 1 s, the machine drives from 3 s on and turns
/// left from 6 s on.
fn bus(effects: Effects) -> Vec<(SimTime, Frame)> {
    run(effects).0
}

/// The same, and what is true of the machine at the end.
fn run(effects: Effects) -> (Vec<(SimTime, Frame)>, VehicleState) {
    let config =
        EmulatorConfig { effects, ..EmulatorConfig::new(Machine::xt28(), Terrain::Flat, Some(5)) };
    let mut emulator = Emulator::new(&config);
    let (mut arm, mut drive) = (AliveCounter::default(), AliveCounter::default());
    let (mut out, mut now, mut log) = (Outbox::with_capacity(64), SimTime::ZERO, Vec::new());
    while now < SimTime::from_millis(14_000) {
        let t = now.as_secs_f64();
        let mm = if t < 1.0 { 170.0 } else { 220.0 };
        let arms = ArmTarget {
            fr_mm: mm,
            fl_mm: mm,
            mr_mm: mm,
            ml_mm: mm,
            br_mm: mm,
            bl_mm: mm,
            mode: ArmTargetMode::ManualPosition,
            counter: arm.next_count(),
        };
        let target = DriveTarget {
            throttle_percent: if t < 3.0 { 0.0 } else { 40.0 },
            front_angle_deg: if t < 6.0 { 0.0 } else { 15.0 },
            engine_speed_rpm: 1200.0,
            brake: false,
            enable: true,
            counter: drive.next_count(),
        };
        for frame in [arms.encode().unwrap(), target.encode().unwrap()] {
            emulator.on_frame(now, &frame);
        }
        emulator.tick(now, &mut out);
        log.extend(out.frames().iter().map(|frame| (now, *frame)));
        out.clear();
        now += TICK;
    }
    (log, emulator.truth())
}

fn with(effect: &str) -> Vec<(SimTime, Frame)> {
    bus(effects(effect))
}

fn effects(effect: &str) -> Effects {
    Overlay::parse(&format!("[[effect]]\n{effect}"), Path::new("test"))
        .unwrap()
        .effects(&Machine::xt28())
        .unwrap()
}

/// One signal over time, of the message that `decode` takes.
fn series<M, E>(
    log: &[(SimTime, Frame)],
    decode: fn(&Frame) -> Result<M, E>,
    signal: impl Fn(&M) -> f64,
) -> Vec<(f64, f64)> {
    let samples = log.iter().filter_map(|(at, frame)| {
        decode(frame).ok().map(|message| (at.as_secs_f64(), signal(&message)))
    });
    samples.collect()
}

/// Largest value after `from_s`.
fn most(series: &[(f64, f64)], from_s: f64) -> f64 {
    series.iter().filter(|(t, _)| *t >= from_s).map(|(_, v)| *v).fold(f64::MIN, f64::max)
}

/// The time at which a series first reaches `value`, s.
fn reaches(series: &[(f64, f64)], value: f64) -> f64 {
    series.iter().find(|(_, v)| *v >= value).expect("it comes to that").0
}

/// Every other effect in force, a tenth of the way, is the same with the rest of them listed at
/// severity zero as without; no frame differs.
#[test]
fn effects_at_severity_zero_leave_the_bus_as_the_others_have_it() {
    let entry = |(k, effect): (usize, &'static Effect), severity: f64| Entry {
        effect,
        scope: Scope::All,
        severity: if k.is_multiple_of(2) { severity } else { 0.1 - severity },
        values: effect.parameters.iter().map(|p| (p, p.range[1])).collect(),
    };
    let nominal = bus(Effects::default());
    for severity in [0.0, 0.1] {
        let all: Vec<Entry> =
            CATALOGUE.iter().enumerate().map(|effect| entry(effect, severity)).collect();
        let in_force = all.iter().filter(|entry| entry.severity > 0.0).cloned().collect();
        let alone = bus(Overlay { entries: in_force }.effects(&Machine::xt28()).unwrap());
        assert!(alone != nominal, "effects in force show");
        assert!(
            bus(Overlay { entries: all }.effects(&Machine::xt28()).unwrap()) == alone,
            "some frame differs"
        );
    }
}

#[test]
fn an_arm_with_twice_the_gain_opens_twice_as_wide_and_the_others_do_not() {
    let (nominal, gained) =
        (bus(Effects::default()), with("name = \"arm-gain\"\nscope = \"front\"\nkp_factor = 1.4"));
    let front = |log: &_| most(&series(log, RefCurrentFront::decode, |m| m.fr_b_ma), 1.0);
    let rear = |log: &_| most(&series(log, RefCurrentRear::decode, |m| m.br_b_ma), 1.0);
    // 400 mA opens, 400 mA more is full; the first error of 50 mm asks for 0.20.
    let opening = |ma: f64| (ma - 400.0) / 400.0;
    assert!((opening(front(&gained)) / opening(front(&nominal)) - 1.4).abs() < 0.05);
    assert!((rear(&gained) - rear(&nominal)).abs() < 6.0, "{} {}", rear(&gained), rear(&nominal));
}

#[test]
fn a_steering_gain_shows_in_the_steering_current() {
    let (nominal, gained) =
        (bus(Effects::default()), with("name = \"steer-gain\"\nkp_factor = 1.5"));
    let current = |log: &_| most(&series(log, DriveCurrent::decode, |m| m.steer_front_a_ma), 6.0);
    // 415 mA opens, 315 mA more is full; 15 degrees ask for 0.375.
    let opening = |ma: f64| (ma - 415.0) / 315.0;
    assert!((opening(current(&gained)) / opening(current(&nominal)) - 1.5).abs() < 0.05);
    let arms = |log: &_| series(log, RefCurrentFront::decode, |m| m.fr_b_ma);
    assert_eq!(arms(&gained)[..500], arms(&nominal)[..500]);
}

/// Mean of a series between two times, s.
fn mean(series: &[(f64, f64)], from_s: f64, to_s: f64) -> f64 {
    let within = series.iter().filter(|(t, _)| (from_s..to_s).contains(t)).map(|(_, v)| *v);
    within.clone().sum::<f64>() / within.count() as f64
}

/// What winds up over a step of 50 mm, some 60 mm s, leaves an arm that is nearly there beyond its target by
/// ki / kp of it: 1.5 mm with the machine's own gains, five times that with five times the integral.
#[test]
fn an_arms_integral_gain_shows_beyond_its_target_and_the_others_stay() {
    let (nominal, gained) =
        (bus(Effects::default()), with("name = \"arm-gain\"\nscope = \"front\"\nki_factor = 5.0"));
    let front = |log: &_| mean(&series(log, PosFront::decode, |m| m.fr_mm), 5.0, 8.0);
    let rear = |log: &_| mean(&series(log, PosMidRear::decode, |m| m.br_mm), 5.0, 8.0);
    let beyond_mm = front(&gained) - front(&nominal);
    assert!((3.0..8.0).contains(&beyond_mm), "{beyond_mm} mm");
    assert!((rear(&gained) - rear(&nominal)).abs() < 2.0, "{} {}", rear(&gained), rear(&nominal));
}

/// Error of a joint 8 s after it was asked for 15 degrees, under the law alone: rate = full kp (e + ki integral of e).
fn error_left_deg(ki_per_s: f64) -> f64 {
    let (articulation, dt_s) = (Machine::xt28().articulation, 1e-3);
    let per_s = articulation.rate_max_deg_s * articulation.kp_per_deg;
    let (mut error_deg, mut integral_deg_s) = (15.0, 0.0);
    for _ in 0..7500 {
        integral_deg_s += error_deg * dt_s;
        error_deg -= per_s * (error_deg + ki_per_s * integral_deg_s) * dt_s;
    }
    error_deg
}

/// Wheels that scrub take a joint 0.7 degrees on.
#[test]
fn a_steering_integral_gain_shows_in_what_is_left_of_the_error() {
    let joint = |log: &[_]| series(log, WheelSpeedJoint::decode, |m| m.front_joint_deg);
    let arms = |log: &_| series(log, RefCurrentFront::decode, |m| m.fr_b_ma);
    let nominal = bus(Effects::default());
    for ki_factor in [0.0, 1.0, 3.0] {
        let gained = with(&format!("name = \"steer-gain\"\nki_factor = {ki_factor}"));
        let left_deg = 15.0 - mean(&joint(&gained), 13.3, 13.7);
        let wanted_deg = error_left_deg(ki_factor * Machine::xt28().articulation.ki_per_s);
        assert!(
            (left_deg - wanted_deg).abs() < 0.8,
            "{ki_factor}: {left_deg}, not {wanted_deg} deg"
        );
        assert_eq!(arms(&gained)[..500], arms(&nominal)[..500]);
    }
}

/// Mean distance of the rear valve's current from what follows of the joints' own angles if the rear one follows
/// at this share of the front one, from 7 s on, mA.
fn off_follower_ma(log: &[(SimTime, Frame)], ratio: f64) -> f64 {
    let articulation = Machine::xt28().articulation;
    let joint = |of: fn(&WheelSpeedJoint) -> f64| series(log, WheelSpeedJoint::decode, of);
    let (front, rear) = (joint(|m| m.front_joint_deg), joint(|m| m.rear_joint_deg));
    let current = series(log, DriveCurrent::decode, |m| m.steer_rear_a_ma);
    let (mut integral_deg_s, mut off_ma) = (0.0, Vec::new());
    for (pair, (_, rear_deg)) in front.windows(2).zip(&rear) {
        let [(t, front_deg), (next, _)] = [pair[0], pair[1]];
        let error_deg = ratio * front_deg - rear_deg;
        if t > 3.5 {
            integral_deg_s += error_deg * (next - t);
        }
        let opening =
            articulation.kp_per_deg * (error_deg + articulation.ki_per_s * integral_deg_s);
        // 415 mA opens, 315 mA more is full.
        let wanted_ma = 415.0 + 315.0 * opening;
        let made = current.iter().find(|(at, _)| *at >= t && *at > 7.0 && opening > 0.02);
        off_ma.extend(made.map(|(_, ma)| (ma - wanted_ma).abs()));
    }
    off_ma.iter().sum::<f64>() / off_ma.len() as f64
}

/// The joints' angles would not tell by themselves: wheels that scrub turn both.
#[test]
fn a_weak_follower_shows_in_the_rear_valve_and_the_front_one_is_as_before() {
    let (nominal, weak) =
        (bus(Effects::default()), with("name = \"rear-follower-lag\"\nratio_factor = 0.5"));
    let ratio = Machine::xt28().articulation.rear_ratio;
    let off_ma = [off_follower_ma(&nominal, ratio), off_follower_ma(&weak, 0.5 * ratio)];
    let mistaken_ma = [off_follower_ma(&nominal, 0.5 * ratio), off_follower_ma(&weak, ratio)];
    assert!(off_ma.iter().all(|ma| *ma < 3.0), "{off_ma:?} mA");
    assert!(mistaken_ma.iter().all(|ma| *ma > 20.0), "{mistaken_ma:?} mA");
    let front = |log: &_| most(&series(log, DriveCurrent::decode, |m| m.steer_front_a_ma), 6.0);
    assert!((front(&weak) - front(&nominal)).abs() <= 3.0, "{} {}", front(&weak), front(&nominal));
}

/// A second number of an effect, given as the nominal machine has it, changes no frame.
#[test]
fn second_numbers_at_neutral_leave_the_bus_as_it_is() {
    let nominal = bus(Effects::default());
    for effect in [
        "name = \"arm-gain\"\nki_factor = 1.0",
        "name = \"steer-gain\"\nki_factor = 1.0",
        "name = \"rear-follower-lag\"\nratio_factor = 1.0",
        "name = \"drive-lag\"\nlead_s = 0.0",
        "name = \"unsupported-sag\"\nbelow_n = 0.0",
    ] {
        assert!(with(effect) == nominal, "{effect}");
    }
}

#[test]
fn a_late_follower_turns_the_rear_joint_late() {
    let (nominal, late) =
        (bus(Effects::default()), with("name = \"rear-follower-lag\"\ntime_constant_s = 1.0"));
    let rear = |log: &_| series(log, DriveCurrent::decode, |m| m.steer_rear_a_ma);
    let delay_s = reaches(&rear(&late), 450.0) - reaches(&rear(&nominal), 450.0);
    assert!((0.2..1.5).contains(&delay_s), "{delay_s}");
}

#[test]
fn an_inertial_unit_off_level_shows_in_the_attitude() {
    let tilted = with("name = \"imu-offset\"\nroll_rad = 0.03\npitch_rad = -0.02");
    let nominal = bus(Effects::default());
    let shift = |of: fn(&Attitude) -> f64| {
        let mean = |log: &[_]| {
            let s = series(log, Attitude::decode, of);
            let (sum, n) = s
                .iter()
                .filter(|(t, _)| *t > 2.0)
                .fold((0.0, 0.0), |(sum, n), (_, v)| (sum + v, n + 1.0));
            sum / n
        };
        mean(&tilted) - mean(&nominal)
    };
    let (roll, pitch) = (shift(|m| m.roll_deg), shift(|m| m.pitch_deg));
    assert!((roll - 0.03_f64.to_degrees()).abs() < 0.15, "{roll}");
    assert!((pitch + 0.02_f64.to_degrees()).abs() < 0.15, "{pitch}");
}

#[test]
fn a_stroke_sensor_off_by_a_centimetre_moves_the_arm_and_not_its_reading() {
    let (biased, truth) = run(effects("name = \"stroke-bias\"\nscope = \"FR\"\nbias_m = 0.01"));
    let (fr, fl) = (
        series(&biased, PosFront::decode, |m| m.fr_mm),
        series(&biased, PosFront::decode, |m| m.fl_mm),
    );
    // Before the step both read what was asked: the controller sees the reading.
    let at_rest = |s: &[(f64, f64)]| s.iter().find(|(t, _)| *t > 0.9).unwrap().1;
    assert!((at_rest(&fr) - at_rest(&fl)).abs() <= 10.0);
    assert!((most(&fr, 5.0) - 220.0).abs() < 8.0, "{}", most(&fr, 5.0));
    // What the sensor reads too much, the arm is short of.
    let apart_m = truth.stroke_m[Wheel::Fl] - truth.stroke_m[Wheel::Fr];
    assert!((apart_m - 0.01).abs() < 0.003, "{apart_m} m");
}

#[test]
fn droop_shows_in_the_engines_own_frame() {
    let drooping = with("name = \"engine-droop\"\ndroop_per_w = 1e-5");
    let least = |log: &_| -most(&series(log, Eec1::decode, |m| -m.engine_speed_rpm), 3.0);
    let lost = least(&bus(Effects::default())) - least(&drooping);
    assert!((10.0..400.0).contains(&lost), "{lost} rpm");
}

#[test]
fn a_lagging_drive_reaches_its_speed_later() {
    let speed = |log: &_| series(log, WheelSpeedSigned::decode, |m| m.fr_rpm);
    let nominal = speed(&bus(Effects::default()));
    let half = most(&nominal, 5.0) / 2.0;
    let delayed = speed(&with("name = \"throttle-delay\"\ndelay_s = 0.4"));
    let delay_s = reaches(&delayed, half) - reaches(&nominal, half);
    assert!((delay_s - 0.4).abs() < 0.05, "{delay_s}");
    let lagging = speed(&with("name = \"drive-lag\"\ntime_constant_s = 0.8"));
    let delay_s = reaches(&lagging, half) - reaches(&nominal, half);
    assert!((0.3..1.2).contains(&delay_s), "{delay_s}");
}

#[test]
fn lost_frames_are_the_same_ones_every_time() {
    let lossy = || with("name = \"frame-loss\"\nshare = 0.3");
    assert!(lossy() == lossy(), "a seed is a run");
}

/// A stream is lost with three frames on end. Of 1400 that comes to pass 26 times where three in ten are
/// lost, of which the first is the end; and once in a hundred runs where one in fifty is.
#[test]
fn lost_frames_end_the_run_as_often_as_their_share_has_it() {
    let nominal = bus(Effects::default());
    let state = |log: &[(SimTime, Frame)]| {
        let mut states = log.iter().filter_map(|(_, frame)| ArmStatus::decode(frame).ok());
        states.next_back().expect("the ECU says its state").state
    };
    let stroke = |log: &_| most(&series(log, PosFront::decode, |m| m.fr_mm), 5.0);
    let few = with("name = \"frame-loss\"\nshare = 0.02");
    assert!(few != nominal, "some are lost");
    assert_eq!(state(&few), ArmStatusState::Active);
    assert!((stroke(&few) - stroke(&nominal)).abs() < 3.0, "{} mm", stroke(&few));
    let many = with("name = \"frame-loss\"\nshare = 0.3");
    assert_eq!(state(&many), ArmStatusState::SafeStop);
}

#[test]
fn jitter_within_the_deadline_does_no_harm_and_beyond_it_stops_the_machine() {
    let speed = |log: &_| series(log, WheelSpeedSigned::decode, |m| m.fr_rpm);
    let nominal = speed(&bus(Effects::default()));
    let little = speed(&with("name = \"command-jitter\"\nlatest_s = 0.01"));
    assert!((reaches(&little, 3.0) - reaches(&nominal, 3.0)).abs() < 0.1);
    let much = speed(&with("name = \"command-jitter\"\nlatest_s = 1.0"));
    assert!(most(&much, 0.0) < 3.0, "silence of three periods is a safe stop");
}
