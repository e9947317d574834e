//! Both ECUs on one bus, their sensors at rest, and a service tool.
#![allow(dead_code)] // each test file uses its part

use std::time::Duration;

use xt28_dbc::e2e::AliveCounter;
use xt28_dbc::messages::{ArmStatus, ArmTarget, ArmTargetMode};
use xt28_dbc::{CanId, Frame};
use xt28_ecus::diagnostics::isotp::{Endpoint, FlowLimits};
use xt28_ecus::{ArmEcu, ArmOutputs, ArmPins, DriveEcu, DriveOutputs, DrivePins, Port, pins};
use xt28_machine::{Machine, PerWheel, SimTime};

pub(crate) struct Bench {
    pub(crate) now: SimTime,
    pub(crate) arm: ArmEcu,
    pub(crate) drive: DriveEcu,
    pub(crate) arm_pins: ArmPins,
    pub(crate) drive_pins: DrivePins,
    pub(crate) arm_out: ArmOutputs,
    pub(crate) drive_out: DriveOutputs,
    counter: AliveCounter,
}

impl Bench {
    pub(crate) fn new() -> Self {
        let machine = Machine::xt28();
        Self {
            now: SimTime::ZERO,
            arm: ArmEcu::new(&machine),
            drive: DriveEcu::new(&machine),
            arm_pins: ArmPins {
                stroke_mv: PerWheel::splat(pins::stroke_mv(0.17)),
                pressure_a_mv: PerWheel::splat(pins::pressure_mv(7e6)),
                pressure_b_mv: PerWheel::splat(pins::pressure_mv(5e5)),
                supply_mv: 24_000.0,
            },
            drive_pins: DrivePins {
                joint_front_mv: pins::joint_front_mv(0.1),
                joint_rear_mv: pins::joint_rear_mv(0.0),
                wheel_hz: PerWheel::splat(0.0),
                wheel_forward: PerWheel::splat(true),
                pump_mv: [pins::pump_mv(25e5); 4],
                supply_mv: 24_000.0,
            },
            arm_out: ArmOutputs::default(),
            drive_out: DriveOutputs::default(),
            counter: AliveCounter::default(),
        }
    }

    /// A frame for both.
    pub(crate) fn offer(&mut self, id: u32, data: &[u8]) {
        let frame = Frame::new(CanId::Extended(id), data).unwrap();
        self.arm.on_frame(self.now, Port::Can1, &frame);
        self.drive.on_frame(self.now, Port::Can1, &frame);
    }

    /// The gateway's word to the arms.
    pub(crate) fn command(&mut self, mode: ArmTargetMode, mm: f64) {
        let counter = self.counter.next_count();
        let target = ArmTarget {
            fr_mm: mm,
            fl_mm: mm,
            mr_mm: mm,
            ml_mm: mm,
            br_mm: mm,
            bl_mm: mm,
            mode,
            counter,
        };
        self.arm.on_frame(self.now, Port::Can1, &target.encode().unwrap());
    }

    /// One tick; what both sent.
    pub(crate) fn tick(&mut self) -> Vec<Frame> {
        for frame in pins::imu_frames([0.0; 3], [0.0, 0.0, 9.81]) {
            self.arm.on_frame(self.now, Port::Can2, &frame);
        }
        self.arm.tick(self.now, &self.arm_pins, &mut self.arm_out);
        self.drive.tick(self.now, &self.drive_pins, &mut self.drive_out);
        self.now += Duration::from_millis(10);
        [self.arm_out.can1.frames(), self.drive_out.can1.frames()].concat()
    }

    pub(crate) fn run(&mut self, ticks: u32) -> Vec<Frame> {
        (0..ticks).flat_map(|_| self.tick()).collect()
    }

    pub(crate) fn arm_status(&self) -> ArmStatus {
        let frames = self.arm_out.can1.frames();
        ArmStatus::decode(frames.iter().find(|f| f.id() == ArmStatus::ID).unwrap()).unwrap()
    }

    /// The newest DM1 of a single frame with a code in it.
    pub(crate) fn dm1(&self, frames: &[Frame], from: u8) -> Option<Vec<u8>> {
        let id = CanId::Extended(0x18FE_CA00 | u32::from(from));
        let dm1 = frames.iter().rev().find(|f| f.id() == id && f.data()[2..6] != [0; 4])?;
        Some(dm1.data().to_vec())
    }

    /// A request to all, and the answers of a frame each.
    pub(crate) fn ask_all(&mut self, request: &[u8]) -> Vec<(u8, Vec<u8>)> {
        let data = [&[request.len() as u8][..], request].concat();
        self.offer(0x18DB_33F1, &data);
        let frames = self.run(5);
        let answers = frames.iter().filter(|f| f.id().raw() >> 8 == 0x0018_DAF1);
        answers
            .map(|f| {
                let length = usize::from(f.data()[0]);
                ((f.id().raw() & 0xFF) as u8, f.data()[1..=length.min(7)].to_vec())
            })
            .collect()
    }
}

/// A tester of one ECU, at the other end of our own ISO-TP.
pub(crate) struct Tool {
    target: u8,
    end: Endpoint<4095, 4095>,
}

impl Tool {
    pub(crate) fn new(target: u8) -> Self {
        let limits = FlowLimits { block_size: 4, separation: Duration::ZERO };
        Self { target, end: Endpoint::new(limits) }
    }

    /// Asks, and gives the answer, if one comes within 300 ms.
    pub(crate) fn ask(&mut self, bench: &mut Bench, request: &[u8]) -> Option<Vec<u8>> {
        self.end.send(request).unwrap();
        for _ in 0..30 {
            while let Some(data) = self.end.poll(bench.now) {
                bench.offer(0x18DA_00F1 | u32::from(self.target) << 8, &data);
            }
            let from_target = CanId::Extended(0x18DA_F100 | u32::from(self.target));
            let mut answer = None;
            for frame in bench.tick().iter().filter(|frame| frame.id() == from_target) {
                assert_eq!(frame.data().len(), 8, "padded");
                let message = self.end.on_frame(bench.now, frame.data());
                answer = answer.or(message.map(<[u8]>::to_vec));
            }
            if answer.is_some() {
                return answer;
            }
        }
        None
    }
}
