//! The gateway between its buses: what leaves, when, and that it drives to the goal by frames alone.

mod bench;
mod vehicle;

use bench::{Bench, Faults};
use gateway::policy::{Goto, Hold, Script};
use gateway::{
    Attitude, Gateway, GatewayConfig, Geodetic, Order, Outcome, Phase, Policy, Pose, Reason,
};
use std::path::Path;
use vehicle::Variant;
use xt28_dbc::messages::{
    ArmTarget, ArmTargetMode, ArmValve, DriveTarget, GnssPosition, GnssQuality, GnssVelocity,
};
use xt28_machine::Machine;
use xt28_safety::Limits;

const LATE: Variant =
    Variant { throttle_delay_s: 0.2, steering_delay_s: 0.2, speed_factor: 1.0, noise: true };

fn gateway(policy: Box<dyn Policy>, arm_at_start: bool) -> Gateway {
    let machine = Machine::xt28();
    Gateway::new(&machine, GatewayConfig { arm_at_start, ..GatewayConfig::new(&machine) }, policy)
}

fn goto(east_m: f64, north_m: f64, heading_deg: f64) -> Box<dyn Policy> {
    let goal = Pose { east_m, north_m, heading_rad: heading_deg.to_radians() };
    Box::new(Goto::new(&Machine::xt28(), goal))
}

fn script(text: &str) -> Box<dyn Policy> {
    Box::new(Script::parse(text, Path::new("test.toml"), &Limits::XT28).unwrap())
}

fn armed(policy: Box<dyn Policy>) -> Bench {
    let mut bench = Bench::new(gateway(policy, true), LATE);
    bench.run_until(2.0, |status| status.phase == Phase::Armed);
    bench
}

#[test]
fn reaches_the_goal_by_frames_alone_and_stays() {
    let mut bench = Bench::new(gateway(goto(24.5, 4.98, 23.0), true), LATE);
    bench.vehicle.ground = Attitude { roll_rad: 0.02, pitch_rad: -0.01 };
    let status = bench.run_until(60.0, |status| status.outcome != Outcome::Running);
    assert_eq!(status.outcome, Outcome::Reached);
    let goal = Pose { east_m: 24.5, north_m: 4.98, heading_rad: 23_f64.to_radians() };
    let [ahead_m, left_m, _] = bench.vehicle.pose.to_local(&goal);
    assert!(ahead_m.hypot(left_m) < 0.15, "{ahead_m} {left_m}");
    for _ in 0..200 {
        bench.tick();
    }
    let target = bench.drive_target().unwrap();
    assert!(target.throttle_percent == 0.0 && target.brake && target.enable);
    assert_eq!(bench.gateway.status().counts.frames_refused, 0);
    assert_eq!(bench.gateway.status().counts.frames_unsent, 0);
}

#[test]
fn a_disarmed_gateway_sends_fixes_and_nothing_else() {
    let mut bench = Bench::new(gateway(goto(25.0, 0.0, 0.0), false), LATE);
    let mut fixes = 0;
    for _ in 0..400 {
        bench.tick();
        for frame in bench.sent.frames() {
            assert!([GnssPosition::ID, GnssVelocity::ID, GnssQuality::ID].contains(&frame.id()));
        }
        fixes += usize::from(bench.sent_of(GnssPosition::ID).is_some());
    }
    assert_eq!(fixes, 32, "8 Hz for 4 s");
}

#[test]
fn the_logged_position_is_the_antennas() {
    let mut bench = Bench::new(gateway(Box::new(Hold), false), Variant { noise: false, ..LATE });
    bench.tick();
    let position = GnssPosition::decode(&bench.sent_of(GnssPosition::ID).unwrap()).unwrap();
    assert_eq!((position.east_mm, position.north_mm), (-300.0, 0.0));
    let velocity = GnssVelocity::decode(&bench.sent_of(GnssVelocity::ID).unwrap()).unwrap();
    assert_eq!(velocity.heading_deg, 0.0);
    let pose = bench.gateway.status().located.unwrap().pose;
    assert!(pose.east_m.abs() < 1e-3 && pose.north_m.abs() < 1e-3, "{pose:?}");
}

#[test]
fn the_handshake_moves_nothing() {
    let mut bench = Bench::new(gateway(goto(25.0, 0.0, 0.0), true), LATE);
    let mut neutral = 0;
    while bench.gateway.status().phase != Phase::Armed {
        bench.tick();
        if let (Some(arm), Some(drive)) = (bench.arm_target(), bench.drive_target())
            && !drive.enable
        {
            neutral += 1;
            assert_eq!(arm.mode, ArmTargetMode::Off);
            assert!(drive.throttle_percent == 0.0 && drive.brake);
        }
        assert!(bench.now.as_secs_f64() < 1.0);
    }
    // Ten acknowledged ones are enough, but readings have to be steady for 0.22 s.
    assert!((10..=22).contains(&neutral), "{neutral} neutral rounds");
}

#[test]
fn every_failure_stops_the_machine_then_falls_silent() {
    let fine = Faults::default();
    let failures = [
        (Faults { arm_ecu_silent: true, ..fine }, 0.12),
        (Faults { drive_status_stuck: true, ..fine }, 0.12),
        (Faults { drive_ecu_deaf: true, ..fine }, 0.16),
        (Faults { drive_ecu_safe_stop: true, ..fine }, 0.02),
        (Faults { gnss_silent: true, ..fine }, 0.52),
        (Faults { gnss_code_only: true, ..fine }, 0.52),
        (Faults { imu_roll_deg: Some(18.5), ..fine }, 0.02),
        // 0.2 s until loads count as lost, three fixes without an observation, and 25 ms on the way.
        (Faults { loads_silent: true, ..fine }, 0.7),
        // An ECU finds a sensor broken and sends its last reading on: position, attitude, joint.
        (Faults { bits: [1 << 0, 0], ..fine }, 0.02),
        (Faults { bits: [1 << 2, 0], ..fine }, 0.02),
        (Faults { bits: [0, 1 << 0], ..fine }, 0.02),
        // Pressure: nothing but the observation has it.
        (Faults { bits: [1 << 1, 0], ..fine }, 0.52),
    ];
    for (failure, within_s) in failures {
        let mut bench = armed(goto(25.0, 0.0, 0.0));
        while bench.vehicle.speed_m_s < 0.7 {
            bench.tick();
        }
        bench.faults = failure;
        let failed_s = bench.now.as_secs_f64();
        let status = bench.run_until(20.0, |s| matches!(s.phase, Phase::Blocked(_)));
        let took_s = bench.now.as_secs_f64() - failed_s;
        assert!(took_s <= within_s + 1e-9, "{failure:?}: {took_s} s, {:?}", status.blocked);
        let mut rounds = 0;
        while let Some(target) = bench.drive_target() {
            assert!(target.throttle_percent == 0.0 && !target.enable, "{failure:?}");
            assert_eq!(bench.arm_target().unwrap().mode, ArmTargetMode::Off);
            rounds += 1;
            bench.tick();
        }
        assert!((100..=200).contains(&rounds), "{failure:?}: {rounds} rounds");
        assert!(bench.gateway.is_silent());
        // Healed is not re-armed.
        bench.faults = fine;
        for _ in 0..200 {
            bench.tick();
            assert!(bench.drive_target().is_none());
        }
    }
}

/// An ECU may be back before its silence is noticed: what it says of itself must be enough.
#[test]
fn an_ecu_that_restarts_within_its_deadline_ends_the_run_all_the_same() {
    let mut bench = armed(goto(25.0, 0.0, 0.0));
    bench.faults.arm_ecu_silent = true;
    (0..9).for_each(|_| bench.tick());
    assert_eq!(bench.gateway.status().phase, Phase::Armed, "not late yet");
    bench.faults = Faults { arm_ecu_starts: true, ..Faults::default() };
    bench.tick();
    assert_eq!(bench.gateway.status().blocked, Some(Reason::ArmEcuNotReady));
    bench.faults = Faults::default();
    for _ in 0..300 {
        bench.tick();
        assert!(bench.drive_target().is_none_or(|target| !target.enable));
        assert!(bench.arm_target().is_none_or(|target| target.mode == ArmTargetMode::Off));
    }
    bench.gateway.order(Order::Arm);
    bench.run_until(6.0, |status| status.phase == Phase::Armed);
}

#[test]
fn an_order_to_disarm_ends_in_silence_and_one_to_arm_starts_again() {
    let mut bench = armed(Box::new(Hold));
    bench.gateway.order(Order::Disarm);
    bench.tick();
    assert!(!bench.drive_target().unwrap().enable);
    bench.run_until(4.0, |_| true);
    while !bench.gateway.is_silent() {
        bench.tick();
    }
    bench.tick();
    assert!(bench.sent_of(ArmTarget::ID).is_none());
    bench.gateway.order(Order::Arm);
    bench.run_until(6.0, |status| status.phase == Phase::Armed);
}

/// Of orders for one tick the safest is carried out, and one to arm that comes too early does no harm.
#[test]
fn an_order_to_disarm_is_not_overtaken_by_one_to_arm() {
    let mut bench = Bench::new(gateway(Box::new(Hold), true), LATE);
    bench.gateway.order(Order::Arm);
    bench.run_until(2.0, |status| status.phase == Phase::Armed);
    bench.gateway.order(Order::Disarm);
    bench.gateway.order(Order::Arm);
    bench.tick();
    assert_eq!(bench.gateway.status().phase, Phase::Disarmed);
}

#[test]
fn an_emergency_stop_is_released_by_no_order_to_arm() {
    let mut bench = armed(Box::new(Hold));
    bench.gateway.order(Order::EmergencyStop);
    for _ in 0..300 {
        bench.gateway.order(Order::Arm);
        bench.tick();
        assert!(bench.drive_target().is_none_or(|target| !target.enable));
    }
    assert_eq!(bench.gateway.status().blocked, Some(Reason::EmergencyStop));
    bench.gateway.order(Order::Release);
    bench.tick();
    bench.gateway.order(Order::Arm);
    bench.run_until(6.0, |status| status.phase == Phase::Armed);
}

#[test]
fn a_machine_that_gets_no_further_gives_up_and_says_so() {
    let mut bench = armed(goto(25.0, 0.0, 0.0));
    while bench.vehicle.pose.east_m < 5.0 {
        bench.tick();
    }
    bench.faults.wheels_held = true;
    let from_s = bench.now.as_secs_f64();
    let status = bench.run_until(40.0, |status| status.outcome != Outcome::Running);
    let Outcome::Failed(why) = status.outcome else { panic!("{:?}", status.outcome) };
    assert!(why.contains("no progress") && why.contains("m along the path"), "{why}");
    assert!((9.0..12.0).contains(&(bench.now.as_secs_f64() - from_s)));
    bench.tick();
    assert!(bench.drive_target().is_some_and(|target| target.throttle_percent == 0.0));
}

#[test]
fn bus_off_purges_and_needs_a_new_order() {
    let mut bench = armed(Box::new(Hold));
    bench.gateway.on_bus(false);
    bench.tick();
    assert_eq!(bench.gateway.status().blocked, Some(Reason::BusFault));
    assert!(bench.drive_target().is_none());
    bench.gateway.on_bus(true);
    bench.tick();
    assert!(bench.drive_target().is_none());
    bench.gateway.order(Order::Arm);
    bench.run_until(2.0, |status| status.phase == Phase::Armed);
}

#[test]
fn a_script_of_valves_sends_valve_frames_and_targets_that_hold() {
    let mut bench =
        armed(script("[[command]]\nat_s = 0.5\nopening_percent = [10, -10, 5, -20, 30, -30]\n"));
    assert!(bench.sent_of(ArmValve::ID).is_none());
    for _ in 0..60 {
        bench.tick();
    }
    let v = ArmValve::decode(&bench.sent_of(ArmValve::ID).unwrap()).unwrap();
    let percent =
        [v.fr_percent, v.fl_percent, v.mr_percent, v.ml_percent, v.br_percent, v.bl_percent];
    assert_eq!(percent, [10.0, -10.0, 5.0, -20.0, 30.0, -30.0]);
    let target = bench.arm_target().unwrap();
    assert_eq!((target.mode, target.fr_mm), (ArmTargetMode::ManualValve, 510.0));
}

#[test]
fn a_scripted_step_reaches_the_wire_as_a_ramp_in_steps_of_two_millimetres() {
    let mut bench =
        armed(script("[[command]]\nat_s = 0\nstroke_mm = [240, 240, 240, 240, 240, 240]\n"));
    let mut before = 170.0;
    let mut seen_240 = false;
    for _ in 0..300 {
        bench.tick();
        let mm = bench.arm_target().unwrap().fr_mm;
        if mm < 510.0 {
            assert!(mm % 2.0 == 0.0 && mm - before <= 4.0, "{before} to {mm}");
            before = mm;
        }
        seen_240 |= mm == 240.0;
    }
    assert!(seen_240, "{before}");
    assert!(bench.gateway.status().outcome == Outcome::Reached);
}

#[test]
fn every_arm_is_sent_the_target_that_is_its_own() {
    let mut bench =
        armed(script("[[command]]\nat_s = 0\nstroke_mm = [150, 160, 180, 190, 200, 210]\n"));
    let mut seen_mm = None;
    for _ in 0..300 {
        bench.tick();
        let t = bench.arm_target().unwrap();
        if t.mode == ArmTargetMode::ManualPosition {
            seen_mm = Some([t.fr_mm, t.fl_mm, t.mr_mm, t.ml_mm, t.br_mm, t.bl_mm]);
        }
    }
    assert_eq!(seen_mm, Some([150.0, 160.0, 180.0, 190.0, 200.0, 210.0]));
}

/// A node's frames leave in the order in which they were queued: behind a fix's, of low priority, a command
/// would wait for the whole bus.
#[test]
fn commands_leave_before_the_fix_of_their_tick() {
    let mut bench = armed(goto(25.0, 0.0, 0.0));
    let mut fixes = 0;
    for _ in 0..200 {
        bench.tick();
        let ids: Vec<_> = bench.sent.frames().iter().map(|frame| frame.id()).collect();
        if ids.contains(&GnssPosition::ID) {
            assert_eq!(ids[..2], [ArmTarget::ID, DriveTarget::ID]);
            fixes += 1;
        }
    }
    assert!(fixes >= 15, "{fixes}");
}

#[test]
fn counters_of_the_target_frames_go_on_one_by_one() {
    let mut bench = armed(Box::new(Hold));
    let mut before = bench.drive_target().unwrap().counter;
    for _ in 0..40 {
        bench.tick();
        let now = bench.drive_target().unwrap().counter;
        assert!(now == before + 1 || (now == 0 && before >= 14), "{before} {now}");
        before = now;
        assert_eq!(bench.sent_of(DriveTarget::ID).unwrap().data().len(), 8);
    }
}

/// With its counters in step, either of two that command at once would take the other's acknowledgement for its own.
#[test]
fn a_gateway_stops_for_another_one_and_never_begins_beside_it() {
    let mut bench = armed(Box::new(Hold));
    let rival = bench.sent_of(DriveTarget::ID).unwrap();
    bench.gateway.on_frame(bench.now, &rival);
    bench.tick();
    assert_eq!(bench.gateway.status().blocked, Some(Reason::NotAlone));

    let mut bench = Bench::new(gateway(Box::new(Hold), true), LATE);
    for _ in 0..100 {
        bench.gateway.on_frame(bench.now, &rival);
        bench.tick();
        assert!(bench.drive_target().is_none() && bench.arm_target().is_none());
    }
    assert_eq!(bench.gateway.status().blocked, Some(Reason::NotAlone));
    bench.run_until(2.0, |status| status.phase == Phase::Armed);
}

#[test]
fn fixes_without_a_heading_are_counted_as_such() {
    let mut bench = Bench::new(gateway(goto(25.0, 0.0, 0.0), true), LATE);
    bench.faults.gnss_headless = true;
    (0..100).for_each(|_| bench.tick());
    let status = bench.gateway.status();
    assert_eq!((status.armed_at, status.located), (None, None));
    let counts = status.counts;
    assert_eq!([counts.fixes, counts.fixes_refused, counts.fixes_without_heading], [0, 0, 8]);
}

/// As with an origin that nobody has set: the local frame then begins on another continent.
#[test]
fn a_position_that_no_frame_can_say_costs_the_log_nothing_else() {
    let machine = Machine::xt28();
    let origin = Geodetic::from_degrees(-33.9, 18.4, 20.0);
    let config = GatewayConfig { origin, ..GatewayConfig::new(&machine) };
    let mut bench = Bench::new(Gateway::new(&machine, config, Box::new(Hold)), LATE);
    bench.tick();
    assert_eq!(bench.sent_of(GnssPosition::ID), None);
    assert!(bench.sent_of(GnssVelocity::ID).is_some() && bench.sent_of(GnssQuality::ID).is_some());
    assert_eq!(bench.gateway.status().counts.frames_unsent, 1);
}
