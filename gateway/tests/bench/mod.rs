//! A kinematic machine that talks frames and UBX: what the gateway has on its other side.
//! The real ECUs and plant are joined with it in the closed-loop scenarios.
#![allow(dead_code)] // each test file uses its part

use gateway::{Gateway, Status};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use xt28_dbc::e2e::AliveCounter;
use xt28_dbc::messages::{
    ArmStatus, ArmStatusMode, ArmStatusReason, ArmStatusState, ArmTarget, ArmTargetMode, ArmValve,
    Attitude, CylLoadFront, CylLoadMidRear, DriveStatus, DriveStatusReason, DriveStatusState,
    DriveTarget, PosFront, PosMidRear, WheelSpeedJoint, WheelSpeedSigned,
};
use xt28_dbc::{CanId, Frame, Outbox};
use xt28_machine::{Machine, SimTime};
use xt28_safety::{Arms, Command};
use xt28_ubx::{CarrierSolution, Enu, FixType, LocalFrame, NavHpPosLlh, NavPvt, NavRelPosNed};

use crate::vehicle::{Variant, Vehicle};

pub(crate) const TICK_MS: u64 = 10;

/// Which parts of the machine have failed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Faults {
    pub(crate) arm_ecu_silent: bool,
    /// It has started anew and looks at its inputs.
    pub(crate) arm_ecu_starts: bool,
    pub(crate) drive_ecu_deaf: bool,
    pub(crate) drive_ecu_safe_stop: bool,
    pub(crate) gnss_silent: bool,
    pub(crate) imu_roll_deg: Option<f64>,
    /// The status frame is sent again and again with the same counter.
    pub(crate) drive_status_stuck: bool,
    /// The cylinder loads stay away.
    pub(crate) loads_silent: bool,
    /// The receiver gets no corrections any more.
    pub(crate) gnss_code_only: bool,
    /// It does not vouch for the direction of its second antenna.
    pub(crate) gnss_headless: bool,
    /// Fault bits of the arm and of the drive ECU.
    pub(crate) bits: [u16; 2],
    /// The drive ECU says that the parking brake is on.
    pub(crate) is_braked: bool,
    /// Something is in the machine's way.
    pub(crate) wheels_held: bool,
}

pub(crate) struct Bench {
    pub(crate) gateway: Gateway,
    pub(crate) vehicle: Vehicle,
    pub(crate) faults: Faults,
    pub(crate) now: SimTime,
    /// What the gateway sent in the last tick.
    pub(crate) sent: Outbox,
    /// What the ECUs carry out.
    command: Command,
    enabled: bool,
    accepted: [u8; 2],
    counters: [AliveCounter; 3],
    fix_due_ms: u64,
}

impl Bench {
    pub(crate) fn new(gateway: Gateway, variant: Variant) -> Self {
        let rng = ChaCha8Rng::seed_from_u64(3);
        Self {
            gateway,
            vehicle: Vehicle::new(Machine::xt28(), variant, rng),
            faults: Faults::default(),
            now: SimTime::ZERO,
            sent: Outbox::default(),
            command: Command::rest(0.0),
            enabled: false,
            accepted: [15; 2],
            counters: [AliveCounter::default(); 3],
            fix_due_ms: 0,
        }
    }

    /// One period of all: sensors speak, the gateway answers, the machine moves.
    pub(crate) fn tick(&mut self) {
        let now = self.now;
        let observation = self.vehicle.observe(now);
        for frame in self.frames(&observation) {
            self.gateway.on_frame(now, &frame);
        }
        if now.as_nanos() / 1_000_000 >= self.fix_due_ms {
            self.fix_due_ms += 125;
            if !self.faults.gnss_silent {
                let bytes = self.receiver_bytes(&observation);
                self.gateway.on_gnss(now, &bytes);
            }
        }
        self.sent.clear();
        self.gateway.tick(now, &mut self.sent);
        for frame in self.sent.clone().frames() {
            self.take(frame);
        }
        if self.sent.frames().iter().all(|f| f.id() != DriveTarget::ID) {
            self.enabled = false;
        }
        let command = if self.enabled { self.command } else { Command::rest(0.0) };
        let pose = self.vehicle.pose;
        self.vehicle.step(&command);
        if self.faults.wheels_held {
            (self.vehicle.pose, self.vehicle.speed_m_s) = (pose, 0.0);
        }
        self.now = SimTime::from_millis(now.as_nanos() / 1_000_000 + TICK_MS);
    }

    pub(crate) fn run_until(&mut self, limit_s: f64, done: impl Fn(&Status) -> bool) -> Status {
        while self.now.as_secs_f64() < limit_s {
            self.tick();
            let status = self.gateway.status();
            if done(&status) {
                return status;
            }
        }
        panic!("not within {limit_s} s: {:?}", self.gateway.status());
    }

    pub(crate) fn sent_of(&self, id: CanId) -> Option<Frame> {
        self.sent.frames().iter().copied().find(|f| f.id() == id)
    }

    pub(crate) fn arm_target(&self) -> Option<ArmTarget> {
        self.sent_of(ArmTarget::ID).map(|f| ArmTarget::decode(&f).unwrap())
    }

    pub(crate) fn drive_target(&self) -> Option<DriveTarget> {
        self.sent_of(DriveTarget::ID).map(|f| DriveTarget::decode(&f).unwrap())
    }

    /// Both ECUs in one: what they would carry out.
    pub(crate) fn take(&mut self, frame: &Frame) {
        match frame.id() {
            ArmTarget::ID => {
                let target = ArmTarget::decode(frame).unwrap();
                self.accepted[0] = target.counter;
                let t = target;
                let mm = [t.fr_mm, t.fl_mm, t.mr_mm, t.ml_mm, t.br_mm, t.bl_mm];
                self.command.arms = match target.mode {
                    ArmTargetMode::ManualPosition => {
                        Arms::Position(mm.map(|mm| (mm < 510.0).then_some(mm * 1e-3)))
                    }
                    _ => Arms::Off,
                };
            }
            DriveTarget::ID => {
                let target = DriveTarget::decode(frame).unwrap();
                if !self.faults.drive_ecu_deaf {
                    self.accepted[1] = target.counter;
                }
                self.enabled = target.enable;
                self.command.throttle = target.throttle_percent * 1e-2;
                self.command.front_angle_rad = target.front_angle_deg.to_radians();
                self.command.brake = target.brake;
            }
            ArmValve::ID => assert!(ArmValve::decode(frame).is_ok()),
            _ => {}
        }
    }

    pub(crate) fn frames(&mut self, o: &gateway::Observation) -> Vec<Frame> {
        let [fr_mm, fl_mm, mr_mm, ml_mm, br_mm, bl_mm] = o.stroke_m.0.map(|m| (m * 1e3).floor());
        let [fr_dan, fl_dan, mr_dan, ml_dan, br_dan, bl_dan] = o.load_n.0.map(|n| n / 10.0);
        let [fr_rpm, fl_rpm, mr_rpm, ml_rpm, br_rpm, bl_rpm] =
            o.wheel_speed_rad_s.0.map(|w| w * 60.0 / core::f64::consts::TAU);
        let roll_deg = self.faults.imu_roll_deg.unwrap_or(o.attitude.roll_rad.to_degrees());
        let pitch_deg = o.attitude.pitch_rad.to_degrees();
        let counter = self.counters[2].next_count();
        let mut frames = vec![
            PosFront { fr_mm, fl_mm }.encode().unwrap(),
            PosMidRear { mr_mm, ml_mm, br_mm, bl_mm }.encode().unwrap(),
            CylLoadFront { fr_dan, fl_dan }.encode().unwrap(),
            CylLoadMidRear { mr_dan, ml_dan, br_dan, bl_dan }.encode().unwrap(),
            Attitude { roll_deg, pitch_deg, mean_stroke_mm: 170.0, mean_stroke_rate: 0 }
                .encode()
                .unwrap(),
            WheelSpeedJoint {
                wheel5_rpm: br_rpm.abs(),
                wheel6_rpm: bl_rpm.abs(),
                front_joint_deg: o.front_joint_rad.to_degrees(),
                rear_joint_deg: o.rear_joint_rad.to_degrees(),
            }
            .encode()
            .unwrap(),
            WheelSpeedSigned { fr_rpm, fl_rpm, mr_rpm, ml_rpm, br_rpm, bl_rpm, counter }
                .encode()
                .unwrap(),
        ];
        if self.faults.loads_silent {
            frames.retain(|frame| ![CylLoadFront::ID, CylLoadMidRear::ID].contains(&frame.id()));
        }
        self.add_status(&mut frames);
        frames
    }

    fn add_status(&mut self, frames: &mut Vec<Frame>) {
        if !self.faults.arm_ecu_silent {
            let starts = self.faults.arm_ecu_starts;
            let status = ArmStatus {
                mode: ArmStatusMode::Off,
                state: if starts { ArmStatusState::Init } else { ArmStatusState::Standby },
                faults: self.faults.bits[0],
                accepted: self.accepted[0],
                reason: ArmStatusReason::None,
                supply_v: 24.0,
                counter: self.counters[0].next_count(),
            };
            frames.push(status.encode().unwrap());
        }
        let counter =
            if self.faults.drive_status_stuck { 3 } else { self.counters[1].next_count() };
        let safe_stop = self.faults.drive_ecu_safe_stop;
        let state = if safe_stop { DriveStatusState::SafeStop } else { DriveStatusState::Standby };
        let status = DriveStatus {
            state,
            faults: self.faults.bits[1],
            accepted: self.accepted[1],
            reason: DriveStatusReason::None,
            brake: self.faults.is_braked,
            speed_m_s: 0.0,
            counter,
        };
        frames.push(status.encode().unwrap());
    }

    /// The antenna's fix, mount and lean included.
    pub(crate) fn receiver_bytes(&self, o: &gateway::Observation) -> Vec<u8> {
        let located = o.located.unwrap();
        let (sin, cos) = located.pose.heading_rad.sin_cos();
        let ahead_m = -0.30 * o.attitude.pitch_rad.cos() - 3.1 * o.attitude.pitch_rad.sin();
        let left_m = 3.1 * o.attitude.roll_rad.sin();
        let position = LocalFrame::default().to_geodetic(Enu {
            east_m: located.pose.east_m + cos * ahead_m - sin * left_m,
            north_m: located.pose.north_m + sin * ahead_m + cos * left_m,
            up_m: 3.1,
        });
        let time_of_week_ms = u32::try_from(o.at.as_nanos() / 1_000_000).unwrap();
        let [velocity_east_m_s, velocity_north_m_s, up] = located.velocity_m_s;
        let (carrier, accuracy_horizontal_m) = if self.faults.gnss_code_only {
            (CarrierSolution::None, 3.0)
        } else {
            (CarrierSolution::Fixed, 0.014)
        };
        let mut bytes = Vec::new();
        let pvt = NavPvt {
            time_of_week_ms,
            fix_type: FixType::ThreeD,
            fix_ok: true,
            position_valid: true,
            carrier,
            satellites: 17,
            position,
            accuracy_horizontal_m,
            velocity_east_m_s,
            velocity_north_m_s,
            velocity_down_m_s: -up,
            ..NavPvt::default()
        };
        let fine = NavHpPosLlh {
            time_of_week_ms,
            valid: true,
            position,
            accuracy_horizontal_m,
            ..NavHpPosLlh::default()
        };
        let relative = NavRelPosNed {
            time_of_week_ms,
            heading_rad: core::f64::consts::FRAC_PI_2 - located.pose.heading_rad,
            fix_ok: true,
            position_valid: true,
            heading_valid: !self.faults.gnss_headless,
            moving_base: true,
            carrier: CarrierSolution::Fixed,
            ..NavRelPosNed::default()
        };
        pvt.encode(&mut bytes).unwrap();
        fine.encode(&mut bytes).unwrap();
        relative.encode(&mut bytes).unwrap();
        bytes
    }
}
