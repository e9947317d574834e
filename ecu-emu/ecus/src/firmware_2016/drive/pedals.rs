//! Accelerator less brake pedal, slowly filtered; and the limit on it (facts 4.2, 4.3).

use crate::firmware_2016::whole::{cut, input_mv};
use crate::firmware_2016::{CabPins, Quirks};

/// Ends of travel `[gas, brake][front, rear]`, mV.
const TRAVEL_MV: [[[i32; 2]; 2]; 2] = [[[535, 4532], [535, 4518]], [[538, 4535], [532, 4525]]];
/// Share of the last value that a tick keeps: 0.05 Hz, 3.18 s.
const KEEP: f64 = 0.996_868_2;
const TAKE: f64 = 0.003_131_8;
/// The user's limit at power-up and its ends, per mille.
const LIMIT_START: i32 = 500;
const LIMIT: [i32; 2] = [100, 1000];
/// Above this load the offset falls, % and per mille a tick; below it recovers.
const LOAD_MAX_PERCENT: f64 = 60.0;
const OFFSET_FALL: f64 = 2.0;
const OFFSET_RISE: f64 = 0.5;

/// The filtered pedal, 0 to 1000 per mille. The brake pedal only takes away from it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pedal {
    filtered: f64,
}

impl Pedal {
    /// One tick with the pedal set that the chair faces.
    pub(super) fn step(&mut self, cab: &CabPins, chair_front: bool) -> f64 {
        let set = usize::from(!chair_front);
        let pedal = per_mille(cab.gas_mv[set], TRAVEL_MV[0][set])
            - per_mille(cab.brake_mv[set], TRAVEL_MV[1][set]);
        // The filter itself is held within its range (assumed).
        self.filtered = (KEEP * self.filtered + TAKE * pedal).clamp(0.0, 1000.0);
        self.filtered
    }

    /// Filtered, per mille.
    pub(super) const fn filtered(&self) -> f64 {
        self.filtered
    }
}

fn per_mille(mv: f64, [low, high]: [i32; 2]) -> f64 {
    (1000.0 * f64::from(input_mv(mv) - low) / f64::from(high - low)).clamp(0.0, 1000.0)
}

/// The speed limit: the user's, less an offset that an overloaded engine winds up.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpeedLimit {
    user: i32,
    offset: f64,
}

impl Default for SpeedLimit {
    fn default() -> Self {
        Self { user: LIMIT_START, offset: 0.0 }
    }
}

impl SpeedLimit {
    /// Buttons 19 and 20, each tick while held.
    pub(super) fn shift(&mut self, up: bool) {
        self.user = (self.user + if up { 1 } else { -1 }).clamp(LIMIT[0], LIMIT[1]);
    }

    /// One tick at that engine load.
    pub(super) fn step(&mut self, load_percent: f64, quirks: Quirks) {
        self.offset = if load_percent > LOAD_MAX_PERCENT {
            self.offset - OFFSET_FALL
        } else {
            (self.offset + OFFSET_RISE).min(0.0)
        };
        if !quirks.load_offset_winds_up {
            self.offset = self.offset.max(f64::from(LIMIT[0] - self.user));
        }
    }

    /// The limit in force, per mille.
    pub(super) fn in_force(&self) -> f64 {
        (f64::from(self.user) + self.offset).max(f64::from(LIMIT[0]))
    }

    /// What the user set, %.
    pub(super) const fn user_percent(&self) -> i32 {
        self.user / 10
    }
}

/// Demand of a circuit: pedal times limit, whole per mille.
pub(super) fn demand(pedal: f64, limit: f64) -> i32 {
    cut(pedal * limit / 1000.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(pedal: &mut Pedal, gas_mv: f64, brake_mv: f64, until: impl Fn(f64) -> bool) -> f64 {
        let cab = CabPins { gas_mv: [gas_mv; 2], brake_mv: [brake_mv; 2], ..CabPins::IDLE };
        let ticks = (0..10_000).take_while(|_| !until(pedal.step(&cab, true))).count();
        (ticks + 1) as f64 * 0.01
    }

    /// Facts 4.2: 150 after 0.52 s, 500 after 2.2 s, 900 after 7.4 s; down to 150 within 6.1 s, and
    /// within 1.8 s under the brake pedal.
    #[test]
    fn a_pressed_pedal_comes_slowly_and_goes_slowly() {
        let near = |got: f64, want: f64| assert!((got - want).abs() < 0.06, "{got} s, not {want}");
        for (level, s) in [(150.0, 0.52), (500.0, 2.2), (900.0, 7.33)] {
            near(after(&mut Pedal::default(), 5000.0, 500.0, |p| p >= level), s);
        }
        near(after(&mut Pedal { filtered: 1000.0 }, 500.0, 500.0, |p| p <= 150.0), 6.04);
        near(after(&mut Pedal { filtered: 1000.0 }, 500.0, 5000.0, |p| p <= 150.0), 1.77);
    }

    #[test]
    fn the_chair_chooses_the_pedal_set() {
        let cab = CabPins { gas_mv: [500.0, 5000.0], ..CabPins::IDLE };
        assert_eq!(Pedal::default().step(&cab, true), 0.0);
        assert!((Pedal::default().step(&cab, false) - 3.1318).abs() < 1e-9);
    }

    /// Facts 4.3: ten seconds of overload take 40 s to unwind.
    #[test]
    fn an_overload_winds_the_limit_down() {
        let unwound_s = |quirks| {
            let mut limit = SpeedLimit::default();
            (0..1000).for_each(|_| limit.step(61.0, quirks));
            assert_eq!(limit.in_force(), 100.0);
            let ticks = (0..9000).take_while(|_| {
                limit.step(60.0, quirks);
                limit.in_force() < 500.0
            });
            (ticks.count() + 1) as f64 * 0.01
        };
        assert!((unwound_s(Quirks::firmware()) - 40.0).abs() < 0.02);
        assert!((unwound_s(Quirks::none()) - 8.0).abs() < 0.02);
    }

    #[test]
    fn the_user_s_limit_stays_in_its_range() {
        let mut limit = SpeedLimit::default();
        (0..700).for_each(|_| limit.shift(true));
        assert_eq!((limit.in_force(), limit.user_percent()), (1000.0, 100));
        (0..2000).for_each(|_| limit.shift(false));
        assert_eq!(limit.in_force(), 100.0);
    }
}
