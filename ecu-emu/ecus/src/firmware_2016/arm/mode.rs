//! What the buttons make the valves do: jog, tilt, all up or down, levelling, presets (facts 3.8).

use xt28_machine::{Axle, PerWheel, Side, SimTime, Wheel};

use super::forces::Forces;
use super::left_pad::{LEVELLING, LeftPad};
use super::levelling::{Gains, Levelling, Stance};
use crate::firmware_2016::Quirks;

const TILT: u8 = 16;
const ALL_UP: u8 = 19;
const ALL_DOWN: u8 = 21;
/// All up and all down: tenths of mA more each tick, and where it ends. Tenths, so that no sum of
/// fractions falls one short.
const ALL_STEP: i32 = 4;
const ALL_MAX: i32 = 800;

/// The modes' memory.
#[derive(Clone, Debug)]
pub(super) struct Modes {
    pub(super) levelling: Levelling,
    pub(super) accumulators: Accumulators,
    /// Tenths of mA.
    all: i32,
    /// 1 to 4: buttons 10, 11, 12, 8.
    last_preset: i32,
}

/// What a tick's modes depend on.
pub(super) struct Tick<'a> {
    pub(super) now: SimTime,
    pub(super) stance: &'a Stance,
    pub(super) forces: &'a Forces,
    /// The chair is to the front, as the ECU believes.
    pub(super) chair_front: bool,
    /// Levelling may run: no fault, brake off, 5 s after power-up.
    pub(super) may_level: bool,
}

impl Modes {
    pub(super) const fn new(levelling: Levelling) -> Self {
        Self { levelling, accumulators: Accumulators::new(), all: 0, last_preset: 0 }
    }

    /// mA about the valves' dead-bands this tick, > 0 retracts; `None` leaves the valves as they
    /// are.
    pub(super) fn step(&mut self, pad: &mut LeftPad, t: &Tick<'_>) -> Option<PerWheel<i32>> {
        let mode = pad.toggle.mode();
        if mode != Some(ALL_UP) && mode != Some(ALL_DOWN) {
            self.all = 0;
        }
        match mode {
            None => return Some(PerWheel::splat(0)),
            Some(LEVELLING) => return self.level(pad, t),
            Some(button) => {
                if let Some(wheel) = jogged(button) {
                    let wheel = if t.chair_front { wheel } else { mirrored(wheel) };
                    let mut u_ma = PerWheel::splat(0);
                    u_ma[wheel] = pad.stick_ma()[1];
                    return Some(u_ma);
                }
                match button {
                    TILT => return Some(tilted(pad.stick_ma(), t.chair_front)),
                    ALL_UP | ALL_DOWN => return Some(self.all(pad, button == ALL_UP)),
                    _ => self.moment(button),
                }
            }
        }
        pad.toggle.clear();
        None
    }

    /// Which preset was chosen last, as the debug frame says it.
    pub(super) const fn last_preset(&self) -> i32 {
        self.last_preset
    }

    fn level(&mut self, pad: &mut LeftPad, t: &Tick<'_>) -> Option<PerWheel<i32>> {
        if !t.may_level {
            pad.toggle.clear();
            return None;
        }
        if pad.toggle.is_held() {
            match pad.down() {
                Some(LEVELLING) => {
                    self.levelling.begin(t.now, t.stance);
                    return None;
                }
                Some(13) => self.levelling.shift_height(false),
                Some(14) => self.levelling.shift_height(true),
                _ => {}
            }
        }
        Some(self.levelling.step(t.now, t.stance, t.forces))
    }

    /// All six while the button is held, faster and faster; then no mode.
    fn all(&mut self, pad: &mut LeftPad, up: bool) -> PerWheel<i32> {
        if !pad.toggle.is_held() {
            pad.toggle.clear();
            self.all = 0;
            return PerWheel::splat(0);
        }
        self.all = (self.all + ALL_STEP).min(ALL_MAX);
        PerWheel::splat(if up { -self.all / 10 } else { self.all / 10 })
    }

    /// Buttons that act once.
    fn moment(&mut self, button: u8) {
        match button {
            8 => {
                self.levelling.gains = self.levelling.tuning.gains;
                self.last_preset = 4;
            }
            10..=12 => {
                self.levelling.gains = Gains::preset(button).unwrap_or_default();
                self.last_preset = i32::from(button) - 9;
            }
            _ => self.accumulators.press(button),
        }
    }
}

/// The outputs that put accumulators on their cylinders (facts 3.7). Outputs are taken to be those
/// of wheels FR to BL in order (assumed).
#[derive(Clone, Copy, Debug)]
pub(super) struct Accumulators {
    on: PerWheel<bool>,
    by_button_17: bool,
}

impl Accumulators {
    const fn new() -> Self {
        Self { on: PerWheel::splat(false), by_button_17: false }
    }

    fn press(&mut self, button: u8) {
        match button {
            17 => {
                self.by_button_17 = !self.by_button_17;
                self.on = PerWheel::splat(self.by_button_17);
            }
            2 => self.on = PerWheel::from_fn(|w| w.axle() == Axle::Front),
            5 => self.on = PerWheel::from_fn(|w| w.axle() != Axle::Middle),
            _ => {}
        }
    }

    /// Which are on.
    pub(super) const fn on(&self) -> PerWheel<bool> {
        self.on
    }

    /// What the display says of them.
    pub(super) fn shown(&self, quirks: Quirks) -> bool {
        if quirks.passive_byte_by_button_17 { self.by_button_17 } else { self.on.0.contains(&true) }
    }
}

/// The wheel that a button jogs.
const fn jogged(button: u8) -> Option<Wheel> {
    match button {
        1 => Some(Wheel::Fl),
        3 => Some(Wheel::Fr),
        4 => Some(Wheel::Ml),
        6 => Some(Wheel::Mr),
        7 => Some(Wheel::Bl),
        9 => Some(Wheel::Br),
        _ => None,
    }
}

/// The wheel at that place for one who looks back.
const fn mirrored(wheel: Wheel) -> Wheel {
    match wheel {
        Wheel::Fr => Wheel::Bl,
        Wheel::Fl => Wheel::Br,
        Wheel::Mr => Wheel::Ml,
        Wheel::Ml => Wheel::Mr,
        Wheel::Br => Wheel::Fl,
        Wheel::Bl => Wheel::Fr,
    }
}

/// X lowers the right side, Y the front; both turned round for a chair to the back.
fn tilted([x_ma, y_ma]: [i32; 2], chair_front: bool) -> PerWheel<i32> {
    let seen = if chair_front { 1 } else { -1 };
    PerWheel::from_fn(|w: Wheel| {
        let across = if w.side() == Side::Right { x_ma } else { -x_ma };
        let along = match w.axle() {
            Axle::Front => y_ma,
            Axle::Middle => 0,
            Axle::Rear => -y_ma,
        };
        seen * (across + along)
    })
}
