//! Each ECU alone on a bench, with its sender and its sensors at hand, tick by tick.
#![allow(dead_code)] // each test file uses its part

use xt28_dbc::e2e::AliveCounter;
use xt28_dbc::messages::{
    ArmStatus, ArmTarget, ArmTargetMode, ArmValve, DriveStatus, DriveTarget, Eec1,
};
use xt28_dbc::{CanId, Frame, Outbox};
use xt28_ecus::{ArmEcu, ArmOutputs, ArmPins, DriveEcu, DriveOutputs, DrivePins, Port, pins};
use xt28_machine::{Machine, PerWheel, SimTime, Wheel};

/// Raw 255 at 2 mm a bit: the arm is held, or not spoken of.
pub(crate) const HOLD_MM: f64 = 510.0;
/// What the drive's sender asks of the engine, rpm.
const ENGINE_RPM: f64 = 1500.0;

pub(crate) fn frame_of(outbox: &Outbox, id: CanId) -> Frame {
    *outbox.frames().iter().find(|frame| frame.id() == id).expect("sent every tick")
}

/// The arm ECU, with every arm at 170 mm on level ground.
pub(crate) struct Arm {
    pub(crate) ecu: ArmEcu,
    pub(crate) now: SimTime,
    pub(crate) pins: ArmPins,
    /// The inertial unit speaks.
    pub(crate) imu: bool,
    pub(crate) out: ArmOutputs,
    pub(crate) target: AliveCounter,
    pub(crate) valve: AliveCounter,
}

impl Arm {
    pub(crate) fn new() -> Self {
        let pins = ArmPins {
            stroke_mv: PerWheel::splat(pins::stroke_mv(0.17)),
            pressure_a_mv: PerWheel::splat(pins::pressure_mv(7e6)),
            pressure_b_mv: PerWheel::splat(pins::pressure_mv(5e5)),
            supply_mv: 24_000.0,
        };
        Self {
            ecu: ArmEcu::new(&Machine::xt28()),
            now: SimTime::ZERO,
            pins,
            imu: true,
            out: ArmOutputs::default(),
            target: AliveCounter::default(),
            valve: AliveCounter::default(),
        }
    }

    /// The sender's next frame; FL is held whatever the others are asked for.
    pub(crate) fn target(&mut self, mode: ArmTargetMode, mm: f64) -> Frame {
        let counter = self.target.next_count();
        ArmTarget {
            fr_mm: mm,
            fl_mm: HOLD_MM,
            mr_mm: mm,
            ml_mm: mm,
            br_mm: mm,
            bl_mm: mm,
            mode,
            counter,
        }
        .encode()
        .unwrap()
    }

    /// The next frame of openings, + extends.
    pub(crate) fn openings(&mut self, percent: [f64; 6]) -> Frame {
        let [fr_percent, fl_percent, mr_percent, ml_percent, br_percent, bl_percent] = percent;
        let counter = self.valve.next_count();
        ArmValve { fr_percent, fl_percent, mr_percent, ml_percent, br_percent, bl_percent, counter }
            .encode()
            .unwrap()
    }

    pub(crate) fn hear(&mut self, frame: &Frame) {
        self.ecu.on_frame(self.now, Port::Can1, frame);
    }

    pub(crate) fn send(&mut self, mode: ArmTargetMode, mm: f64) {
        let frame = self.target(mode, mm);
        self.hear(&frame);
    }

    pub(crate) fn tick(&mut self) -> ArmStatus {
        if self.imu {
            for frame in pins::imu_frames([0.0; 3], [0.0, 0.0, 9.81]) {
                self.ecu.on_frame(self.now, Port::Can2, &frame);
            }
        }
        self.ecu.tick(self.now, &self.pins, &mut self.out);
        self.now += ArmTarget::PERIOD;
        ArmStatus::decode(&frame_of(&self.out.can1, ArmStatus::ID)).unwrap()
    }

    /// Currents of a wheel's solenoids A (retracts) and B (extends), mA.
    pub(crate) fn solenoids_ma(&self, wheel: Wheel) -> [f64; 2] {
        [self.out.solenoid_a_ma[wheel], self.out.solenoid_b_ma[wheel]]
    }
}

/// The drive ECU, with its front joint at 10 degrees and its rear one at 5.
pub(crate) struct Drive {
    pub(crate) ecu: DriveEcu,
    pub(crate) now: SimTime,
    pub(crate) pins: DrivePins,
    pub(crate) out: DriveOutputs,
    pub(crate) counter: AliveCounter,
}

impl Drive {
    /// All wheels turn at that speed.
    pub(crate) fn new(speed_rad_s: f64) -> Self {
        let pins = DrivePins {
            joint_front_mv: pins::joint_front_mv(10.0_f64.to_radians()),
            joint_rear_mv: pins::joint_rear_mv(5.0_f64.to_radians()),
            wheel_hz: PerWheel::splat(pins::wheel_hz(speed_rad_s)),
            wheel_forward: PerWheel::splat(speed_rad_s >= 0.0),
            pump_mv: [pins::pump_mv(25e5); 4],
            supply_mv: 24_000.0,
        };
        let ecu = DriveEcu::new(&Machine::xt28());
        let (now, out) = (SimTime::ZERO, DriveOutputs::default());
        Self { ecu, now, pins, out, counter: AliveCounter::default() }
    }

    pub(crate) fn send(&mut self, throttle_percent: f64, front_angle_deg: f64, enable: bool) {
        let counter = self.counter.next_count();
        let target = DriveTarget {
            throttle_percent,
            front_angle_deg,
            engine_speed_rpm: ENGINE_RPM,
            brake: false,
            enable,
            counter,
        };
        self.ecu.on_frame(self.now, Port::Can1, &target.encode().unwrap());
    }

    /// The engine says that it turns as it is asked to.
    pub(crate) fn hear_engine(&mut self) {
        let eec1 = Eec1 { engine_speed_rpm: ENGINE_RPM };
        self.ecu.on_frame(self.now, Port::Can3, &eec1.encode().unwrap());
    }

    pub(crate) fn tick(&mut self) -> DriveStatus {
        self.ecu.tick(self.now, &self.pins, &mut self.out);
        self.now += DriveTarget::PERIOD;
        DriveStatus::decode(&frame_of(&self.out.can1, DriveStatus::ID)).unwrap()
    }

    /// Currents of both steering valves, front and rear, mA.
    pub(crate) fn steering_ma(&self) -> [f64; 2] {
        let out = &self.out;
        [out.steer_front_a_ma + out.steer_front_b_ma, out.steer_rear_a_ma + out.steer_rear_b_ma]
    }
}
