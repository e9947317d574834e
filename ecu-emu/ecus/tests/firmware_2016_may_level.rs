//! What the levelling of 2016 asks for before it runs and while it does: time, brake, whole inputs.

mod rig_2016;

use rig_2016::{Arm, only};
use xt28_dbc::messages::ArmDebug2;
use xt28_ecus::firmware_2016::Quirks;
use xt28_machine::SimTime;

fn arm() -> Arm {
    Arm::new(Quirks::firmware())
}

fn levelling() -> Arm {
    let mut arm = arm();
    arm.until(6.0);
    arm.press(11);
    arm.press(18);
    assert!(arm.is_levelling());
    arm
}

/// Whether it levels on with one input at `mv` for longer than the 200 ms of a fault (facts 3.2).
fn levels_on(break_input: impl Fn(&mut Arm)) -> bool {
    let mut arm = levelling();
    break_input(&mut arm);
    arm.ticks(19);
    assert!(arm.is_levelling(), "a fault takes 200 ms");
    arm.ticks(6);
    assert_eq!(arm.display().alert, u8::from(!arm.is_levelling()), "and shows");
    arm.is_levelling()
}

/// Facts 3.8: not before 5 s since boot, and from then on.
#[test]
fn levelling_waits_for_five_seconds_after_power_up() {
    for (press_s, levels) in [(0.0, false), (4.9, false), (4.99, false), (5.0, true)] {
        let mut arm = arm();
        arm.until(press_s);
        arm.press(18);
        assert_eq!(arm.is_levelling(), levels, "pressed at {press_s} s");
    }
}

/// A reset counts as power-up: dark for 250 ms, then the five seconds anew.
#[test]
fn levelling_waits_for_five_seconds_after_a_reset() {
    for (press_s, levels) in [(25.24, false), (25.25, true)] {
        let mut arm = arm();
        arm.until(20.0);
        arm.ecu.reset(SimTime::from_millis(20_000));
        arm.until(20.25);
        arm.tick();
        assert_eq!(arm.out.can1.frames().len(), 32, "its first tick");
        arm.until(press_s);
        arm.press(18);
        assert_eq!(arm.is_levelling(), levels, "pressed at {press_s} s");
    }
}

#[test]
fn levelling_waits_for_the_parking_brake() {
    let mut braked = arm();
    braked.until(6.0);
    braked.status = Some([4, 1]);
    braked.press(18);
    assert!(!braked.is_levelling());
    let seen = ArmDebug2::decode(&only(&braked.out.can1, ArmDebug2::ID)).unwrap().brake_seen;
    assert_eq!(seen, 4);
}

/// Facts 3.9: either frame; seen 50 to 60 ms after, 50 where the last came just before a tick; the valves follow a
/// tick later.
#[test]
fn either_lost_frame_of_the_inertial_unit_ends_levelling() {
    for heard in [[false, false], [true, false], [false, true]] {
        let mut arm = levelling();
        arm.lean_heard = heard;
        let ticks = (1..=30).take_while(|_| {
            arm.tick();
            arm.is_levelling()
        });
        let ms = 10 * (ticks.count() + 1);
        assert_eq!(ms, 50, "ms with {heard:?}");
        arm.ticks(1);
        assert_eq!(arm.u_ma(), [0; 6]);
        arm.ticks(5);
        assert_eq!(arm.display().alert, 1);
    }
}

#[test]
fn a_broken_position_sensor_ends_levelling_but_not_jog() {
    let mut arm = levelling();
    arm.pins.stroke_mv.0[2] = 100.0;
    arm.ticks(19);
    assert!(arm.is_levelling());
    arm.ticks(3);
    assert!(!arm.is_levelling());
    arm.stick_mv = Some([2350, 4300]);
    arm.press(3);
    assert_eq!((arm.u_ma()[0], arm.display().alert), (300, 1));
}

/// Facts 3.2: 200 to 4800 mV, at the front from 450 mV on.
#[test]
fn every_position_sensor_out_of_its_window_ends_levelling() {
    for wheel in 0..6 {
        let low_mv = if wheel < 2 { 450.0 } else { 200.0 };
        let cases = [(low_mv - 1.0, false), (low_mv, true), (4_800.0, true), (4_801.0, false)];
        for (mv, levels) in cases {
            let goes_on = levels_on(|arm| arm.pins.stroke_mv.0[wheel] = mv);
            assert_eq!(goes_on, levels, "stroke {wheel} at {mv} mV");
        }
    }
}

#[test]
fn every_pressure_sensor_out_of_its_window_ends_levelling() {
    for (mv, levels) in [(199.0, false), (200.0, true), (4_800.0, true), (4_801.0, false)] {
        for wheel in 0..6 {
            let goes_on = levels_on(|arm| arm.pins.pressure_a_mv.0[wheel] = mv);
            assert_eq!(goes_on, levels, "A of {wheel} at {mv} mV");
            let goes_on = levels_on(|arm| arm.pins.pressure_b_mv.0[wheel] = mv);
            assert_eq!(goes_on, levels, "B of {wheel} at {mv} mV");
        }
    }
}
