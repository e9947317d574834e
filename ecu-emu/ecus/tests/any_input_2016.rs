//! No frame and no voltage breaks the ECUs of 2016; what they put out stays within its bounds.

mod rig_2016;

use proptest::prelude::*;
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

fn six() -> impl Strategy<Value = PerWheel<f64>> {
    prop::array::uniform6(any_mv()).prop_map(PerWheel)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_arm_ecu_keeps_one_solenoid_a_valve_within_its_currents(
        frames in prop::collection::vec((any_port(), any_frame()), 0..40),
        strokes in six(),
        pressures in prop::array::uniform2(six()),
        supply_mv in 9_500.0..60_000.0,
        all_quirks in any::<bool>(),
        ticks_between in 1_u64..200,
    ) {
        let mut quirks = if all_quirks { Quirks::firmware() } else { Quirks::none() };
        quirks.negative_readings_wrap = all_quirks;
        let mut arm = Arm::new(quirks);
        arm.pins.stroke_mv = strokes;
        [arm.pins.pressure_a_mv, arm.pins.pressure_b_mv] = pressures;
        arm.pins.supply_mv = supply_mv;
        arm.until(5.0);
        arm.press(12);
        arm.press(18);
        for (at, (port, frame)) in frames.iter().enumerate() {
            let now = SimTime::from_millis(6000 + 10 * ticks_between * at as u64);
            arm.ecu.on_frame(now, *port, frame);
            arm.ecu.tick(now, &arm.pins, &mut arm.out);
            for (a_ma, b_ma) in arm.out.solenoid_a_ma.0.iter().zip(&arm.out.solenoid_b_ma.0) {
                prop_assert!(*a_ma == 0.0 || *b_ma == 0.0);
                for ma in [a_ma, b_ma] {
                    prop_assert!(*ma == 0.0 || (401.0..=800.0).contains(ma), "{} mA", ma);
                }
            }
            prop_assert_eq!(arm.out.can1.frames().len(), 32);
        }
    }

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
