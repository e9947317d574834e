//! Both ECUs of 2016 on a bench: pads, sensors and engine at hand, tick by tick.
#![allow(dead_code)] // each test file uses its part

use xt28_dbc::messages::{ArmDisplay, Eec2, MachineStatus};
use xt28_dbc::{CanId, Frame, Outbox};
use xt28_ecus::firmware_2016::{ArmEcu2016, CabPins, DriveEcu2016, Quirks, pads};
use xt28_ecus::{ArmOutputs, ArmPins, DriveOutputs, DrivePins, Port, pins};
use xt28_machine::{Machine, PerWheel, SimTime, Wheel};

/// Voltage of a position sensor that reads `mm`, mV.
pub(crate) fn stroke_mv(mm: i32) -> f64 {
    ((f64::from(mm) + 0.5) / 485.0 * 4000.0 + 500.0).round()
}

/// The frame with that identifier, which must be sent once.
pub(crate) fn only(outbox: &Outbox, id: CanId) -> Frame {
    let mut found = outbox.frames().iter().filter(|frame| frame.id() == id);
    let frame = *found.next().expect("sent every tick");
    assert!(found.next().is_none(), "{id} is sent twice");
    frame
}

/// The arm ECU.
pub(crate) struct Arm {
    pub(crate) ecu: ArmEcu2016,
    pub(crate) out: ArmOutputs,
    pub(crate) pins: ArmPins,
    pub(crate) ms: u64,
    /// Buttons down; `None` is a silent armrest.
    pub(crate) buttons: Option<Vec<u8>>,
    /// Joystick x and y, mV; `None` never spoke.
    pub(crate) stick_mv: Option<[u16; 2]>,
    /// Nose up, right side high, deg; `None` is a silent unit.
    pub(crate) lean_deg: Option<[f64; 2]>,
    /// Which of the unit's frames come: rates, accelerations.
    pub(crate) lean_heard: [bool; 2],
    /// Brake byte and chair byte; `None` never spoke.
    pub(crate) status: Option<[u8; 2]>,
}

impl Arm {
    pub(crate) fn new(quirks: Quirks) -> Self {
        Self {
            ecu: ArmEcu2016::new(&Machine::xt28(), quirks),
            out: ArmOutputs::default(),
            pins: ArmPins {
                stroke_mv: PerWheel::splat(stroke_mv(250)),
                pressure_a_mv: PerWheel::splat(500.0),
                pressure_b_mv: PerWheel::splat(500.0),
                supply_mv: 24_000.0,
            },
            ms: 0,
            buttons: Some(Vec::new()),
            stick_mv: Some([2350; 2]),
            lean_deg: Some([0.0; 2]),
            lean_heard: [true; 2],
            status: Some([0, 1]),
        }
    }

    pub(crate) fn tick(&mut self) {
        let now = SimTime::from_millis(self.ms);
        if let Some([pitch, roll]) = self.lean_deg.map(|lean| lean.map(f64::to_radians)) {
            let up = (1.0 - pitch.sin().powi(2) - roll.sin().powi(2)).sqrt();
            let force = [pitch.sin(), -roll.sin(), up].map(|f| f * 9.81);
            let frames = pins::imu_frames([0.0; 3], force);
            for (frame, _) in frames.iter().zip(self.lean_heard).filter(|(_, heard)| *heard) {
                self.ecu.on_frame(now, Port::Can2, frame);
            }
        }
        if let Some(buttons) = &self.buttons {
            let frames = pads::left_frames(buttons, self.stick_mv.unwrap_or_default());
            let heard = if self.stick_mv.is_some() { 3 } else { 1 };
            for frame in &frames[..heard] {
                self.ecu.on_frame(now, Port::Can3, frame);
            }
        }
        if let Some([brake, chair]) = self.status {
            let status =
                MachineStatus { parking_brake: brake, chair, turn_mode: 1, ..Default::default() };
            self.ecu.on_frame(now, Port::Can4, &status.encode().unwrap());
        }
        self.ecu.tick(now, &self.pins, &mut self.out);
        self.ms += 10;
    }

    pub(crate) fn ticks(&mut self, count: u32) {
        (0..count).for_each(|_| self.tick());
    }

    /// Until `s` after power-up.
    pub(crate) fn until(&mut self, s: f64) {
        while (self.ms as f64) < s * 1000.0 {
            self.tick();
        }
    }

    /// Presses for five ticks, and lets go for five.
    pub(crate) fn press(&mut self, button: u8) {
        self.buttons = Some(vec![button]);
        self.ticks(5);
        self.buttons = Some(Vec::new());
        self.ticks(5);
    }

    /// mA about the dead-band of each valve; > 0 retracts.
    pub(crate) fn u_ma(&self) -> [i32; 6] {
        let above = |ma: f64| if ma == 0.0 { 0 } else { ma as i32 - 400 };
        Wheel::ALL.map(|w| above(self.out.solenoid_a_ma[w]) - above(self.out.solenoid_b_ma[w]))
    }

    pub(crate) fn display(&self) -> ArmDisplay {
        ArmDisplay::decode(&only(&self.out.can4, ArmDisplay::ID)).unwrap()
    }

    pub(crate) fn is_levelling(&self) -> bool {
        self.display().levelling == 1
    }
}

/// The drive ECU.
pub(crate) struct Drive {
    pub(crate) ecu: DriveEcu2016,
    pub(crate) out: DriveOutputs,
    pub(crate) pins: DrivePins,
    pub(crate) cab: CabPins,
    pub(crate) ms: u64,
    /// Buttons down; `None` is a silent armrest.
    pub(crate) buttons: Option<Vec<u8>>,
    pub(crate) steer_mv: u16,
    pub(crate) roller_mv: u16,
    pub(crate) load_percent: f64,
}

impl Drive {
    pub(crate) fn new(quirks: Quirks) -> Self {
        let mut drive = Self {
            ecu: DriveEcu2016::new(quirks),
            out: DriveOutputs::default(),
            pins: DrivePins {
                joint_front_mv: 3296.0,
                joint_rear_mv: 2244.0,
                wheel_hz: PerWheel::splat(0.0),
                wheel_forward: PerWheel::splat(true),
                pump_mv: [500.0; 4],
                supply_mv: 24_000.0,
            },
            cab: CabPins::IDLE,
            ms: 0,
            buttons: Some(Vec::new()),
            steer_mv: 2484,
            roller_mv: 202,
            load_percent: 0.0,
        };
        drive.tick();
        drive
    }

    pub(crate) fn tick(&mut self) {
        let now = SimTime::from_millis(self.ms);
        if let Some(buttons) = &self.buttons {
            for frame in pads::right_frames(buttons, self.steer_mv, self.roller_mv) {
                self.ecu.on_frame(now, Port::Can2, &frame);
            }
        }
        let load = Eec2 { load_percent: self.load_percent };
        self.ecu.on_frame(now, Port::Can3, &load.encode().unwrap());
        self.ecu.tick(now, &self.pins, &self.cab, &mut self.out);
        self.ms += 10;
    }

    pub(crate) fn ticks(&mut self, count: u32) {
        (0..count).for_each(|_| self.tick());
    }

    pub(crate) fn press(&mut self, button: u8) {
        self.buttons = Some(vec![button]);
        self.ticks(5);
        self.buttons = Some(Vec::new());
        self.ticks(5);
    }

    /// Accelerator of the front set, 0 to 1.
    pub(crate) fn gas(&mut self, share: f64) {
        self.cab.gas_mv[0] = 535.0 + share * (4532.0 - 535.0);
    }

    /// Speeds of the wheels, counts.
    pub(crate) fn counts(&mut self, counts: [f64; 6]) {
        // A little more, for counts are cut off.
        self.pins.wheel_hz = PerWheel(counts.map(|c| (c + 0.6) * 67.0 * 48.3 / 6000.0));
    }

    /// Front and rear joint, deg.
    pub(crate) fn joints(&mut self, front_deg: f64, rear_deg: f64) {
        self.pins.joint_front_mv = pins::joint_front_mv(front_deg.to_radians());
        self.pins.joint_rear_mv = pins::joint_rear_mv(rear_deg.to_radians());
    }

    pub(crate) fn status(&self) -> MachineStatus {
        MachineStatus::decode(&only(&self.out.can4, MachineStatus::ID)).unwrap()
    }
}
