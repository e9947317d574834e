//! Mode manual valve: which openings reach the solenoids, and what shuts them.

mod rig;

use rig::{Arm, HOLD_MM};
use xt28_dbc::Frame;
use xt28_dbc::e2e::{self, AliveCounter};
use xt28_dbc::messages::{
    ArmStatus, ArmStatusMode, ArmStatusReason, ArmStatusState, ArmTargetMode, ArmValve,
};
use xt28_ecus::pins;
use xt28_machine::{PerWheel, Wheel};

/// One tick with a live stream of targets and that frame of openings.
fn tick(arm: &mut Arm, openings: &Frame) -> ArmStatus {
    arm.send(ArmTargetMode::ManualValve, HOLD_MM);
    arm.hear(openings);
    arm.tick()
}

/// One tick with all valves asked for the same opening, + extends.
fn open_all(arm: &mut Arm, percent: f64) -> ArmStatus {
    let openings = arm.openings([percent; 6]);
    tick(arm, &openings)
}

fn total_ma(arm: &Arm) -> f64 {
    arm.out.solenoid_a_ma.sum() + arm.out.solenoid_b_ma.sum()
}

#[test]
fn valves_open_as_told_up_to_the_cap_while_both_streams_live() {
    let mut arm = Arm::new();
    arm.send(ArmTargetMode::ManualValve, HOLD_MM);
    assert_eq!(arm.tick().state, ArmStatusState::Active);
    assert_eq!(total_ma(&arm), 0.0, "no openings yet");
    let openings = arm.openings([80.0, -10.0, 5.0, -15.0, 25.0, -100.0]);
    assert_eq!(tick(&mut arm, &openings).mode, ArmStatusMode::ManualValve);
    // 4 mA per % above 400 mA, up to the cap of 30 %: B extends, A retracts.
    assert_eq!(arm.out.solenoid_b_ma.0, [520.0, 0.0, 420.0, 0.0, 500.0, 0.0]);
    assert_eq!(arm.out.solenoid_a_ma.0, [0.0, 440.0, 0.0, 460.0, 0.0, 520.0]);
    for _ in 0..3 {
        arm.send(ArmTargetMode::ManualValve, HOLD_MM);
        assert_eq!(arm.tick().state, ArmStatusState::Active);
    }
    arm.send(ArmTargetMode::ManualValve, HOLD_MM);
    assert_eq!(arm.tick().state, ArmStatusState::SafeStop, "openings stayed away");
}

/// The mode may come before its first openings, by no more than any command may stay away.
#[test]
fn the_first_openings_may_come_three_periods_after_the_mode() {
    let mut arm = Arm::new();
    let states = [0; 5].map(|_| {
        arm.send(ArmTargetMode::ManualValve, HOLD_MM);
        let status = arm.tick();
        assert_eq!(total_ma(&arm), 0.0);
        status.state
    });
    use ArmStatusState::{Active, SafeStop};
    assert_eq!(states, [Active, Active, Active, Active, SafeStop]);
}

#[test]
fn valves_stay_closed_towards_a_stroke_end() {
    for (stroke_mm, percent, opens) in
        [(0.0, -20.0, false), (0.0, 20.0, true), (501.0, 20.0, false), (501.0, -20.0, true)]
    {
        let mut arm = Arm::new();
        arm.pins.stroke_mv = PerWheel::splat(pins::stroke_mv(stroke_mm * 1e-3));
        assert_eq!(open_all(&mut arm, percent).state, ArmStatusState::Active);
        let wanted_ma = if opens { 6.0 * 480.0 } else { 0.0 };
        assert_eq!(total_ma(&arm), wanted_ma, "{stroke_mm} {percent}");
    }
}

/// A sender that hangs with its last frame in the transmit box would hold the valves open for ever.
#[test]
fn a_sender_that_repeats_one_frame_of_openings_is_stopped_and_stays_stopped() {
    let mut arm = Arm::new();
    let stuck = arm.openings([20.0; 6]);
    assert_eq!(tick(&mut arm, &stuck).state, ArmStatusState::Active);
    for _ in 0..3 {
        let status = tick(&mut arm, &stuck);
        let seen = (status.state, status.reason, total_ma(&arm));
        assert_eq!(seen, (ArmStatusState::Active, ArmStatusReason::Counter, 6.0 * 480.0));
    }
    assert_eq!(tick(&mut arm, &stuck).state, ArmStatusState::SafeStop);
    assert_eq!(total_ma(&arm), 0.0);
    // Rest re-arms the ECU, and the same frame still says nothing.
    for _ in 0..3 {
        arm.send(ArmTargetMode::Off, 0.0);
        arm.tick();
    }
    for _ in 0..10 {
        tick(&mut arm, &stuck);
        assert_eq!(total_ma(&arm), 0.0);
    }
    assert_eq!(arm.ecu.state(), xt28_ecus::State::SafeStop);
}

/// A frame of openings that the arm ECU must refuse.
type BadFrame = fn(&mut Arm) -> Frame;

/// A good frame, then three periods of bad ones: each is refused with that reason, and the last good
/// openings stay.
fn refused_for_three_periods(bad: BadFrame, reason: ArmStatusReason) -> Arm {
    let mut arm = Arm::new();
    open_all(&mut arm, -10.0);
    for _ in 0..3 {
        let frame = bad(&mut arm);
        let status = tick(&mut arm, &frame);
        assert_eq!((status.state, status.reason), (ArmStatusState::Active, reason));
        assert_eq!(arm.solenoids_ma(Wheel::Bl), [440.0, 0.0], "{reason:?}");
    }
    arm
}

#[test]
fn damaged_and_impossible_openings_say_why_and_do_not_feed_the_deadline() {
    let cases: [(BadFrame, ArmStatusReason); 2] = [
        (
            |arm| {
                let mut frame = arm.openings([20.0; 6]);
                frame.data_mut()[2] ^= 0x01;
                frame
            },
            ArmStatusReason::Crc,
        ),
        (
            |arm| {
                // No valve opens by 101 %; the checksum is right for it.
                let mut frame = arm.openings([20.0; 6]);
                let data = frame.data_mut();
                data[3] = 101;
                data[7] = e2e::crc(ArmValve::DATA_ID, &data[..7]);
                frame
            },
            ArmStatusReason::Range,
        ),
    ];
    for (bad, reason) in cases {
        let mut arm = refused_for_three_periods(bad, reason);
        let frame = bad(&mut arm);
        assert_eq!(tick(&mut arm, &frame).state, ArmStatusState::SafeStop, "{reason:?}");
        assert_eq!(total_ma(&arm), 0.0, "{reason:?}");
    }
}

/// Not only the same counter again is refused: an older one is a frame from a queue, and one that leaps
/// by four follows on three that were lost.
#[test]
fn openings_out_of_line_are_refused_while_the_last_good_ones_are_fresh() {
    let older: BadFrame = |arm| {
        // 11, 10 and 9 after 0, at 10, 20 and 30 ms.
        let counter = 12 - (arm.now.as_secs_f64() * 100.0).round() as usize;
        arm.valve = AliveCounter::default();
        (0..counter).for_each(|_| _ = arm.valve.next_count());
        arm.openings([20.0; 6])
    };
    let leaping: BadFrame = |arm| {
        (0..3).for_each(|_| _ = arm.valve.next_count());
        arm.openings([20.0; 6])
    };
    for bad in [older, leaping] {
        refused_for_three_periods(bad, ArmStatusReason::Counter);
    }
}

/// Nobody knows which way such an arm may still go: a stroke at 0 mV reads as 0 mm, one at 5000 mV as
/// fully out, wherever the arm is.
#[test]
fn an_arm_whose_stroke_is_in_doubt_waits_while_the_others_move() {
    for stroke_mv in [0.0, 199.0, 4801.0, 5000.0, f64::NAN] {
        for percent in [20.0, -20.0] {
            let mut arm = Arm::new();
            let whole_mv = arm.pins.stroke_mv;
            open_all(&mut arm, percent);
            assert_eq!(total_ma(&arm), 6.0 * 480.0);
            arm.pins.stroke_mv[Wheel::Mr] = stroke_mv;
            // Up to 200 ms it is doubted, then a fault.
            for _ in 0..20 {
                assert_eq!(open_all(&mut arm, percent).state, ArmStatusState::Active);
                assert_eq!(arm.solenoids_ma(Wheel::Mr), [0.0; 2], "{stroke_mv} mV, {percent} %");
                assert_eq!(total_ma(&arm), 5.0 * 480.0, "the others go on");
            }
            arm.pins.stroke_mv = whole_mv;
            open_all(&mut arm, percent);
            assert_eq!(total_ma(&arm), 6.0 * 480.0, "it is whole again");
        }
    }
}

/// A wire that is out for less than 200 ms at a time is never known for broken. Between times the stroke
/// is read and holds the valve; while it is out, nothing may open it.
#[test]
fn a_loose_wire_does_not_take_the_stroke_s_end_away() {
    for (end_mm, percent, loose_mv) in [(501.0, 20.0, 0.0), (0.0, -20.0, 5000.0)] {
        let mut arm = Arm::new();
        let end_mv = pins::stroke_mv(end_mm * 1e-3);
        for k in 0..210 {
            arm.pins.stroke_mv[Wheel::Fl] = if k % 21 == 0 { end_mv } else { loose_mv };
            let openings = arm.openings([0.0, percent, 0.0, 0.0, 0.0, 0.0]);
            assert_eq!(tick(&mut arm, &openings).state, ArmStatusState::Active);
            assert_eq!(total_ma(&arm), 0.0, "{end_mm} mm, tick {k}");
        }
    }
}
