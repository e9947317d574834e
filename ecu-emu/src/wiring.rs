//! The harness: plant sensors to ECU pins, ECU outputs to plant actuators. No laws, only wires.

use xt28_dbc::Frame;
use xt28_ecus::pins::Calibration;
use xt28_ecus::{ArmOutputs, ArmPins, DriveOutputs, DrivePins, pins};
use xt28_machine::{PerWheel, Wheel};
use xt28_sim::{Actuation, ImuSample, Readings, VehicleState};

use crate::EmulatorConfig;
use crate::power::NOMINAL_MV;

/// What the pendulum-arm ECU's sensors put on its pins.
pub(crate) fn arm_pins(s: &Readings, sensors: &Calibration) -> ArmPins {
    ArmPins {
        stroke_mv: s.stroke_m.map(|stroke_m| sensors.stroke_mv(stroke_m)),
        pressure_a_mv: s.pressure_a_pa.map(pins::pressure_mv),
        pressure_b_mv: s.pressure_b_pa.map(pins::pressure_mv),
        supply_mv: NOMINAL_MV,
    }
}

/// What the transmission ECU's sensors put on its pins.
pub(crate) fn drive_pins(s: &Readings, sensors: &Calibration) -> DrivePins {
    DrivePins {
        joint_front_mv: sensors.joint_front_mv(s.joint_rad[0]),
        joint_rear_mv: sensors.joint_rear_mv(s.joint_rad[1]),
        wheel_hz: s.wheel_speed_rad_s.map(pins::wheel_hz),
        wheel_forward: s.wheel_speed_rad_s.map(|rad_s| rad_s >= 0.0),
        pump_mv: s.pump_pressure_pa.map(pins::pump_mv),
        supply_mv: NOMINAL_MV,
    }
}

/// What the inertial unit sends on its own wire.
pub(crate) fn imu_frames(sample: &ImuSample) -> [Frame; 2] {
    pins::imu_frames(sample.rate_rad_s, sample.specific_force_m_s2)
}

/// What valves, pumps, motors and brake do at the ECUs' currents.
pub(crate) fn actuation(arm: &ArmOutputs, drive: &DriveOutputs, engine_rpm: f64) -> Actuation {
    let (a, b) = (&arm.solenoid_a_ma, &arm.solenoid_b_ma);
    let pump = |i: usize| pins::pump_displacement(drive.pump_ma[2 * i], drive.pump_ma[2 * i + 1]);
    Actuation {
        arm_opening: PerWheel::from_fn(|w: Wheel| pins::valve_opening(a[w], b[w])),
        steer_opening: [
            pins::steer_opening(drive.steer_front_a_ma, drive.steer_front_b_ma),
            pins::steer_opening(drive.steer_rear_a_ma, drive.steer_rear_b_ma),
        ],
        pump_displacement: [pump(0), pump(1)],
        motor_displacement: drive.motor_ma.map(pins::motor_displacement),
        engine_speed_rpm: engine_rpm,
        brake_released: drive.brake_released,
    }
}

/// Opening per stroke error while the arms are set by hand, 1/m.
const SETTING_GAIN_M: f64 = 10.0;
/// Opening per load error, 1/N: 1 kN counts as 5 mm.
const SETTING_GAIN_N: f64 = 5.0e-5;

/// Steeper than this the machine would roll away while its arms are set, rad: what its wheels' rolling
/// resistance holds.
const FREE_TO_ROLL_RAD: f64 = 0.02;

/// A machine whose arms somebody sets before its ECUs run: wheels free to roll on the level, so that
/// none pushes against another, and braked on a slope.
pub(crate) fn setting(config: &EmulatorConfig, s: &VehicleState, engine_rpm: f64) -> Actuation {
    let opening = |w: Wheel| {
        let load = config.load_n.map_or(0.0, |load_n| load_n[w] - s.cylinder_force_n[w]);
        let stroke = config.stroke_m[w] - s.stroke_m[w];
        (SETTING_GAIN_M * stroke + SETTING_GAIN_N * load).clamp(-0.3, 0.3)
    };
    Actuation {
        arm_opening: PerWheel::from_fn(opening),
        brake_released: s.pitch_rad.abs() < FREE_TO_ROLL_RAD,
        ..Actuation::idle(engine_rpm)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_output_moves_what_hangs_on_it() {
        let mut arm = ArmOutputs::default();
        (arm.solenoid_a_ma[Wheel::Fl], arm.solenoid_b_ma[Wheel::Br]) = (600.0, 480.0);
        let drive = DriveOutputs {
            pump_ma: [0.0, 400.0, 605.0, 0.0],
            motor_ma: PerWheel([0.0, 400.0, 0.0, 0.0, 0.0, 650.0]),
            steer_front_a_ma: 730.0,
            steer_rear_b_ma: 572.5,
            ..DriveOutputs::default()
        };
        let moved = actuation(&arm, &drive, 1100.0);
        assert_eq!(moved.arm_opening, PerWheel([0.0, -0.5, 0.0, 0.0, 0.2, 0.0]));
        assert_eq!(moved.pump_displacement, [0.5, -1.0]);
        assert_eq!(moved.motor_displacement, PerWheel([1.0, 0.5, 1.0, 1.0, 1.0, 0.0]));
        assert_eq!(moved.steer_opening, [1.0, -0.5]);
        assert_eq!((moved.engine_speed_rpm, moved.brake_released), (1100.0, false));
        let released = DriveOutputs { brake_released: true, ..drive };
        assert!(actuation(&arm, &released, 1100.0).brake_released);
    }
}
