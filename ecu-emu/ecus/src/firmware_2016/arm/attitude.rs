//! Roll and pitch from the inertial unit, and how long it has been silent (facts 3.9, 5).

use super::sensing::kept;
use crate::firmware_2016::Quirks;
use crate::firmware_2016::whole::cut;
use crate::life::PERIOD_S;
use crate::pins::ImuReading;

/// Share of the turned angle that a tick keeps.
const ROLL_KEEP: f64 = 0.995;
const PITCH_KEEP: f64 = 0.99;
/// Added for each tick without a frame, and the count above which the unit is lost.
const SILENCE_STEP: u32 = 10;
const SILENCE_MAX: u32 = 40;

/// The filter, the newest sample, and a count of silence for either frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Attitude {
    pitch_mdeg: f64,
    roll_mdeg: f64,
    started: bool,
    /// Pitch and roll, deg/s.
    rate_deg_s: [f64; 2],
    /// X, Y, Z, counts.
    acceleration: [f64; 3],
    silence: [u32; 2],
}

impl Attitude {
    /// Takes a frame of the unit.
    pub(super) const fn on_reading(&mut self, reading: ImuReading) {
        match reading {
            ImuReading::Rate { pitch_deg_s, roll_deg_s } => {
                self.rate_deg_s = [pitch_deg_s, roll_deg_s];
                self.silence[0] = 0;
            }
            ImuReading::Acceleration(acceleration) => {
                self.acceleration = acceleration;
                self.silence[1] = 0;
            }
        }
    }

    /// One tick; the newest sample stands in for one that did not come. Without weight there is no
    /// lean to see: the firmware would divide by zero, ours changes nothing.
    pub(super) fn step(&mut self, quirks: Quirks) {
        let [x, y, z] = self.acceleration;
        if z == 0.0 {
            return;
        }
        let mdeg = |ratio: f64| ratio.atan().to_degrees() * 1e3;
        let [lean_roll, lean_pitch] = [mdeg(x / z), -mdeg(y / z)];
        if !self.started && !quirks.filters_start_at_zero {
            (self.roll_mdeg, self.pitch_mdeg) = (lean_roll, lean_pitch);
        }
        self.started = true;
        let [turn_pitch, turn_roll] = self.rate_deg_s.map(|rate| rate * 1e3 * PERIOD_S);
        let mix = |angle: f64, turn: f64, lean: f64, keep: f64| {
            kept(keep * (angle + turn) + (1.0 - keep) * lean, quirks)
        };
        self.roll_mdeg = mix(self.roll_mdeg, turn_roll, lean_roll, ROLL_KEEP);
        self.pitch_mdeg = mix(self.pitch_mdeg, turn_pitch, lean_pitch, PITCH_KEEP);
    }

    /// Counts silence, if it is `watched` this tick; true once either frame is missed.
    pub(super) fn is_lost(&mut self, watched: bool) -> bool {
        let lost = self.silence.iter().any(|count| *count > SILENCE_MAX);
        if watched {
            self.silence = self.silence.map(|count| count.saturating_add(SILENCE_STEP));
        }
        lost
    }

    /// Pitch and roll, deg.
    pub(super) fn angles_deg(&self) -> [f64; 2] {
        [self.pitch_mdeg, self.roll_mdeg].map(|mdeg| mdeg * 1e-3)
    }

    /// Pitch and roll, hundredths of a degree.
    pub(super) fn angles_cdeg(&self) -> [i32; 2] {
        [self.pitch_mdeg, self.roll_mdeg].map(|mdeg| cut(mdeg / 10.0))
    }

    /// Newest rates of pitch and roll, deg/s.
    pub(super) const fn rates_deg_s(&self) -> [f64; 2] {
        self.rate_deg_s
    }

    /// Newest acceleration along X, Y, Z, counts.
    pub(super) const fn acceleration(&self) -> [f64; 3] {
        self.acceleration
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settled(quirks: Quirks, acceleration: [f64; 3]) -> [f64; 2] {
        let mut attitude = Attitude::default();
        attitude.on_reading(ImuReading::Acceleration(acceleration));
        (0..5000).for_each(|_| attitude.step(quirks));
        attitude.angles_deg()
    }

    /// Facts 5: a still angle stops up to 0.20 deg (roll) or 0.10 deg (pitch) short.
    #[test]
    fn whole_thousandths_stop_short_and_fractions_do_not() {
        let lean_deg = 0.1_f64.atan().to_degrees();
        let short = |quirks| settled(quirks, [100.0, -100.0, 1000.0]).map(|angle| lean_deg - angle);
        let [pitch, roll] = short(Quirks::firmware());
        assert!((0.09..=0.1001).contains(&pitch) && (0.19..=0.2001).contains(&roll));
        assert!(short(Quirks::none()).iter().all(|short| short.abs() < 1e-9));
    }

    /// Facts 5: 2.0 s and 1.0 s.
    #[test]
    fn the_time_constants_are_two_seconds_and_one() {
        let fractions = Quirks { filters_cut_off: false, ..Quirks::firmware() };
        let mut attitude = Attitude::default();
        attitude.on_reading(ImuReading::Acceleration([100.0, -100.0, 1000.0]));
        let share = |attitude: &Attitude| {
            attitude.angles_deg().map(|angle| angle / 0.1_f64.atan().to_degrees())
        };
        (0..100).for_each(|_| attitude.step(fractions));
        let [pitch, _] = share(&attitude);
        (0..100).for_each(|_| attitude.step(fractions));
        let [_, roll] = share(&attitude);
        let one = 1.0 - (-1.0_f64).exp();
        assert!((pitch - one).abs() < 3e-3 && (roll - one).abs() < 3e-3, "{pitch} {roll}");
    }

    #[test]
    fn without_weight_nothing_changes() {
        assert_eq!(settled(Quirks::firmware(), [5.0, 5.0, 0.0]), [0.0; 2]);
    }
}
