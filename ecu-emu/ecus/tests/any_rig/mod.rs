//! Both ECUs at one pace under events of any kind, with what a test knows of the last good commands.

use std::time::Duration;

use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use xt28_dbc::e2e;
use xt28_dbc::messages::{ArmStatus, ArmTarget, ArmValve, DriveTarget, Eec1};
use xt28_dbc::{CanId, Frame};
use xt28_ecus::{
    ArmEcu, ArmOutputs, ArmPins, DriveEcu, DriveOutputs, DrivePins, Port, State, pins,
};
use xt28_machine::{Machine, PerWheel, SimTime};

/// Modes of the arms (the wire's numbers).
pub(crate) const AUTOMATIC: u8 = 1;
pub(crate) const POSITION: u8 = 2;
pub(crate) const VALVE: u8 = 3;

/// Arm targets, drive targets, valve openings: identifier and data ID of each (the contract's).
const COMMANDS: [(CanId, u16); 3] =
    [(ArmTarget::ID, 0x4027), (DriveTarget::ID, 0x4127), (ArmValve::ID, 0x4227)];

/// The first six bytes of a command, and the mode for the arms.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Content {
    bytes: [u8; 6],
    mode: u8,
}

/// One thing that happens to an ECU.
#[derive(Clone, Debug)]
pub(crate) enum Event {
    Frame(Port, Frame),
    /// A command frame with a right CRC and the next counter.
    Command(usize, Content),
    /// So many periods of a gateway that sends all three, and a tick after each.
    Gateway(u32, [Content; 3]),
    Wait(u64),
    Tick,
}

fn any_frame() -> impl Strategy<Value = Event> {
    let ids = vec![
        ArmTarget::ID,
        ArmValve::ID,
        DriveTarget::ID,
        Eec1::ID,
        CanId::Standard(0x1FD),
        CanId::Standard(0x2FD),
        CanId::Extended(1),
        // A service tool's: UDS to one and to all, a request, connection management, a claim.
        CanId::Extended(0x18DA_28F1),
        CanId::Extended(0x18DB_33F1),
        CanId::Extended(0x18EA_FFF9),
        CanId::Extended(0x1CEC_28F9),
        CanId::Extended(0x18EE_FF28),
    ];
    let port = prop::sample::select(vec![Port::Can1, Port::Can2, Port::Can3, Port::Can4]);
    (port, prop::sample::select(ids), prop::collection::vec(any::<u8>(), 0..=8))
        .prop_map(|(port, id, data)| Event::Frame(port, Frame::new(id, &data).unwrap()))
}

/// Bytes as they come, many of them at the ends of what a field can say; 252 is no stroke.
fn any_content() -> impl Strategy<Value = Content> {
    let byte = prop_oneof![Just(0_u8), Just(85), Just(252), Just(255), any::<u8>()];
    (prop::array::uniform6(byte), 0..4_u8).prop_map(|(bytes, mode)| Content { bytes, mode })
}

/// What a gateway may send, by message; the drive is enabled three times of four.
fn sane_contents() -> impl Strategy<Value = [Content; 3]> {
    let strokes = prop::array::uniform6(prop_oneof![4 => 0..=250_u8, 1 => Just(255)]);
    let drive = (-1000..=1000_i16, -2500..=2500_i16, 80..=180_u8, 0..4_u8);
    let openings = prop::array::uniform6((-100..=100_i8).prop_map(i8::cast_unsigned));
    (strokes, 0..4_u8, drive, openings).prop_map(|(strokes, mode, drive, openings)| {
        let (throttle, angle, rpm, switch) = drive;
        let enable = switch > 0;
        let [t0, t1] = (if enable { throttle } else { 0 }).to_le_bytes();
        let [a0, a1] = angle.to_le_bytes();
        let target = [t0, t1, a0, a1, rpm, u8::from(enable) << 1];
        [strokes, target, openings].map(|bytes| Content { bytes, mode })
    })
}

pub(crate) fn any_event() -> impl Strategy<Value = Event> {
    prop_oneof![
        3 => any_frame(),
        6 => (0..3_usize, any_content()).prop_map(|(m, content)| Event::Command(m, content)),
        5 => (1..8_u32, sane_contents()).prop_map(|(n, all)| Event::Gateway(n, all)),
        1 => (0..45_u64).prop_map(Event::Wait),
        6 => Just(Event::Tick),
    ]
}

/// A frame that passes every check but the content's.
fn command(message: usize, content: Content, counter: u8) -> Frame {
    let (id, data_id) = COMMANDS[message];
    let mut data = [0; 8];
    data[..6].copy_from_slice(&content.bytes);
    // The counter is the high nibble for the arms, the low one for the drive.
    data[6] = match message {
        0 => counter << 4 | content.mode,
        1 => counter,
        _ => counter << 4,
    };
    data[7] = e2e::crc(data_id, &data[..7]);
    Frame::new(id, &data).unwrap()
}

/// Which command the frame gives, if an ECU may take it: its CRC holds, and its content is in range
/// (the contract's layouts, and the 0.5 m of the paper's strokes).
fn can_be_taken(frame: &Frame) -> Option<usize> {
    let message = COMMANDS.iter().position(|(id, _)| *id == frame.id())?;
    let &[b0, b1, b2, b3, .., b5, b6, crc] = frame.data() else { return None };
    let whole = frame.data().len() == 8 && crc == e2e::crc(COMMANDS[message].1, &frame.data()[..7]);
    let good = match message {
        0 => {
            let reachable = frame.data()[..6].iter().all(|raw| *raw <= 250 || *raw == 255);
            matches!(b6 & 0x0F, 0 | VALVE) || (b6 & 0x0F < VALVE && reachable)
        }
        1 => {
            let throttle = i16::from_le_bytes([b0, b1]);
            let enabled = b5 & 2 != 0 || throttle == 0;
            enabled && throttle.unsigned_abs() <= 1000 && angle_fits(i16::from_le_bytes([b2, b3]))
        }
        _ => frame.data()[..6].iter().all(|raw| raw.cast_signed().unsigned_abs() <= 100),
    };
    (whole && good).then_some(message)
}

fn angle_fits(cdeg: i16) -> bool {
    cdeg.unsigned_abs() <= 2500
}

pub(crate) fn standing_arm() -> ArmPins {
    ArmPins {
        stroke_mv: PerWheel::splat(pins::stroke_mv(0.17)),
        pressure_a_mv: PerWheel::splat(pins::pressure_mv(7e6)),
        pressure_b_mv: PerWheel::splat(pins::pressure_mv(5e5)),
        supply_mv: 24_000.0,
    }
}

pub(crate) fn rolling_drive() -> DrivePins {
    DrivePins {
        joint_front_mv: pins::joint_front_mv(0.1),
        joint_rear_mv: pins::joint_rear_mv(0.0),
        wheel_hz: PerWheel::splat(pins::wheel_hz(1.0)),
        wheel_forward: PerWheel::splat(true),
        pump_mv: [pins::pump_mv(25e5); 4],
        supply_mv: 24_000.0,
    }
}

pub(crate) struct Rig {
    now: SimTime,
    pub(crate) arm: ArmEcu,
    pub(crate) drive: DriveEcu,
    arm_pins: ArmPins,
    drive_pins: DrivePins,
    pub(crate) arm_out: ArmOutputs,
    pub(crate) drive_out: DriveOutputs,
    counters: [u8; 3],
    /// When a frame of each command message that could be taken was last sent.
    sent_at: [Option<SimTime>; 3],
}

impl Rig {
    pub(crate) fn new(arm_pins: ArmPins, drive_pins: DrivePins) -> Self {
        let machine = Machine::xt28();
        let mut rig = Self {
            now: SimTime::ZERO,
            arm: ArmEcu::new(&machine),
            drive: DriveEcu::new(&machine),
            arm_pins,
            drive_pins,
            arm_out: ArmOutputs::default(),
            drive_out: DriveOutputs::default(),
            counters: [0; 3],
            sent_at: [None; 3],
        };
        rig.lean();
        rig
    }

    /// Feeds the events; `check` sees the rig after every tick.
    pub(crate) fn live(
        &mut self,
        events: &[Event],
        mut check: impl FnMut(&Self) -> Result<(), TestCaseError>,
    ) -> Result<(), TestCaseError> {
        for event in events {
            match event {
                Event::Frame(port, frame) => self.offer(*port, frame),
                Event::Command(message, content) => self.command(*message, *content),
                Event::Gateway(periods, contents) => {
                    for _ in 0..*periods {
                        (0..3).for_each(|message| self.command(message, contents[message]));
                        self.tick();
                        check(self)?;
                    }
                }
                Event::Wait(ms) => self.now += Duration::from_millis(*ms),
                Event::Tick => {
                    self.tick();
                    check(self)?;
                }
            }
        }
        Ok(())
    }

    /// Whether a command of that message which could be taken is younger than three periods.
    pub(crate) fn commanded(&self, message: usize) -> bool {
        self.sent_at[message].is_some_and(|at| self.now.since(at).as_millis() <= 30)
    }

    /// Mode in force as the status frame says it (its first four bits); off while the ECU is dark.
    pub(crate) fn arm_mode(&self) -> u8 {
        let status = self.arm_out.can1.frames().iter().find(|frame| frame.id() == ArmStatus::ID);
        let mode = status.map_or(0, |frame| frame.data()[0] & 0x0F);
        if self.arm.state() == State::Active { mode } else { 0 }
    }

    fn command(&mut self, message: usize, content: Content) {
        let frame = command(message, content, self.counters[message]);
        self.counters[message] = (self.counters[message] + 1) % 16;
        self.offer(Port::Can1, &frame);
    }

    fn offer(&mut self, port: Port, frame: &Frame) {
        if let (Port::Can1, Some(message)) = (port, can_be_taken(frame)) {
            self.sent_at[message] = Some(self.now);
        }
        self.arm.on_frame(self.now, port, frame);
        self.drive.on_frame(self.now, port, frame);
    }

    /// One task period; then the inertial unit speaks, so that a frame in its place until the next is
    /// heard as well.
    fn tick(&mut self) {
        self.now += Duration::from_millis(10);
        self.arm.tick(self.now, &self.arm_pins, &mut self.arm_out);
        self.drive.tick(self.now, &self.drive_pins, &mut self.drive_out);
        self.lean();
    }

    /// The right side is 3 deg high.
    fn lean(&mut self) {
        let (sin, cos) = 3.0_f64.to_radians().sin_cos();
        for frame in pins::imu_frames([0.0; 3], [0.0, -9.81 * sin, 9.81 * cos]) {
            self.arm.on_frame(self.now, Port::Can2, &frame);
        }
    }
}
