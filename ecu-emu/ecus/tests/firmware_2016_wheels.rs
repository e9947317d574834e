//! The arm ECU of 2016: which wheels a button moves or puts on its accumulators, and which count as carrying.

mod rig_2016;

use rig_2016::{Arm, only};
use xt28_dbc::messages::{OptLoadRear, WheelForceFront};
use xt28_ecus::firmware_2016::Quirks;
use xt28_machine::Wheel;

fn arm() -> Arm {
    Arm::new(Quirks::firmware())
}

/// The one wheel that a button jogs, with the chair byte so.
fn jogged(button: u8, chair: u8) -> usize {
    let mut arm = arm();
    arm.status = Some([0, chair]);
    arm.stick_mv = Some([2350, 4300]);
    arm.press(button);
    let moved: Vec<usize> = (0..6).filter(|wheel| arm.u_ma()[*wheel] != 0).collect();
    assert_eq!((moved.len(), arm.u_ma()[moved[0]]), (1, 300), "button {button}");
    moved[0]
}

/// Facts 3.8: buttons 1, 3, 4, 6, 7, 9 are FL FR ML MR BL BR, seen from where the chair faces. Chair byte 1 is
/// the front to this ECU.
#[test]
fn every_jog_button_moves_the_wheel_at_its_place_from_either_chair() {
    let buttons = [1, 3, 4, 6, 7, 9];
    assert_eq!(buttons.map(|button| jogged(button, 1)), [1, 0, 3, 2, 5, 4]);
    assert_eq!(buttons.map(|button| jogged(button, 0)), [4, 5, 2, 3, 0, 1]);
}

/// Facts 3.7: 17 all or none, 2 the front pair, 5 front and rear.
#[test]
fn each_accumulator_button_has_its_wheels() {
    let mut arm = arm();
    let mut after = |button| {
        arm.press(button);
        arm.out.accumulator_on.0
    };
    let (none, all) = ([false; 6], [true; 6]);
    assert_eq!([after(17), after(17)], [all, none]);
    assert_eq!(after(2), [true, true, false, false, false, false]);
    assert_eq!(after(5), [true, true, false, false, true, true]);
    assert_eq!(after(17), all);
}

/// Facts 3.3: the weight is the sum of the wheels that press; one whose arm hangs takes nothing off it.
#[test]
fn a_hanging_wheel_takes_nothing_off_the_weight() {
    // 8 MPa in A but for FR, which has them in B; 0.5 V are none.
    let mut arm = arm();
    arm.pins.pressure_a_mv.0 = [500.0, 1780.0, 1780.0, 1780.0, 1780.0, 1780.0];
    arm.pins.pressure_b_mv[Wheel::Fr] = 1780.0;
    arm.ticks(300);
    let front = WheelForceFront::decode(&only(&arm.out.can1, WheelForceFront::ID)).unwrap();
    assert!(front.fr_dan < -2000.0 && front.fl_dan > 2000.0, "{front:?}");
    let sum = OptLoadRear::decode(&only(&arm.out.can1, OptLoadRear::ID)).unwrap().sum_positive_dan;
    assert_eq!(sum, 5.0 * front.fl_dan, "all strokes are alike");
}
