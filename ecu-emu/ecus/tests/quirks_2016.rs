//! Every oddity of the firmware of 2016, on and off, as it shows on the ECUs' frames and outputs.

mod rig_2016;

use rig_2016::{Arm, Drive, only, stroke_mv};
use xt28_dbc::messages::{
    ArmDebug1, DriveDebug5, PosFront, PressFront, TuneReference, VelFront, WheelForceFront,
    WheelSpeed, WheelSpeedJoint,
};
use xt28_ecus::Port;
use xt28_ecus::firmware_2016::Quirks;
use xt28_machine::{PerWheel, SimTime};

/// What one oddity changes, and by how much.
struct Shown {
    name: &'static str,
    measure: fn(Quirks) -> f64,
    on: f64,
    off: f64,
    within: f64,
}

macro_rules! shown {
    ($($name:ident: $on:literal, $off:literal, within $within:literal;)+) => {
        const SHOWN: &[Shown] =
            &[$(Shown { name: stringify!($name), measure: $name, on: $on, off: $off, within: $within }),+];

        mod changes_what_it_says_and_by_how_much {
            $(#[test] fn $name() { super::holds(stringify!($name)); })+
        }
    };
}

shown! {
    force_closed_length_0_82: 3911.0, 3962.0, within 2.0;
    negative_readings_wrap: 65_534.0, 0.0, within 0.0;
    stroke_rate_for_20_ms: 80.0, 180.0, within 0.0;
    filters_cut_off: 4984.0, 4999.0, within 0.0;
    filters_start_at_zero: 591.0, 10_000.0, within 0.0;
    pitch_by_arm_geometry: 0.0, 141.0, within 3.0;
    height_shared_alike: -16.0, -23.0, within 0.0;
    pitch_shares_interchanged: 69.0, 71.0, within 0.0;
    joystick_lopsided: -245.0, -300.0, within 0.0;
    unheard_input_reads_0_mv: -293.0, 0.0, within 0.0;
    chair_inverted: 5.0, 0.0, within 0.0;
    repeated_press_swallowed: 0.0, 1.0, within 0.0;
    passive_byte_by_button_17: 0.0, 1.0, within 0.0;
    imu_watched_in_levelling_only: 0.0, 1.0, within 0.0;
    silence_freezes_inputs: 730.0, 0.0, within 0.0;
    wheel_1_sent_four_times: 1.0, 2.0, within 0.01;
    speed_inputs_5_6_crossed: 6.0, 5.0, within 0.01;
    frequency_in_tenths_of_hz: 12.9, 1.29, within 0.02;
    load_offset_winds_up: 313.0, 605.0, within 3.0;
    load_not_available_is_255: 313.0, 605.0, within 3.0;
    neutral_refused_under_pedal: 4.0, 1.0, within 0.0;
    slip_gain_cut_to_2: 220.0, 265.0, within 2.0;
    motor_current_wraps: 650.0, 0.0, within 0.0;
    pump_regulator_on_a_side: 25.0, 0.0, within 1.0;
    follower_gate_is_a_step: 0.0, 423.0, within 0.0;
    follower_holds_current_in_dead_band: 436.0, 0.0, within 1.0;
    follower_current_unlimited: 627.0, 500.0, within 0.0;
    first_turn_press_skips_combined: 64.0, 16.0, within 0.0;
    debug_frames_sent_twice: 2.0, 1.0, within 0.0;
}

fn holds(name: &str) {
    let Shown { measure, on, off, within, .. } =
        SHOWN.iter().find(|shown| shown.name == name).expect("listed above");
    for (state, wanted) in [(true, on), (false, off)] {
        let mut quirks = Quirks::firmware();
        quirks.set(name, state).unwrap();
        let got = measure(quirks);
        assert!((got - wanted).abs() <= *within, "{name} = {state}: {got}, not {wanted}");
    }
}

#[test]
fn no_switch_is_left_out() {
    let shown: Vec<&str> = SHOWN.iter().map(|shown| shown.name).collect();
    let listed: Vec<&str> = Quirks::firmware().list().iter().map(|(name, _)| *name).collect();
    assert_eq!(shown, listed, "a test each, in the order of the code");
}

/// The page that declares every switch says the same defaults and figures as the code.
#[test]
fn the_documented_table_has_every_switch_with_its_default_and_its_figures() {
    let page = include_str!("../../../docs/firmware-2016.md");
    let rows: Vec<Vec<&str>> = page
        .lines()
        .filter(|line| line.starts_with("| `") && line.split('|').count() == 6)
        .map(|line| line.split('|').map(str::trim).collect())
        .collect();
    let listed = Quirks::firmware().list();
    let names: Vec<String> = listed.iter().map(|(name, _)| format!("`{name}`")).collect();
    let documented: Vec<&str> = rows.iter().map(|row| row[1]).collect();
    assert_eq!(documented, names, "one row a switch, in the order of the code");
    for ((name, default), row) in listed.iter().zip(&rows) {
        assert_eq!(row[2], if *default { "on" } else { "**off**" }, "{name}");
        let shown = SHOWN.iter().find(|shown| shown.name == *name).expect("measured above");
        let figures = format!("{} / {}", shown.on, shown.off);
        assert!(row[4].contains(&figures), "{name}: {} does not say {figures}", row[4]);
    }
}

fn force_closed_length_0_82(quirks: Quirks) -> f64 {
    let mut arm = Arm::new(quirks);
    arm.pins.pressure_a_mv = PerWheel::splat(2100.0);
    arm.until(10.0);
    // 9984 kPa (it stalls 16 short) on 78.5 cm2 are 7837 daN.
    WheelForceFront::decode(&only(&arm.out.can1, WheelForceFront::ID)).unwrap().fr_dan
}

fn negative_readings_wrap(quirks: Quirks) -> f64 {
    let mut arm = Arm::new(quirks);
    arm.pins.stroke_mv = PerWheel::splat(480.0);
    arm.tick();
    PosFront::decode(&only(&arm.out.can1, PosFront::ID)).unwrap().fl_mm
}

/// 100 mm/s; the frame's scale is made for the oddity, so it reads 180 without.
fn stroke_rate_for_20_ms(quirks: Quirks) -> f64 {
    let mut arm = Arm::new(quirks);
    for mm in 100..250 {
        arm.pins.stroke_mv = PerWheel::splat(stroke_mv(mm));
        arm.tick();
    }
    VelFront::decode(&only(&arm.out.can1, VelFront::ID)).unwrap().fr_mm_s
}

fn pressure_kpa(arm: &Arm) -> f64 {
    PressFront::decode(&only(&arm.out.can1, PressFront::ID)).unwrap().fl_a_kpa
}

fn filters_cut_off(quirks: Quirks) -> f64 {
    let mut arm = Arm::new(quirks);
    arm.pins.pressure_a_mv = PerWheel::splat(1300.0);
    arm.until(4.0);
    pressure_kpa(&arm)
}

fn filters_start_at_zero(quirks: Quirks) -> f64 {
    let mut arm = Arm::new(quirks);
    arm.pins.pressure_a_mv = PerWheel::splat(2100.0);
    arm.tick();
    pressure_kpa(&arm)
}

/// Levelling with preset 11, led in.
fn levelling(arm: &mut Arm) {
    arm.until(6.0);
    arm.press(11);
    arm.press(18);
    arm.until(13.0);
    assert!(arm.is_levelling());
    assert_eq!(ArmDebug1::decode(&only(&arm.out.can1, ArmDebug1::ID)).unwrap().preset, 2);
}

/// The nose is up by 4 deg, yet the wheels are in the plane of the chassis.
fn pitch_by_arm_geometry(quirks: Quirks) -> f64 {
    let mut arm = Arm::new(quirks);
    arm.lean_deg = Some([4.0, 0.0]);
    levelling(&mut arm);
    f64::from(arm.u_ma()[0])
}

fn height_shared_alike(quirks: Quirks) -> f64 {
    let mut arm = Arm::new(quirks);
    arm.pins.stroke_mv = PerWheel::splat(stroke_mv(240));
    levelling(&mut arm);
    f64::from(arm.u_ma()[0])
}

fn pitch_shares_interchanged(quirks: Quirks) -> f64 {
    let mut arm = Arm::new(quirks);
    let wanted = TuneReference { roll_deg: 0.0, pitch_deg: 2.0 }.encode().unwrap();
    arm.ecu.on_frame(SimTime::ZERO, Port::Can1, &wanted);
    levelling(&mut arm);
    f64::from(arm.u_ma()[4])
}

fn jogged(arm: &mut Arm) -> i32 {
    arm.press(3);
    arm.u_ma().iter().sum()
}

fn joystick_lopsided(quirks: Quirks) -> f64 {
    let mut arm = Arm::new(quirks);
    arm.stick_mv = Some([2350, 350]);
    f64::from(jogged(&mut arm))
}

fn unheard_input_reads_0_mv(quirks: Quirks) -> f64 {
    let mut arm = Arm::new(quirks);
    arm.stick_mv = None;
    f64::from(jogged(&mut arm))
}

/// Which wheel the button for front right moves when the chair is to the front.
fn chair_inverted(quirks: Quirks) -> f64 {
    let mut arm = Arm::new(quirks);
    arm.status = Some([0, 0]);
    arm.stick_mv = Some([2350, 4300]);
    jogged(&mut arm);
    arm.u_ma().iter().position(|u| *u != 0).expect("one moves") as f64
}

/// Levelling ended by the brake: is the next press of its button taken?
fn repeated_press_swallowed(quirks: Quirks) -> f64 {
    let mut arm = Arm::new(quirks);
    levelling(&mut arm);
    arm.status = Some([4, 1]);
    arm.ticks(2);
    assert!(!arm.is_levelling());
    arm.status = Some([0, 1]);
    arm.press(18);
    f64::from(arm.display().levelling)
}

fn passive_byte_by_button_17(quirks: Quirks) -> f64 {
    let mut arm = Arm::new(quirks);
    arm.press(2);
    assert_eq!(arm.out.accumulator_on.0, [true, true, false, false, false, false]);
    f64::from(arm.display().passive)
}

fn imu_watched_in_levelling_only(quirks: Quirks) -> f64 {
    let mut arm = Arm::new(quirks);
    arm.lean_deg = None;
    arm.until(1.0);
    f64::from(arm.display().alert)
}

fn silence_freezes_inputs(quirks: Quirks) -> f64 {
    let mut drive = Drive::new(quirks);
    drive.steer_mv = 466;
    drive.tick();
    assert_eq!(drive.out.steer_front_a_ma, 730.0);
    drive.buttons = None;
    drive.ticks(100);
    drive.out.steer_front_a_ma
}

/// Wheels 1 to 6 at 1 to 6 rpm.
fn speeds(quirks: Quirks) -> Drive {
    let mut drive = Drive::new(quirks);
    drive.counts([100.0, 200.0, 300.0, 400.0, 500.0, 600.0]);
    drive.tick();
    drive
}

fn wheel_1_sent_four_times(quirks: Quirks) -> f64 {
    let drive = speeds(quirks);
    WheelSpeed::decode(&only(&drive.out.can1, WheelSpeed::ID)).unwrap().wheel2_rpm
}

fn speed_inputs_5_6_crossed(quirks: Quirks) -> f64 {
    let drive = speeds(quirks);
    WheelSpeedJoint::decode(&only(&drive.out.can1, WheelSpeedJoint::ID)).unwrap().wheel5_rpm
}

fn frequency_in_tenths_of_hz(quirks: Quirks) -> f64 {
    let mut drive = Drive::new(quirks);
    drive.pins.wheel_hz = PerWheel::splat(696.0);
    drive.tick();
    WheelSpeed::decode(&only(&drive.out.can1, WheelSpeed::ID)).unwrap().wheel1_rpm
}

/// Forward, full pedal for ten seconds.
fn driven(quirks: Quirks, load_percent: f64) -> Drive {
    let mut drive = Drive::new(quirks);
    drive.press(12);
    drive.load_percent = load_percent;
    drive.gas(1.0);
    drive.ticks(1000);
    drive
}

fn load_offset_winds_up(quirks: Quirks) -> f64 {
    let mut drive = driven(quirks, 100.0);
    drive.load_percent = 0.0;
    drive.ticks(1000);
    drive.out.pump_ma[1]
}

fn load_not_available_is_255(quirks: Quirks) -> f64 {
    driven(quirks, 255.0).out.pump_ma[1]
}

fn neutral_refused_under_pedal(quirks: Quirks) -> f64 {
    let mut drive = driven(quirks, 0.0);
    drive.press(11);
    f64::from(drive.status().drive_mode)
}

/// Current of motor 1 when its wheel turns at `first` and the others at `others` counts.
fn slipping(quirks: Quirks, first: f64, others: f64) -> f64 {
    let mut drive = Drive::new(quirks);
    drive.press(12);
    drive.counts([first, others, others, others, others, others]);
    drive.ticks(6000);
    drive.out.motor_ma.0[0]
}

fn slip_gain_cut_to_2(quirks: Quirks) -> f64 {
    slipping(quirks, 550.0, 370.0)
}

fn motor_current_wraps(quirks: Quirks) -> f64 {
    slipping(quirks, 0.0, 480.0)
}

/// What the regulator adds to the second demand while pump 1's A side is 300 bar above.
fn pump_regulator_on_a_side(quirks: Quirks) -> f64 {
    let mut drive = driven(quirks, 0.0);
    drive.gas(0.5);
    drive.press(9);
    drive.pins.pump_mv = [2500.0, 500.0, 500.0, 500.0];
    drive.ticks(1000);
    let frame = *drive.out.can1.frames().iter().find(|f| f.id() == DriveDebug5::ID).unwrap();
    let debug = DriveDebug5::decode(&frame).unwrap();
    f64::from(debug.demand2 - debug.demand1)
}

fn following(quirks: Quirks) -> Drive {
    let mut drive = Drive::new(quirks);
    drive.press(15);
    if drive.status().turn_mode != 64 {
        drive.press(15);
    }
    drive
}

fn follower_gate_is_a_step(quirks: Quirks) -> f64 {
    let mut drive = following(quirks);
    drive.counts([25.0; 6]);
    drive.joints(5.0, 0.0);
    drive.ticks(3);
    drive.out.steer_rear_a_ma
}

fn follower_holds_current_in_dead_band(quirks: Quirks) -> f64 {
    let mut drive = following(quirks);
    drive.joints(5.0, 0.0);
    drive.ticks(1000);
    assert!(drive.out.steer_rear_a_ma > 430.0);
    drive.joints(5.0, 5.2);
    drive.ticks(2);
    drive.out.steer_rear_a_ma
}

fn follower_current_unlimited(quirks: Quirks) -> f64 {
    let mut drive = following(quirks);
    drive.counts([100.0; 6]);
    drive.joints(25.0, -25.0);
    drive.ticks(1000);
    drive.out.steer_rear_a_ma
}

fn first_turn_press_skips_combined(quirks: Quirks) -> f64 {
    let mut drive = Drive::new(quirks);
    drive.press(15);
    f64::from(drive.status().turn_mode)
}

fn debug_frames_sent_twice(quirks: Quirks) -> f64 {
    let drive = Drive::new(quirks);
    let sent = drive.out.can1.frames().iter().filter(|frame| frame.id() == DriveDebug5::ID);
    sent.count() as f64
}
