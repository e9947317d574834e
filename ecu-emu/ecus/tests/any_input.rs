//! Whatever comes in: no panic, nothing moves without a fresh good command, outputs stay in range.

use proptest::prelude::*;
use xt28_dbc::e2e;
use xt28_dbc::messages::{ArmTarget, ArmValve, DriveTarget, Eec1};
use xt28_dbc::{CanId, Frame};
use xt28_ecus::{
    ArmEcu, ArmOutputs, ArmPins, DriveEcu, DriveOutputs, DrivePins, Port, State, pins,
};
use xt28_machine::{Machine, PerWheel, SimTime};

/// One thing that happens to an ECU.
#[derive(Clone, Debug)]
enum Event {
    Frame(Port, Frame),
    /// A command frame with a right CRC and the next counter, content as it comes.
    Command(usize, [u8; 6]),
    Wait(u64),
    Tick,
}

fn any_event() -> impl Strategy<Value = Event> {
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
    let frame = (port, prop::sample::select(ids), prop::collection::vec(any::<u8>(), 0..=8))
        .prop_map(|(port, id, data)| Event::Frame(port, Frame::new(id, &data).unwrap()));
    let byte = prop_oneof![Just(0_u8), Just(85), Just(255), any::<u8>()];
    let command = (0..3_usize, prop::array::uniform6(byte)).prop_map(|(m, b)| Event::Command(m, b));
    prop_oneof![
        2 => frame,
        6 => command,
        1 => (0..45_u64).prop_map(Event::Wait),
        6 => Just(Event::Tick),
    ]
}

fn any_mv() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => 500.0..4500.0,
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(f64::NEG_INFINITY),
        1 => any::<f64>(),
    ]
}

const COMMANDS: [(CanId, u16); 3] =
    [(ArmTarget::ID, 0x4027), (DriveTarget::ID, 0x4127), (ArmValve::ID, 0x4227)];

/// A frame that passes every check but the content's.
fn command(message: usize, content: [u8; 6], counter: u8) -> Frame {
    let (id, data_id) = COMMANDS[message];
    let mut data = [0; 8];
    data[..6].copy_from_slice(&content);
    // Modes 0 to 3 for the arms; the counter is the high nibble there, the low one for the drive.
    data[6] = if id == DriveTarget::ID { counter } else { counter << 4 };
    if id == ArmTarget::ID {
        data[6] |= content[0] % 4;
    }
    data[7] = e2e::crc(data_id, &data[..7]);
    Frame::new(id, &data).unwrap()
}

fn standing_arm() -> ArmPins {
    ArmPins {
        stroke_mv: PerWheel::splat(pins::stroke_mv(0.17)),
        pressure_a_mv: PerWheel::splat(pins::pressure_mv(7e6)),
        pressure_b_mv: PerWheel::splat(pins::pressure_mv(5e5)),
        supply_mv: 24_000.0,
    }
}

fn rolling_drive() -> DrivePins {
    DrivePins {
        joint_front_mv: pins::joint_front_mv(0.1),
        joint_rear_mv: pins::joint_rear_mv(0.0),
        wheel_hz: PerWheel::splat(pins::wheel_hz(1.0)),
        wheel_forward: PerWheel::splat(true),
        pump_mv: [pins::pump_mv(25e5); 4],
        supply_mv: 24_000.0,
    }
}

/// Both ECUs at one pace, with what the test knows of the last good commands.
struct Rig {
    now: SimTime,
    arm: ArmEcu,
    drive: DriveEcu,
    counters: [u8; 3],
    /// When a frame of each command message that could be taken was last sent.
    sent_at: [Option<SimTime>; 3],
}

impl Rig {
    fn new() -> Self {
        let machine = Machine::xt28();
        Self {
            now: SimTime::ZERO,
            arm: ArmEcu::new(&machine),
            drive: DriveEcu::new(&machine),
            counters: [0; 3],
            sent_at: [None; 3],
        }
    }

    fn offer(&mut self, port: Port, frame: &Frame) {
        self.arm.on_frame(self.now, port, frame);
        self.drive.on_frame(self.now, port, frame);
    }

    /// Feeds the event; true when it is time to tick.
    fn happen(&mut self, event: &Event) -> bool {
        match event {
            Event::Frame(port, frame) => self.offer(*port, frame),
            Event::Command(message, content) => {
                let frame = command(*message, *content, self.counters[*message]);
                self.counters[*message] = (self.counters[*message] + 1) % 16;
                self.sent_at[*message] = Some(self.now);
                self.offer(Port::Can1, &frame);
            }
            Event::Wait(ms) => self.now += std::time::Duration::from_millis(*ms),
            Event::Tick => {
                self.now += std::time::Duration::from_millis(10);
                return true;
            }
        }
        false
    }

    fn commanded(&self, message: usize) -> bool {
        self.sent_at[message].is_some_and(|at| self.now.since(at).as_millis() <= 30)
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn nothing_moves_without_a_fresh_command(
        events in prop::collection::vec(any_event(), 1..200),
    ) {
        let mut rig = Rig::new();
        let (mut arm_out, mut drive_out) = (ArmOutputs::default(), DriveOutputs::default());
        let pump_total_ma = |out: &DriveOutputs| out.pump_ma.iter().sum::<f64>();
        for event in &events {
            if !rig.happen(event) {
                continue;
            }
            let pump_before_ma = pump_total_ma(&drive_out);
            rig.arm.tick(rig.now, &standing_arm(), &mut arm_out);
            rig.drive.tick(rig.now, &rolling_drive(), &mut drive_out);
            if rig.arm.state() == State::Active {
                prop_assert!(rig.commanded(0), "no fresh arm command");
            } else {
                prop_assert_eq!(arm_out.solenoid_a_ma, PerWheel::splat(0.0));
                prop_assert_eq!(arm_out.solenoid_b_ma, PerWheel::splat(0.0));
            }
            if rig.drive.state() == State::Active {
                prop_assert!(rig.commanded(1), "no fresh drive command");
            } else {
                let steer_ma = drive_out.steer_front_a_ma + drive_out.steer_front_b_ma
                    + drive_out.steer_rear_a_ma + drive_out.steer_rear_b_ma;
                prop_assert_eq!(steer_ma, 0.0);
                // The throttle may still run out, but no more than that.
                prop_assert!(pump_total_ma(&drive_out) <= pump_before_ma);
            }
        }
    }

    #[test]
    fn any_pin_and_any_frame_is_survived(
        events in prop::collection::vec(any_event(), 1..60),
        mv in prop::collection::vec(any_mv(), 25),
        forward in any::<bool>(),
    ) {
        let six = |from: usize| PerWheel(std::array::from_fn(|i| mv[from + i]));
        let arm_pins = ArmPins {
            stroke_mv: six(0),
            pressure_a_mv: six(6),
            pressure_b_mv: six(12),
            supply_mv: mv[18],
        };
        let drive_pins = DrivePins {
            joint_front_mv: mv[0],
            joint_rear_mv: mv[1],
            wheel_hz: six(2),
            wheel_forward: PerWheel::splat(forward),
            pump_mv: [mv[19], mv[20], mv[21], mv[22]],
            supply_mv: mv[23],
        };
        let mut rig = Rig::new();
        let (mut arm_out, mut drive_out) = (ArmOutputs::default(), DriveOutputs::default());
        for event in &events {
            if !rig.happen(event) {
                continue;
            }
            rig.arm.tick(rig.now, &arm_pins, &mut arm_out);
            rig.drive.tick(rig.now, &drive_pins, &mut drive_out);
            let currents_ma = arm_out.solenoid_a_ma.0.iter().chain(&arm_out.solenoid_b_ma.0);
            for ma in currents_ma {
                // The paper's cap of 30 % of the opening.
                prop_assert!(*ma == 0.0 || (401.0..=520.0).contains(ma), "{ma} mA");
            }
            for ma in drive_out.pump_ma {
                prop_assert!(ma == 0.0 || (197.0..=605.0).contains(&ma), "{ma} mA");
            }
            for ma in drive_out.motor_ma.0 {
                prop_assert!(ma == 0.0 || (154.0..=650.0).contains(&ma), "{ma} mA");
            }
        }
    }
}
