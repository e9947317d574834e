//! No frame and no voltage breaks the ECUs of 2016; what they put out stays within its bounds.

mod rig_2016;

use std::cell::Cell;

use proptest::prelude::*;
use proptest::test_runner::{Config, TestCaseError, TestRunner};
use rig_2016::{Arm, Drive};
use xt28_dbc::{CanId, Frame};
use xt28_ecus::Port;
use xt28_ecus::firmware_2016::Quirks;
use xt28_machine::{PerWheel, SimTime};

fn any_port() -> impl Strategy<Value = Port> {
    prop::sample::select(vec![Port::Can1, Port::Can2, Port::Can3, Port::Can4])
}

/// Frames, most of them with an identifier that some ECU listens to.
fn any_frame() -> impl Strategy<Value = Frame> {
    let heard: Vec<CanId> = [
        0x17FE_000A_u32,
        0x17FE_000B,
        0x17FE_000C,
        0x17FE_000D,
        0x18FE_030B,
        0x18FE_010B,
        0x18FE_000B,
        0x18FE_1030,
        0x18FE_0315,
        0x18FE_0115,
        0x18FE_0015,
        0x0CF0_0400,
        0x0CF0_0300,
        0x18FE_EE00,
        0x1234_5678,
    ]
    .map(CanId::Extended)
    .into_iter()
    .chain([CanId::Standard(0x1FD), CanId::Standard(0x2FD)])
    .collect();
    (prop::sample::select(heard), prop::collection::vec(any::<u8>(), 0..=8))
        .prop_map(|(id, data)| Frame::new(id, &data).unwrap())
}

fn any_mv() -> impl Strategy<Value = f64> {
    prop_oneof![4 => 300.0..4800.0, 1 => any::<f64>()]
}

fn six(mv: impl Strategy<Value = f64>) -> impl Strategy<Value = PerWheel<f64>> {
    prop::collection::vec(mv, 6).prop_map(|mv| PerWheel(mv.try_into().unwrap()))
}

/// Strokes and pressures: all 18 inputs within their windows (facts 3.2) three times of four, as they
/// come else.
fn any_inputs() -> impl Strategy<Value = [PerWheel<f64>; 3]> {
    let whole = (six(450.0..4800.0), six(200.0..4800.0), six(200.0..4800.0));
    prop_oneof![
        3 => whole.prop_map(|(stroke, a, b)| [stroke, a, b]),
        1 => prop::collection::vec(six(any_mv()), 3).prop_map(|all| all.try_into().unwrap()),
    ]
}

#[derive(Clone, Debug)]
struct ArmCase {
    /// Frames, and how many undisturbed ticks pass after each.
    frames: Vec<(Port, Frame, u32)>,
    inputs: [PerWheel<f64>; 3],
    /// Nose up, right side high.
    lean_deg: [f64; 2],
    supply_mv: f64,
    all_quirks: bool,
    /// A tick may be late by so much.
    late_ms: u64,
}

fn any_arm_case() -> impl Strategy<Value = ArmCase> {
    let frames = prop::collection::vec((any_port(), any_frame(), 0..20_u32), 0..40);
    let lean_deg = prop::array::uniform2(-30.0..30.0);
    let rest = (lean_deg, 9_500.0..60_000.0, any::<bool>(), 0..5_u64);
    (frames, any_inputs(), rest).prop_map(|(frames, inputs, rest)| {
        let (lean_deg, supply_mv, all_quirks, late_ms) = rest;
        ArmCase { frames, inputs, lean_deg, supply_mv, all_quirks, late_ms }
    })
}

const ARM_CASES: u32 = 64;
/// Of those, how many must level with a current on. About two thirds do, so that no draw falls short.
const LEVELLING_MIN: u32 = 20;

/// Whatever is heard and measured, while it levels above all.
#[test]
fn the_arm_ecu_keeps_one_solenoid_a_valve_within_its_currents() {
    let levelling = Cell::new(0);
    let config = Config { cases: ARM_CASES, source_file: Some(file!()), ..Config::default() };
    let kept = TestRunner::new(config).run(&any_arm_case(), |case| {
        levelling.set(levelling.get() + u32::from(levels_within_its_currents(&case)?));
        Ok(())
    });
    kept.unwrap();
    let cases = levelling.get();
    assert!(cases >= LEVELLING_MIN, "it levelled in {cases} cases of {ARM_CASES} only");
}

/// Whether it levelled and had a current on for at least half of its ticks.
fn levels_within_its_currents(case: &ArmCase) -> Result<bool, TestCaseError> {
    let mut quirks = if case.all_quirks { Quirks::firmware() } else { Quirks::none() };
    quirks.negative_readings_wrap = case.all_quirks;
    let mut arm = Arm::new(quirks);
    [arm.pins.stroke_mv, arm.pins.pressure_a_mv, arm.pins.pressure_b_mv] = case.inputs;
    arm.pins.supply_mv = case.supply_mv;
    arm.lean_deg = Some(case.lean_deg);
    // The chair to the front, as an ECU with or without that oddity takes it.
    arm.status = Some([0, u8::from(quirks.chair_inverted)]);
    arm.until(5.0);
    arm.press(12);
    arm.press(18);
    let (mut levelling, mut ticks) = (0, 0);
    let mut check = |arm: &Arm| {
        let works = arm.u_ma().iter().any(|u| *u != 0);
        (levelling, ticks) = (levelling + u32::from(arm.is_levelling() && works), ticks + 1);
        within_its_currents(arm)
    };
    for (port, frame, undisturbed) in &case.frames {
        // Nothing of its kind takes its place before the tick.
        let now = SimTime::from_millis(arm.ms);
        arm.ecu.on_frame(now, *port, frame);
        arm.ecu.tick(now, &arm.pins, &mut arm.out);
        arm.ms += 10 + case.late_ms;
        check(&arm)?;
        for _ in 0..*undisturbed {
            arm.tick();
            arm.ms += case.late_ms;
            check(&arm)?;
        }
    }
    Ok(levelling > ticks / 2)
}

fn within_its_currents(arm: &Arm) -> Result<(), TestCaseError> {
    for (a_ma, b_ma) in arm.out.solenoid_a_ma.0.iter().zip(&arm.out.solenoid_b_ma.0) {
        prop_assert!(*a_ma == 0.0 || *b_ma == 0.0);
        for ma in [a_ma, b_ma] {
            prop_assert!(*ma == 0.0 || (401.0..=800.0).contains(ma), "{} mA", ma);
        }
    }
    prop_assert_eq!(arm.out.can1.frames().len(), 32);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_drive_ecu_keeps_its_currents(
        frames in prop::collection::vec((any_port(), any_frame()), 0..60),
        wheel_hz in prop::array::uniform6(any::<f64>()),
        pump_mv in prop::array::uniform4(any_mv()),
        joints in prop::array::uniform2(any_mv()),
        pedals in prop::array::uniform4(any_mv()),
        all_quirks in any::<bool>(),
        senders in prop::array::uniform2(any::<f64>()),
    ) {
        let mut drive =
            Drive::new(if all_quirks { Quirks::firmware() } else { Quirks::none() });
        drive.press(12);
        drive.press(15);
        drive.pins.wheel_hz = PerWheel(wheel_hz);
        drive.pins.pump_mv = pump_mv;
        [drive.pins.joint_front_mv, drive.pins.joint_rear_mv] = joints;
        drive.cab.gas_mv = [pedals[0], pedals[1]];
        drive.cab.brake_mv = [pedals[2], pedals[3]];
        [drive.cab.fuel_ohm, drive.cab.tank_oil_deg_c] = senders;
        for (port, frame) in &frames {
            drive.ms += 10;
            let now = SimTime::from_millis(drive.ms);
            drive.ecu.on_frame(now, *port, frame);
            drive.ecu.tick(now, &drive.pins, &drive.cab, &mut drive.out);
            let o = &drive.out;
            for ma in o.pump_ma {
                prop_assert!(ma == 0.0 || (197.0..=605.0).contains(&ma), "pump {} mA", ma);
            }
            prop_assert!(o.pump_ma[0] == 0.0 || o.pump_ma[1] == 0.0);
            for ma in o.motor_ma.0 {
                prop_assert!(ma == 0.0 || (155.0..=650.0).contains(&ma), "motor {} mA", ma);
            }
            let steer = [o.steer_front_a_ma, o.steer_front_b_ma, o.steer_rear_a_ma, o.steer_rear_b_ma];
            for ma in steer {
                prop_assert!(ma == 0.0 || (416.0..=730.0).contains(&ma), "steering {} mA", ma);
            }
        }
    }
}
