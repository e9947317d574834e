//! The two ECUs of either profile, behind one face: who hears what, and who ticks first.

use xt28_dbc::{Frame, Outbox};
use xt28_ecus::firmware_2016::{ArmEcu2016, CabPins, DriveEcu2016};
use xt28_ecus::{ArmEcu, ArmOutputs, ArmPins, DriveEcu, DriveOutputs, DrivePins, Port, Profile};
use xt28_machine::SimTime;

use crate::wires::{Wire, Wires};
use crate::{EmulatorConfig, ecu_effects};

/// Both ECUs.
#[derive(Clone, Debug)]
pub(crate) enum Ecus {
    Paper(Box<(ArmEcu, DriveEcu)>),
    Firmware2016(Box<(ArmEcu2016, DriveEcu2016)>),
}

impl Ecus {
    pub(crate) fn new(config: &EmulatorConfig) -> Self {
        let (machine, quirks) = (&config.machine, config.quirks);
        match config.profile {
            Profile::Paper => Self::Paper(Box::new((
                ecu_effects::arm_ecu(machine, &config.effects),
                ecu_effects::drive_ecu(machine, &config.effects),
            ))),
            Profile::Firmware2016 => Self::Firmware2016(Box::new((
                ArmEcu2016::new(machine, quirks),
                DriveEcu2016::new(quirks),
            ))),
        }
    }

    /// A frame of the bus that both sit on (`CAN_1`).
    pub(crate) fn on_bus(&mut self, now: SimTime, frame: &Frame) {
        match self {
            Self::Paper(ecus) => {
                ecus.0.on_frame(now, Port::Can1, frame);
                ecus.1.on_frame(now, Port::Can1, frame);
            }
            Self::Firmware2016(ecus) => {
                ecus.0.on_frame(now, Port::Can1, frame);
                ecus.1.on_frame(now, Port::Can1, frame);
            }
        }
    }

    /// What arrived on a wire of their own: one ECU hears it, or on the display's the arm ECU.
    pub(crate) fn on_wire(&mut self, now: SimTime, wire: Wire, frame: &Frame) {
        let (to_arm, port) = match wire {
            Wire::Inertial => (true, Port::Can2),
            Wire::LeftArmrest => (true, Port::Can3),
            Wire::RightArmrest => (false, Port::Can2),
            Wire::Engine => (false, Port::Can3),
            Wire::Display => (true, Port::Can4),
        };
        match (self, to_arm) {
            (Self::Paper(ecus), true) => ecus.0.on_frame(now, port, frame),
            (Self::Paper(ecus), false) => ecus.1.on_frame(now, port, frame),
            (Self::Firmware2016(ecus), true) => ecus.0.on_frame(now, port, frame),
            (Self::Firmware2016(ecus), false) => ecus.1.on_frame(now, port, frame),
        }
    }

    /// Pulls the reset line of the arm ECU, of the drive ECU, for a moment.
    pub(crate) fn reset(&mut self, now: SimTime, [arm, drive]: [bool; 2]) {
        match self {
            Self::Paper(ecus) => {
                let (arm_ecu, drive_ecu) = &mut **ecus;
                arm.then(|| arm_ecu.reset(now));
                drive.then(|| drive_ecu.reset(now));
            }
            Self::Firmware2016(ecus) => {
                let (arm_ecu, drive_ecu) = &mut **ecus;
                arm.then(|| arm_ecu.reset(now));
                drive.then(|| drive_ecu.reset(now));
            }
        }
    }

    /// One tick of both.
    pub(crate) fn tick(&mut self, now: SimTime, pins: &Pins, out: &mut Outputs) {
        match self {
            Self::Paper(ecus) => {
                ecus.0.tick(now, &pins.arm, &mut out.arm);
                ecus.1.tick(now, &pins.drive, &mut out.drive);
            }
            Self::Firmware2016(ecus) => {
                ecus.0.tick(now, &pins.arm, &mut out.arm);
                ecus.1.tick(now, &pins.drive, &pins.cab, &mut out.drive);
            }
        }
    }
}

/// What is on the pins of both.
pub(crate) struct Pins {
    pub(crate) arm: ArmPins,
    pub(crate) drive: DrivePins,
    pub(crate) cab: CabPins,
}

/// What both put out in a tick.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outputs {
    pub(crate) arm: ArmOutputs,
    pub(crate) drive: DriveOutputs,
}

impl Outputs {
    /// Frames for the bus that both sit on.
    pub(crate) fn bus(&self) -> impl Iterator<Item = &Frame> {
        self.arm.can1.frames().iter().chain(self.drive.can1.frames())
    }

    /// Adds what both send on wires of their own.
    pub(crate) fn spread(&self, wires: &mut Wires) {
        let mut add = |wire, outbox: &Outbox| wires.extend(wire, outbox.frames());
        add(Wire::Inertial, &self.arm.can2);
        add(Wire::Engine, &self.drive.can3);
        add(Wire::Display, &self.arm.can4);
        add(Wire::Display, &self.drive.can4);
    }
}
