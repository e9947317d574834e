//! The pump regulator: evens the two circuits' pressures by the second one's demand (facts 4.5).

use super::sequence::DriveState;
use crate::firmware_2016::Quirks;
use crate::life::PERIOD_S;

/// Per mille for each 0.01 bar s.
const GAIN: f64 = 0.0004;
/// What it may add or take, per mille.
const TERM_MAX: f64 = 50.0;

/// The integral, and whether it runs.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PumpRegulator {
    on: bool,
    /// 0.01 bar s.
    integral: f64,
}

impl PumpRegulator {
    /// Button 9.
    pub(super) const fn toggle(&mut self) {
        self.on = !self.on;
    }

    /// Whether it runs; then the slip controller does not.
    pub(super) const fn is_on(&self) -> bool {
        self.on
    }

    /// Pedal of the second circuit, per mille, from that of the first and the pressures of 1A 1B 2A
    /// 2B, 0.01 bar.
    pub(super) fn step(
        &mut self,
        pedal: f64,
        pressure: [i32; 4],
        state: DriveState,
        quirks: Quirks,
    ) -> f64 {
        if !self.on {
            self.integral = 0.0;
            return pedal;
        }
        let on_a = quirks.pump_regulator_on_a_side || state == DriveState::Reverse;
        let side = usize::from(!on_a);
        let difference = f64::from(pressure[side] - pressure[side + 2]);
        let most = TERM_MAX / GAIN;
        self.integral = (self.integral + difference * PERIOD_S).clamp(-most, most);
        (pedal + GAIN * self.integral).clamp(0.0, 1000.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after_1_s(pressure: [i32; 4], state: DriveState, quirks: Quirks) -> f64 {
        let mut regulator = PumpRegulator::default();
        regulator.toggle();
        (0..100).map(|_| regulator.step(500.0, pressure, state, quirks)).last().unwrap() - 500.0
    }

    /// Facts 4.5: 0.04 per mille a second for each bar, on the A sides in either direction.
    #[test]
    fn a_difference_of_the_a_sides_moves_the_second_pedal() {
        let hundred_bar = [10_000, 0, 0, 0];
        let firmware = Quirks::firmware();
        for state in [DriveState::Forward, DriveState::Reverse] {
            assert!((after_1_s(hundred_bar, state, firmware) - 4.0).abs() < 1e-9);
        }
        assert_eq!(after_1_s(hundred_bar, DriveState::Forward, Quirks::none()), 0.0);
        let side_b = [0, 10_000, 0, 0];
        assert!((after_1_s(side_b, DriveState::Forward, Quirks::none()) - 4.0).abs() < 1e-9);
    }

    #[test]
    fn it_stays_within_fifty_and_starts_from_none() {
        let mut regulator = PumpRegulator::default();
        let firmware = Quirks::firmware();
        let step =
            |r: &mut PumpRegulator| r.step(500.0, [60_000, 0, 0, 0], DriveState::Forward, firmware);
        assert_eq!(step(&mut regulator), 500.0, "off");
        regulator.toggle();
        let end = (0..100_000).map(|_| step(&mut regulator)).last().unwrap();
        assert!((end - 550.0).abs() < 1e-9);
        regulator.toggle();
        assert_eq!(step(&mut regulator), 500.0);
    }
}
