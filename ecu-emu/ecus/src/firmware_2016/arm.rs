//! The pendulum-arm ECU ("SMS") of 2016: armrest and sensors in, solenoid currents and frames out.

mod attitude;
mod forces;
mod frames;
mod left_pad;
mod levelling;
mod mode;
mod sensing;
mod valve;

use core::time::Duration;

use xt28_dbc::messages::{MachineStatus, TuneAttitude, TuneForce, TuneHeight, TuneReference};
use xt28_dbc::{CanId, Frame};
use xt28_machine::{Linkage, Machine, PerWheel, SimTime, Wheel};

use self::attitude::Attitude;
use self::forces::ForceCode;
use self::left_pad::{LEVELLING, LeftPad};
use self::levelling::{Levelling, Stance};
use self::mode::{Modes, Tick};
use self::sensing::Sensing;
use super::Quirks;
use super::input_watch::InputWatch;
use super::whole::cut;
use crate::pins::read_imu;
use crate::power::{Power, Running};
use crate::{ArmOutputs, ArmPins, Port};

/// Levelling waits so long after power-up.
const WARM_UP: Duration = Duration::from_secs(5);
/// The fault task runs every fifth tick, half a tick before it.
const FAULT_TICKS: u32 = 5;
/// Parking brake on, as the drive ECU says it.
const BRAKE_ON: u8 = 4;
/// The drive ECU is missed after this, where it is watched at all.
const STATUS_DEADLINE: Duration = Duration::from_millis(200);

/// The pendulum-arm ECU as the firmware of 2016 has it.
///
/// Takes the left armrest on [`Port::Can3`], the drive ECU's status on [`Port::Can4`], the inertial
/// unit on [`Port::Can2`] and tuning frames on [`Port::Can1`]. No frame commands an arm.
#[derive(Clone, Debug)]
pub struct ArmEcu2016 {
    power: Power,
    linkage: Linkage,
    quirks: Quirks,
    sensing: Sensing,
    attitude: Attitude,
    force_code: ForceCode,
    pad: LeftPad,
    modes: Modes,
    /// Outputs keep what was last written.
    u_ma: PerWheel<i32>,
    drive: DriveSeen,
    brake_seen: u8,
    stroke_watch: PerWheel<InputWatch>,
    pressure_watch: [PerWheel<InputWatch>; 2],
    powered_at: Option<SimTime>,
    ticks: u32,
    alert: bool,
}

/// What the arm ECU keeps of the drive ECU's status.
#[derive(Clone, Copy, Debug, Default)]
struct DriveSeen {
    brake: u8,
    chair: u8,
    at: Option<SimTime>,
}

impl ArmEcu2016 {
    /// An ECU just switched on.
    #[must_use]
    pub fn new(machine: &Machine, quirks: Quirks) -> Self {
        Self::boot(machine.linkage(), quirks)
    }

    fn boot(linkage: Linkage, quirks: Quirks) -> Self {
        let stroke_watch = PerWheel::from_fn(|w| match w {
            Wheel::Fr | Wheel::Fl => InputWatch::front_position(),
            _ => InputWatch::default(),
        });
        Self {
            power: Power::default(),
            linkage,
            quirks,
            sensing: Sensing::new(quirks),
            attitude: Attitude::default(),
            force_code: ForceCode::new(linkage, quirks),
            pad: LeftPad::new(quirks),
            modes: Modes::new(Levelling::new(linkage, quirks)),
            u_ma: PerWheel::splat(0),
            drive: DriveSeen::default(),
            brake_seen: 0,
            stroke_watch,
            pressure_watch: [PerWheel::splat(InputWatch::default()); 2],
            powered_at: None,
            ticks: 0,
            alert: false,
        }
    }

    /// A frame that arrived at `port`. Frames that are not for this ECU are left alone.
    pub fn on_frame(&mut self, now: SimTime, port: Port, frame: &Frame) {
        if !self.power.is_on() {
            return;
        }
        match port {
            Port::Can1 => self.tune(frame),
            Port::Can2 => {
                if let Some(reading) = read_imu(frame) {
                    self.attitude.on_reading(reading);
                }
            }
            Port::Can3 => self.pad.on_frame(frame),
            Port::Can4 => {
                // Bytes 0 and 3 are all it looks at, whatever the rest says.
                if let (MachineStatus::ID, &[brake, _, _, chair, ..]) = (frame.id(), frame.data()) {
                    self.drive = DriveSeen { brake, chair, at: Some(now) };
                }
            }
        }
    }

    /// Pulls the reset line for a moment: the ECU goes dark and forgets all.
    pub fn reset(&mut self, now: SimTime) {
        self.power.reset(now);
    }

    /// One task period of 10 ms. `out` is cleared and filled.
    pub fn tick(&mut self, now: SimTime, pins: &ArmPins, out: &mut ArmOutputs) {
        match self.power.step(now, pins.supply_mv) {
            Running::On => {}
            Running::Started(_) => {
                *self = Self { power: self.power, ..Self::boot(self.linkage, self.quirks) };
            }
            Running::Off => return out.go_dark(),
        }
        out.can1.clear();
        out.can2.clear();
        out.can4.clear();
        let powered_at = *self.powered_at.get_or_insert_with(|| {
            out.can2.push(imu_start());
            now
        });
        let broken = self.inputs_broken(now, pins);
        let imu_lost = self.watch_imu();
        if self.ticks % FAULT_TICKS == 1 {
            let pad_lost = self.pad.is_lost();
            if pad_lost {
                self.pad.toggle.clear();
            }
            self.alert = pad_lost || imu_lost || broken;
        }
        self.ticks = self.ticks.wrapping_add(1);

        self.attitude.step(self.quirks);
        let readings = self.sensing.step(pins);
        let forces = self.force_code.step(&readings);
        self.pad.step();
        let (brake, chair_front) = self.drive_says(now);
        if self.pad.toggle.mode() == Some(LEVELLING) {
            self.brake_seen = brake;
        }
        let stance = Stance {
            stroke_mm: readings.stroke_mm,
            mean_stroke_mm: readings.mean_stroke_mm,
            angles_deg: self.attitude.angles_deg(),
        };
        let warm = now.since(powered_at) >= WARM_UP;
        let may_level = warm && !broken && !imu_lost && brake != BRAKE_ON;
        let tick = Tick { now, stance: &stance, forces: &forces, chair_front, may_level };
        if let Some(u_ma) = self.modes.step(&mut self.pad, &tick) {
            self.u_ma = u_ma;
        }

        let ma = PerWheel::from_fn(|w| valve::solenoids_ma(self.u_ma[w], readings.stroke_mm[w]));
        out.solenoid_a_ma = ma.map(|[a, _]| f64::from(a));
        out.solenoid_b_ma = ma.map(|[_, b]| f64::from(b));
        out.accumulator_on = self.modes.accumulators.on();
        frames::pressures(&readings, &mut out.can1);
        frames::motion(&readings, &mut out.can1);
        frames::chambers(&forces, &mut out.can1);
        frames::loads(&forces, &mut out.can1);
        frames::attitude(&readings, &self.attitude, &mut out.can1);
        frames::references(&forces, &mut out.can1);
        frames::currents(&ma, &mut out.can1);
        let (battery_mv, preset) = (cut(pins.supply_mv), self.modes.last_preset());
        frames::debug(battery_mv, preset, self.brake_seen, &mut out.can1);
        let shown = frames::Shown {
            alert: self.alert,
            height_mm: self.modes.levelling.shown_height_mm(),
            passive: self.modes.accumulators.shown(self.quirks),
            levelling: self.pad.toggle.mode() == Some(LEVELLING),
        };
        frames::display(&shown, &readings, &mut out.can4);
    }

    /// Which button's function runs (facts 3.8); `None` shuts all valves.
    #[must_use]
    pub const fn mode(&self) -> Option<u8> {
        self.pad.toggle.mode()
    }

    /// Brake byte and chair, as this ECU takes them.
    fn drive_says(&self, now: SimTime) -> (u8, bool) {
        let DriveSeen { brake, chair, at } = self.drive;
        let silent = at.is_none_or(|at| now.since(at) > STATUS_DEADLINE);
        let brake = if silent && !self.quirks.silence_freezes_inputs { BRAKE_ON } else { brake };
        (brake, if self.quirks.chair_inverted { chair == 1 } else { chair == 0 })
    }

    fn watch_imu(&mut self) -> bool {
        let levelling = self.pad.toggle.mode() == Some(LEVELLING);
        self.attitude.is_lost(levelling || !self.quirks.imu_watched_in_levelling_only)
    }

    fn inputs_broken(&mut self, now: SimTime, pins: &ArmPins) -> bool {
        let [watch_a, watch_b] = &mut self.pressure_watch;
        let watches = self.stroke_watch.0.iter_mut().chain(&mut watch_a.0).chain(&mut watch_b.0);
        let mv = pins.stroke_mv.0.iter().chain(&pins.pressure_a_mv.0).chain(&pins.pressure_b_mv.0);
        // All are looked at, so that each keeps its own time.
        watches.zip(mv).fold(false, |broken, (watch, mv)| watch.is_broken(now, *mv) || broken)
    }

    /// The tuning frames (facts 2.2).
    fn tune(&mut self, frame: &Frame) {
        let tuning = &mut self.modes.levelling.tuning;
        if let Ok(t) = TuneHeight::decode(frame) {
            tuning.gains.height = f64::from(t.height_gain);
            tuning.height_mm = cut(t.height_reference_mm);
        } else if let Ok(t) = TuneAttitude::decode(frame) {
            tuning.gains.pitch = f64::from(t.pitch_gain);
            tuning.gains.roll = f64::from(t.roll_gain);
        } else if let Ok(t) = TuneForce::decode(frame) {
            tuning.gains.force = f64::from(t.force_gain);
        } else if let Ok(t) = TuneReference::decode(frame) {
            (tuning.roll_deg, tuning.pitch_deg) = (t.roll_deg, t.pitch_deg);
        }
    }
}

/// Sent once at power-up; shaped like CANopen's start, but with 29 bits (facts 2.3).
fn imu_start() -> Frame {
    Frame::new(CanId::Extended(0), &[0x01, 0x7F]).expect("two bytes")
}
