//! How long the ECUs of 2016 wait for a silent neighbour, where the oddity is off that they wait for ever.

mod rig_2016;

use rig_2016::{Arm, Drive};
use xt28_ecus::firmware_2016::Quirks;

const WATCHED: Quirks = Quirks { silence_freezes_inputs: false, ..Quirks::firmware() };
/// Ticks without a word for which the last one holds: 200 ms.
const HOLDS: usize = 20;

#[test]
fn the_arm_ecu_takes_the_brake_for_on_200_ms_after_the_drive_ecu_spoke() {
    let mut arm = Arm::new(WATCHED);
    arm.until(6.0);
    arm.press(11);
    arm.press(18);
    assert!(arm.is_levelling());
    arm.status = None;
    let levelled = (0..60).take_while(|_| {
        arm.tick();
        arm.is_levelling()
    });
    assert_eq!(levelled.count(), HOLDS);
    assert_eq!(arm.display().alert, 0, "a brake is no fault");
}

#[test]
fn the_drive_ecu_takes_the_stick_for_at_rest_200_ms_after_the_armrest_spoke() {
    let mut drive = Drive::new(WATCHED);
    drive.steer_mv = 466;
    drive.tick();
    assert_eq!(drive.out.steer_front_a_ma, 730.0);
    drive.buttons = None;
    let steered = (0..60).take_while(|_| {
        drive.tick();
        drive.out.steer_front_a_ma == 730.0
    });
    assert_eq!(steered.count(), HOLDS);
    assert_eq!(drive.out.steer_front_a_ma, 0.0);
}
