//! Where an input begins to fail, a little on either side of what `docs/diagnostics.md` says.

mod rig;

use rig::{Arm, Drive};
use xt28_ecus::pins;
use xt28_machine::{PerWheel, Wheel};

/// Fault bits of a position sensor, of a joint sensor, and of a wheel speed sensor.
const POSITION: u16 = 1 << 0;
const JOINT: u16 = 1 << 0;
const WHEEL_SPEED: u16 = 1 << 1;
const TICK_S: f64 = 0.01;
const RADIUS_M: f64 = 0.74;

/// Whether a stroke that swings at this speed, up in one tick and down in the next, is a fault.
fn stroke_fails(m_s: f64) -> bool {
    let mut arm = Arm::new();
    let faults = (0..20).map(|tick| {
        let swing_m = f64::from(tick % 2) * m_s * TICK_S;
        arm.pins.stroke_mv[Wheel::Ml] = pins::stroke_mv(0.17 + swing_m);
        arm.tick().faults
    });
    faults.last().unwrap() & POSITION != 0
}

/// The same of the front joint, to the right, where its sensor is the steepest.
fn joint_fails(deg_s: f64) -> bool {
    let mut drive = Drive::new(0.0);
    let faults = (0..20).map(|tick| {
        let swing_deg = f64::from(tick % 2) * deg_s * TICK_S;
        drive.pins.joint_front_mv = pins::joint_front_mv((-10.0 - swing_deg).to_radians());
        drive.tick().faults
    });
    faults.last().unwrap() & JOINT != 0
}

/// Whether a wheel without pulses is a fault after so many ticks, while the others roll at this speed.
fn silent_wheel_fails(m_s: f64, ticks: usize) -> bool {
    let mut drive = Drive::new(0.0);
    drive.pins.wheel_hz = PerWheel::splat(pins::wheel_hz(m_s / RADIUS_M));
    drive.pins.wheel_hz[Wheel::Mr] = 0.0;
    let faults = (0..ticks).map(|_| drive.tick().faults);
    faults.last().unwrap() & WHEEL_SPEED != 0
}

#[test]
fn a_stroke_leaps_above_0_85_m_s() {
    assert_eq!([0.84, 0.86].map(stroke_fails), [false, true]);
}

#[test]
fn a_joint_leaps_above_100_deg_s() {
    assert_eq!([99.0, 101.0].map(joint_fails), [false, true]);
}

#[test]
fn a_wheel_without_pulses_is_missed_after_a_second_above_0_3_m_s() {
    assert_eq!([0.29, 0.31].map(|m_s| silent_wheel_fails(m_s, 110)), [false, true]);
    assert_eq!([100, 101].map(|ticks| silent_wheel_fails(0.5, ticks)), [false, true]);
}
