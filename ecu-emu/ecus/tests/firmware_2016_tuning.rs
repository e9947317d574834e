//! What the tuning frames of 2016 change, byte by byte, and when (facts 2.2, 3.5).

mod rig_2016;

use rig_2016::Arm;
use xt28_dbc::{CanId, Frame};
use xt28_ecus::Port;
use xt28_ecus::firmware_2016::Quirks;
use xt28_machine::{PerWheel, SimTime};

const HEIGHT: u32 = 0x17FE_000A;
const ATTITUDE: u32 = 0x17FE_000B;
const FORCE: u32 = 0x17FE_000C;
const REFERENCE: u32 = 0x17FE_000D;

fn tune(arm: &mut Arm, id: u32, data: [u8; 8]) {
    let frame = Frame::new(CanId::Extended(id), &data).unwrap();
    arm.ecu.on_frame(SimTime::from_millis(arm.ms), Port::Can1, &frame);
}

/// Levelling with a preset, its references led in.
fn levelling(preset: u8) -> Arm {
    let mut arm = Arm::new(Quirks::firmware());
    arm.until(6.0);
    arm.press(preset);
    start(&mut arm);
    arm
}

/// Levelling anew until its references are led in.
fn start(arm: &mut Arm) {
    arm.press(18);
    arm.ticks(600);
    assert!(arm.is_levelling());
}

/// Button 8 ends levelling, so it starts anew.
fn take_gains(arm: &mut Arm) {
    arm.press(8);
    start(arm);
}

#[test]
fn a_height_reference_acts_at_once_and_its_gain_with_button_8() {
    let mut arm = levelling(11);
    // 1 mA/mm, 260 mm: 10 above where it stands.
    tune(&mut arm, HEIGHT, [0, 0, 1, 0, 0, 0, 4, 1]);
    arm.tick();
    assert_eq!(arm.u_ma(), [-16; 6], "0.1694 of the preset's 10 mA/mm");
    take_gains(&mut arm);
    assert_eq!(arm.u_ma(), [-1; 6], "0.1694 of the 1 mA/mm of the frame");
}

/// A machine that stands level, asked for 5 deg of roll and 2 deg of pitch: a third of the roll's gain
/// a degree, raising the right; -0.1192, 0.0046 and 0.1152 of the pitch's, raising the front.
#[test]
fn attitude_references_act_from_the_next_start_and_gains_with_button_8() {
    let mut arm = levelling(11);
    tune(&mut arm, REFERENCE, [5, 2, 0, 0, 0, 0, 0, 0]);
    // 400 = 0x0190 mA/deg of pitch, 31 of roll.
    tune(&mut arm, ATTITUDE, [0x90, 0x01, 31, 0, 0, 0, 0, 0]);
    arm.ticks(600);
    assert_eq!(arm.u_ma(), [0; 6], "read at the start of a ramp only");
    // A second press ends it, a third begins anew.
    arm.press(18);
    start(&mut arm);
    // Preset 11: 80 / 3 * 5 = 133.3 of roll; 300 * 2 gives -71.5, 2.8, 69.1 of pitch.
    assert_eq!(arm.u_ma(), [-204, 61, -130, 136, -64, 202]);
    take_gains(&mut arm);
    // 31 / 3 * 5 = 51.7 of roll; 400 * 2 gives -95.4, 3.7, 92.2 of pitch.
    assert_eq!(arm.u_ma(), [-147, -43, -47, 55, 40, 143]);
}

/// Both are signed bytes.
#[test]
fn attitude_references_may_be_negative() {
    let mut arm = Arm::new(Quirks::firmware());
    tune(&mut arm, REFERENCE, [0xFB, 0xFE, 0, 0, 0, 0, 0, 0]);
    arm.until(6.0);
    arm.press(11);
    start(&mut arm);
    assert_eq!(arm.u_ma(), [204, -61, 130, -136, 64, -202], "-5 and -2 deg");
}

/// One wheel at half of the load that the others carry. By facts 3.4 the relative errors are 0.291,
/// -0.179, -0.183, 0.014, -0.055 and 0.121, and 150 mA go with a whole one.
#[test]
fn a_force_gain_acts_with_button_8() {
    let mut arm = levelling(10);
    arm.pins.pressure_a_mv = PerWheel::splat(1500.0);
    arm.pins.pressure_a_mv.0[0] = 1000.0;
    tune(&mut arm, FORCE, [0, 150, 0, 0, 0, 0, 0, 0]);
    arm.ticks(300);
    assert_eq!(arm.u_ma(), [0; 6], "preset 10 has none");
    take_gains(&mut arm);
    let wanted = [-43, 26, 27, -2, 8, -18];
    let near =
        arm.u_ma().iter().zip(wanted).all(|(got, wanted): (&i32, i32)| (got - wanted).abs() <= 1);
    assert!(near, "{:?}, not {wanted:?}", arm.u_ma());
}
