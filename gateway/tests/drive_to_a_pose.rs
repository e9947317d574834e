//! `goto` reaches the paper's targets on a kinematic machine, whatever its delays.

mod vehicle;

use gateway::policy::{Goto, REACHED_DISTANCE_M, REACHED_HEADING_RAD};
use gateway::{Attitude, Outcome, Policy, Pose};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use vehicle::{TICK_S, Variant, Vehicle};
use xt28_machine::{Machine, SimTime};
use xt28_safety::Command;

const IDEAL: Variant =
    Variant { throttle_delay_s: 0.0, steering_delay_s: 0.0, speed_factor: 1.0, noise: false };

/// What became of a drive.
struct Drive {
    outcome: Outcome,
    /// From the goal: ahead (overshoot < 0), left, turn.
    miss: [f64; 3],
    overshoot_m: f64,
    top_speed_m_s: f64,
    seconds: f64,
    /// Mean change of the joint target from fix to fix, deg.
    chatter_deg: f64,
    attitude: Attitude,
}

fn drive(goal: Pose, variant: Variant, ground: Attitude) -> Drive {
    let machine = Machine::xt28();
    let mut policy = Goto::new(&machine, goal);
    let mut vehicle = Vehicle::new(machine, variant, ChaCha8Rng::seed_from_u64(7));
    vehicle.ground = ground;
    let mut command = Command::rest(0.0);
    let mut result = Drive {
        outcome: Outcome::Running,
        miss: [0.0; 3],
        overshoot_m: f64::MIN,
        top_speed_m_s: 0.0,
        seconds: 0.0,
        chatter_deg: 0.0,
        attitude: ground,
    };
    let mut next_fix_s = 0.0;
    for tick in 0..9_000_u64 {
        let now_s = tick as f64 * TICK_S;
        if now_s >= next_fix_s - 1e-9 {
            next_fix_s += 0.125;
            let before_rad = command.front_angle_rad;
            let seen = vehicle.observe(SimTime::from_millis(10 * tick));
            command = policy.act(&seen).expect("one that thinks here");
            result.chatter_deg += (command.front_angle_rad - before_rad).abs().to_degrees() / 300.0;
        }
        vehicle.step(&command);
        result.miss = vehicle.pose.to_local(&goal);
        result.overshoot_m = result.overshoot_m.max(-result.miss[0]);
        result.top_speed_m_s = result.top_speed_m_s.max(vehicle.speed_m_s);
        if policy.outcome() == Outcome::Running {
            result.seconds = now_s;
        }
    }
    result.outcome = policy.outcome();
    result.attitude = vehicle.attitude();
    assert!(vehicle.speed_m_s.abs() < 1e-3, "still moving after 90 s");
    result
}

fn pose(east_m: f64, north_m: f64, heading_deg: f64) -> Pose {
    Pose { east_m, north_m, heading_rad: heading_deg.to_radians() }
}

fn assert_reached(goal: Pose, variant: Variant) {
    let drive = drive(goal, variant, Attitude::default());
    let [ahead_m, left_m, turn_rad] = drive.miss;
    assert_eq!(drive.outcome, Outcome::Reached, "{goal:?} {variant:?}");
    assert!(ahead_m.hypot(left_m) < REACHED_DISTANCE_M, "{goal:?} {variant:?}: {ahead_m} {left_m}");
    assert!(turn_rad.abs() < REACHED_HEADING_RAD, "{goal:?} {variant:?}: {turn_rad}");
    assert!(drive.overshoot_m < 0.15, "{goal:?} {variant:?}: overshoot {}", drive.overshoot_m);
    assert!(drive.top_speed_m_s < 0.9, "{goal:?} {variant:?}: {}", drive.top_speed_m_s);
    assert!(drive.chatter_deg < 1.0, "{goal:?} {variant:?}: {}", drive.chatter_deg);
    assert!(drive.seconds < 60.0, "{goal:?} {variant:?}: {} s", drive.seconds);
}

#[test]
fn reaches_the_papers_targets_with_any_delay_of_the_paper() {
    let variants = [
        IDEAL,
        Variant { throttle_delay_s: 0.3, steering_delay_s: 0.3, ..IDEAL },
        Variant { throttle_delay_s: 0.2, steering_delay_s: 0.2, noise: true, ..IDEAL },
        Variant { throttle_delay_s: 0.7, steering_delay_s: 0.5, noise: true, ..IDEAL },
        Variant { throttle_delay_s: 0.4, speed_factor: 1.1, noise: true, ..IDEAL },
        Variant { throttle_delay_s: 0.4, speed_factor: 0.9, noise: true, ..IDEAL },
    ];
    for variant in variants {
        for goal in [pose(25.0, 0.0, 0.0), pose(24.5, 4.98, 23.0), pose(24.5, -4.98, -23.0)] {
            assert_reached(goal, variant);
        }
    }
}

#[test]
fn reaches_harder_targets() {
    let late = Variant { throttle_delay_s: 0.3, steering_delay_s: 0.3, noise: true, ..IDEAL };
    for goal in [pose(25.0, 3.0, 0.0), pose(15.0, 10.0, 70.0), pose(20.0, -6.0, 10.0)] {
        assert_reached(goal, late);
    }
}

#[test]
fn a_goal_of_another_site_is_refused_without_moving() {
    for away_m in [301.0, 1e5, 1e300] {
        let drive = drive(pose(away_m, 0.0, 0.0), IDEAL, Attitude::default());
        let Outcome::Failed(why) = drive.outcome else { panic!("{:?}", drive.outcome) };
        assert!(why.contains("300 m at most") && why.contains("--origin"), "{why}");
        assert_eq!(drive.top_speed_m_s, 0.0);
    }
}

#[test]
fn a_goal_beside_the_machine_is_refused_without_moving() {
    let drive = drive(pose(0.0, 3.0, 0.0), IDEAL, Attitude::default());
    let Outcome::Failed(why) = drive.outcome else { panic!("{:?}", drive.outcome) };
    assert!(why.contains("turning radius"), "{why}");
    assert!(drive.top_speed_m_s == 0.0);
}

#[test]
fn levels_the_machine_on_the_way() {
    let ground = Attitude { roll_rad: 3_f64.to_radians(), pitch_rad: -2_f64.to_radians() };
    let drive = drive(pose(25.0, 0.0, 0.0), IDEAL, ground);
    assert!(drive.attitude.roll_rad.abs() < 0.4_f64.to_radians(), "{:?}", drive.attitude);
    assert!(drive.attitude.pitch_rad.abs() < 0.4_f64.to_radians(), "{:?}", drive.attitude);
}
