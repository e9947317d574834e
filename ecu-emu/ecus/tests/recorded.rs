//! Control laws and force estimate against a recorded machine: its commands and sensor readings in,
//! its currents and loads expected out.
//!
//! `recorded/arm_step_fr.csv`: front right arm in steps of 150 and 190 mm, rows repeated for
//! `ticks`. `recorded/s_turn_steering.csv`: first 12 s of an S-turn; currents every other tick, as
//! they were sent, in steps of 3 mA. `recorded/loads.csv`: single moments of three arms, all runs.

use std::time::Duration;

use xt28_dbc::messages::{ArmTarget, ArmTargetMode, CylLoadFront, DriveTarget, WheelForceFront};
use xt28_ecus::{ArmEcu, ArmOutputs, ArmPins, DriveEcu, DriveOutputs, DrivePins, Port, pins};
use xt28_machine::{Machine, PerWheel, SimTime, Wheel};

const ARM_STEP: &str = include_str!("recorded/arm_step_fr.csv");
const S_TURN: &str = include_str!("recorded/s_turn_steering.csv");
const LOADS: &str = include_str!("recorded/loads.csv");
const TICK: Duration = Duration::from_millis(10);

fn rows(csv: &str) -> impl Iterator<Item = Vec<Option<f64>>> {
    csv.lines().skip(1).map(|line| {
        let number = |cell: &str| (!cell.is_empty()).then(|| cell.parse().expect("a number"));
        line.split(',').map(number).collect()
    })
}

#[test]
fn the_arm_currents_are_the_recorded_ones_to_the_milliampere() {
    let mut ecu = ArmEcu::new(&Machine::xt28());
    let (mut out, mut now, mut ticks) = (ArmOutputs::default(), SimTime::ZERO, 0_u8);
    for row in rows(ARM_STEP) {
        let [Some(repeats), Some(mm), Some(stroke_mm), Some(a_ma), Some(b_ma)] = row[..] else {
            panic!("{row:?}")
        };
        // The record has the stroke cut off to whole mm: anywhere in that mm gives it again.
        let stroke_mv = pins::stroke_mv((stroke_mm + 0.5) * 1e-3);
        let pins = ArmPins {
            stroke_mv: PerWheel::splat(stroke_mv),
            pressure_a_mv: PerWheel::splat(pins::pressure_mv(5e6)),
            pressure_b_mv: PerWheel::splat(pins::pressure_mv(5e5)),
            supply_mv: 24_000.0,
        };
        for _ in 0..repeats as u32 {
            let target = ArmTarget {
                fr_mm: mm,
                fl_mm: mm,
                mr_mm: mm,
                ml_mm: mm,
                br_mm: mm,
                bl_mm: mm,
                mode: ArmTargetMode::ManualPosition,
                counter: ticks % 16,
            };
            ecu.on_frame(now, Port::Can1, &target.encode().unwrap());
            ecu.tick(now, &pins, &mut out);
            for wheel in Wheel::ALL {
                let got = [out.solenoid_a_ma[wheel], out.solenoid_b_ma[wheel]];
                assert_eq!(got, [a_ma, b_ma], "{now}: target {mm} mm, stroke {stroke_mm} mm");
            }
            now += TICK;
            ticks = ticks.wrapping_add(1);
        }
    }
    assert_eq!(now, SimTime::from_millis(32_000));
}

#[test]
fn the_steering_currents_are_the_recorded_ones_to_the_frame_s_step() {
    let mut ecu = DriveEcu::new(&Machine::xt28());
    let (mut out, mut now, mut compared) = (DriveOutputs::default(), SimTime::ZERO, 0);
    for (row, counter) in rows(S_TURN).zip((0..16).cycle()) {
        let [Some(target), Some(front), Some(rear), Some(wheels)] = row[..4] else {
            panic!("{row:?}")
        };
        // Sum of six wheels in 0.1 rpm.
        let wheel_rad_s = wheels / 60.0 * std::f64::consts::TAU / 60.0;
        let pins = DrivePins {
            joint_front_mv: pins::joint_front_mv((front / 100.0_f64).to_radians()),
            joint_rear_mv: pins::joint_rear_mv((rear / 100.0_f64).to_radians()),
            wheel_hz: PerWheel::splat(pins::wheel_hz(wheel_rad_s)),
            wheel_forward: PerWheel::splat(wheels >= 0.0),
            pump_mv: [pins::pump_mv(25e5); 4],
            supply_mv: 24_000.0,
        };
        let command = DriveTarget {
            throttle_percent: 55.0,
            front_angle_deg: target / 100.0,
            engine_speed_rpm: 1200.0,
            brake: false,
            enable: true,
            counter,
        };
        ecu.on_frame(now, Port::Can1, &command.encode().unwrap());
        ecu.tick(now, &pins, &mut out);
        if let [Some(front_a), Some(front_b), Some(rear_a), Some(rear_b)] = row[4..] {
            let got = [
                out.steer_front_a_ma,
                out.steer_front_b_ma,
                out.steer_rear_a_ma,
                out.steer_rear_b_ma,
            ];
            for (got, recorded) in got.into_iter().zip([front_a, front_b, rear_a, rear_b]) {
                assert!((got - recorded).abs() <= 1.5 + 1e-6, "{now}: {got} for {recorded} mA");
            }
            compared += u32::from(front_a + front_b > 0.0);
        }
        now += TICK;
    }
    assert!(compared > 300, "only {compared} rows steer");
}

#[test]
fn loads_and_wheel_forces_are_the_recorded_ones_to_the_decanewton() {
    let mut out = ArmOutputs::default();
    for row in rows(LOADS) {
        let [Some(stroke_mm), Some(a_kpa), Some(b_kpa), Some(load_dan), Some(force_dan)] = row[..]
        else {
            panic!("{row:?}")
        };
        // The recorded pressures are filtered ones, cut off to whole kPa; a filter that begins
        // with them stays there.
        let pins = ArmPins {
            stroke_mv: PerWheel::splat(pins::stroke_mv((stroke_mm + 0.5) * 1e-3)),
            pressure_a_mv: PerWheel::splat(pins::pressure_mv((a_kpa + 0.5) * 1e3)),
            pressure_b_mv: PerWheel::splat(pins::pressure_mv((b_kpa + 0.5) * 1e3)),
            supply_mv: 24_000.0,
        };
        ArmEcu::new(&Machine::xt28()).tick(SimTime::ZERO, &pins, &mut out);
        let find = |id| out.can1.frames().iter().find(|frame| frame.id() == id).unwrap();
        let load = CylLoadFront::decode(find(CylLoadFront::ID)).unwrap();
        assert_eq!(load.fr_dan, load_dan, "{row:?}");
        let force = WheelForceFront::decode(find(WheelForceFront::ID)).unwrap();
        assert_eq!(force.fr_dan, force_dan, "{row:?}");
    }
}
