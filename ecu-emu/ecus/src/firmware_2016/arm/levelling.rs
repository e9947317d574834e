//! Automatic levelling: P on height, roll and pitch, and on each cylinder's share (facts 3.5).

use core::time::Duration;

use xt28_machine::{Axle, Linkage, PerWheel, Side, SimTime, Wheel};

use super::forces::{FRONT_TO_MIDDLE_M, Forces, WHEELBASE_M};
use crate::firmware_2016::Quirks;
use crate::firmware_2016::whole::cut;

/// How long references are led in, s, and the curve's steepness, 1/s.
const RAMP: Duration = Duration::from_secs(5);
const RAMP_MIDDLE_S: f64 = 2.5;
const RAMP_STEEPNESS: f64 = 1.9;
/// Share of the last arm-geometry pitch that a tick keeps.
const BETA_KEEP: f64 = 0.995;
/// Height offset of the operator, mm: a tick's step and its ends.
const OFFSET_STEP_MM: f64 = 0.5;
const OFFSET_MM: [f64; 2] = [-150.0, 100.0];
/// Mean stroke to hold before anyone says otherwise, mm.
const HEIGHT_MM: i32 = 250;
/// Relative force error that wakes a wheel's force part.
const FORCE_DEAD_BAND: f64 = 0.005;
/// Shares of height: in the code for every axle, and of the pseudo-inverse, front to rear.
const HEIGHT_SHARE: f64 = 0.1694;
const HEIGHT_SHARES: [f64; 3] = [0.2339, 0.1694, 0.0968];
/// Shares of pitch in the code, and of the pseudo-inverse, front to rear.
const PITCH_SHARES_CODE: [f64; 3] = [-0.1192, 0.0046, 0.1152];
const PITCH_SHARES: [f64; 3] = [-0.1152, -0.0046, 0.1198];

/// What the levelling looks at, besides forces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stance {
    pub(super) stroke_mm: PerWheel<i32>,
    pub(super) mean_stroke_mm: i32,
    /// Pitch and roll, deg.
    pub(super) angles_deg: [f64; 2],
}

/// mA per mm, per deg, and per unit of relative force error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Gains {
    pub(super) height: f64,
    pub(super) pitch: f64,
    pub(super) roll: f64,
    pub(super) force: f64,
}

impl Gains {
    /// Those of a preset button; `None` for other buttons.
    pub(super) const fn preset(button: u8) -> Option<Self> {
        match button {
            10 => Some(Self { height: 2.0, pitch: 100.0, roll: 40.0, force: 0.0 }),
            11 => Some(Self { height: 10.0, pitch: 300.0, roll: 80.0, force: 100.0 }),
            12 => Some(Self { height: 11.0, pitch: 320.0, roll: 100.0, force: 200.0 }),
            _ => None,
        }
    }
}

/// What the tuning frames have set (facts 2.2).
#[derive(Clone, Copy, Debug)]
pub(super) struct Tuning {
    /// Taken when button 8 is pressed.
    pub(super) gains: Gains,
    /// Taken at once.
    pub(super) height_mm: i32,
    /// Taken when levelling begins, deg.
    pub(super) roll_deg: f64,
    pub(super) pitch_deg: f64,
}

impl Default for Tuning {
    fn default() -> Self {
        Self { gains: Gains::default(), height_mm: HEIGHT_MM, roll_deg: 0.0, pitch_deg: 0.0 }
    }
}

/// Where a run of the levelling began.
#[derive(Clone, Copy, Debug)]
struct Start {
    at: SimTime,
    height_mm: f64,
    pitch_deg: f64,
    roll_deg: f64,
    /// Ends of roll and static pitch, frozen here.
    roll_end_deg: f64,
    pitch_static_deg: f64,
}

/// The levelling's memory.
#[derive(Clone, Debug)]
pub(super) struct Levelling {
    quirks: Quirks,
    linkage: Linkage,
    pub(super) gains: Gains,
    pub(super) tuning: Tuning,
    offset_mm: f64,
    start: Option<Start>,
    beta_deg: f64,
    force: PerWheel<DeadBand>,
    shown_height_mm: i32,
}

impl Levelling {
    pub(super) fn new(linkage: Linkage, quirks: Quirks) -> Self {
        Self {
            quirks,
            linkage,
            gains: Gains::default(),
            tuning: Tuning::default(),
            offset_mm: 0.0,
            start: None,
            beta_deg: 0.0,
            force: PerWheel::splat(DeadBand::default()),
            shown_height_mm: 0,
        }
    }

    /// Button 13 lowers, 14 raises, while held.
    pub(super) fn shift_height(&mut self, up: bool) {
        let step_mm = if up { OFFSET_STEP_MM } else { -OFFSET_STEP_MM };
        self.offset_mm = (self.offset_mm + step_mm).clamp(OFFSET_MM[0], OFFSET_MM[1]);
    }

    /// Height to hold as the display shows it, mm: 0 before the levelling ever ran.
    pub(super) const fn shown_height_mm(&self) -> i32 {
        self.shown_height_mm
    }

    /// Begins anew from where the machine stands, and writes nothing.
    pub(super) fn begin(&mut self, now: SimTime, stance: &Stance) {
        self.beta_deg = self.next_beta(stance);
        let [pitch_deg, roll_deg] = stance.angles_deg;
        self.start = Some(Start {
            at: now,
            height_mm: f64::from(stance.mean_stroke_mm),
            pitch_deg,
            roll_deg,
            roll_end_deg: self.tuning.roll_deg,
            pitch_static_deg: self.tuning.pitch_deg,
        });
    }

    /// mA about each valve's dead-band; > 0 retracts.
    pub(super) fn step(&mut self, now: SimTime, stance: &Stance, forces: &Forces) -> PerWheel<i32> {
        self.beta_deg = self.next_beta(stance);
        let Some(start) = self.start else { return PerWheel::splat(0) };
        let lead = lead(now.since(start.at));
        let led = |from: f64, to: f64| from + (to - from) * lead;
        let [pitch_deg, roll_deg] = stance.angles_deg;
        let height_mm = f64::from(self.tuning.height_mm) + self.offset_mm;
        self.shown_height_mm = cut(height_mm);
        let pitch_end_deg = if self.quirks.pitch_by_arm_geometry {
            pitch_deg - self.beta_deg + start.pitch_static_deg
        } else {
            start.pitch_static_deg
        };
        let e = Errors {
            height_mm: led(start.height_mm, height_mm) - f64::from(stance.mean_stroke_mm),
            roll_deg: led(start.roll_deg, start.roll_end_deg) - roll_deg,
            pitch_deg: led(start.pitch_deg, pitch_end_deg) - pitch_deg,
        };
        PerWheel::from_fn(|w: Wheel| {
            let force = -self.gains.force * self.force[w].step(forces.error(w));
            cut(self.allocated(w, &e) + lead * force)
        })
    }

    fn allocated(&self, w: Wheel, e: &Errors) -> f64 {
        let axle = match w.axle() {
            Axle::Front => 0,
            Axle::Middle => 1,
            Axle::Rear => 2,
        };
        let alike = self.quirks.height_shared_alike;
        let height = if alike { HEIGHT_SHARE } else { HEIGHT_SHARES[axle] };
        let interchanged = self.quirks.pitch_shares_interchanged;
        let pitch = if interchanged { PITCH_SHARES_CODE[axle] } else { PITCH_SHARES[axle] };
        let roll = if w.side() == Side::Right { -1.0 / 3.0 } else { 1.0 / 3.0 };
        -height * self.gains.height * e.height_mm
            + roll * self.gains.roll * e.roll_deg
            + pitch * self.gains.pitch * e.pitch_deg
    }

    /// Pitch of the chassis against the plane through the wheels, deg, by the height code's
    /// cylinders of 0.85 m. Runs only while the levelling does.
    fn next_beta(&self, stance: &Stance) -> f64 {
        let drop_m = stance.stroke_mm.map(|mm| self.linkage.at_stroke(f64::from(mm) * 1e-3).drop_m);
        let axle_m = |right: Wheel, left: Wheel| 0.5 * (drop_m[right] + drop_m[left]);
        let front_m = axle_m(Wheel::Fr, Wheel::Fl);
        let middle = (front_m - axle_m(Wheel::Mr, Wheel::Ml)) / FRONT_TO_MIDDLE_M;
        let rear = (front_m - axle_m(Wheel::Br, Wheel::Bl)) / WHEELBASE_M;
        let raw_deg = 0.5 * (middle.atan() + rear.atan()).to_degrees();
        BETA_KEEP * self.beta_deg + (1.0 - BETA_KEEP) * raw_deg
    }
}

struct Errors {
    height_mm: f64,
    roll_deg: f64,
    pitch_deg: f64,
}

/// How far references have come from start to end, 0 to 1.
fn lead(since: Duration) -> f64 {
    if since.is_zero() {
        0.0
    } else if since < RAMP {
        1.0 / (1.0 + (-RAMP_STEEPNESS * (since.as_secs_f64() - RAMP_MIDDLE_S)).exp())
    } else {
        1.0
    }
}

/// A wheel's force part: asleep until its error is large enough, awake until the error's sign turns.
#[derive(Clone, Copy, Debug, Default)]
struct DeadBand {
    /// Sign of the error that woke it.
    awake: Option<bool>,
}

impl DeadBand {
    fn step(&mut self, error: f64) -> f64 {
        // Zero counts as negative.
        let positive = error > 0.0;
        match self.awake {
            None => {
                self.awake = (error.abs() > FORCE_DEAD_BAND).then_some(positive);
                0.0
            }
            Some(sign) => {
                if sign != positive {
                    self.awake = None;
                }
                error
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use xt28_machine::Machine;

    use super::*;

    /// Facts 3.5: 0.9 % at 10 ms, half at 2.5 s, 99.1 % just before 5 s, then 1.
    #[test]
    fn references_are_led_in_within_five_seconds() {
        let at = |ms| lead(Duration::from_millis(ms));
        assert_eq!(at(0), 0.0);
        assert!((at(10) - 0.009).abs() < 5e-4);
        assert!((at(2500) - 0.5).abs() < 1e-12);
        assert!((at(4999) - 0.991).abs() < 5e-4);
        assert_eq!(at(5000), 1.0);
    }

    #[test]
    fn the_force_part_wakes_late_and_sleeps_late() {
        let mut band = DeadBand::default();
        let out: Vec<f64> = [0.005, 0.006, 0.001, 0.02, 0.0, 0.004, -0.006, -0.001, 0.1, 0.0]
            .map(|e| band.step(e))
            .into();
        assert_eq!(out, [0.0, 0.0, 0.001, 0.02, 0.0, 0.0, 0.0, -0.001, 0.1, 0.0]);
    }

    /// The column of mA per wheel in facts 3.5.
    #[test]
    fn presets_give_the_published_currents() {
        let mut law = Levelling::new(Machine::xt28().linkage(), Quirks::firmware());
        let rows = [
            (10, 0.339, [11.9, 0.46, 11.5], 13.3),
            (11, 1.694, [35.8, 1.38, 34.6], 26.7),
            (12, 1.863, [38.1, 1.47, 36.9], 33.3),
        ];
        for (button, height, pitch, roll) in rows {
            law.gains = Gains::preset(button).unwrap();
            let one = |height_mm, roll_deg, pitch_deg| Errors { height_mm, roll_deg, pitch_deg };
            for (axle, w) in [Wheel::Fr, Wheel::Mr, Wheel::Br].into_iter().enumerate() {
                assert!((law.allocated(w, &one(1.0, 0.0, 0.0)) + height).abs() < 2e-3);
                assert!((law.allocated(w, &one(0.0, 1.0, 0.0)) + roll).abs() < 0.05);
                let sign = if axle == 0 { -1.0 } else { 1.0 };
                let got = law.allocated(w, &one(0.0, 0.0, 1.0));
                assert!((got - sign * pitch[axle]).abs() < 0.06, "button {button}: {got}");
            }
        }
    }
}
