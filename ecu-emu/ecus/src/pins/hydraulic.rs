//! Solenoid currents of valves, pumps and wheel motors, and what they do to the hydraulics.

use core::ops::RangeInclusive;

/// Current at which an arm valve begins to open, mA, and the span to fully open (facts 3.6).
const VALVE_MA: [f64; 2] = [400.0, 400.0];
/// Steering valve, likewise (facts 4.6).
const STEER_MA: [f64; 2] = [415.0, 315.0];
/// Below this opening the steering ECU writes no current: the one that would follow is not above
/// the dead-band once it is whole (facts 4.6).
const STEER_OPENING_MIN: f64 = 0.004;
/// Pump current at displacement 0, and the span to full displacement, mA (facts 4.4).
const PUMP_MA: [f64; 2] = [195.0, 410.0];
/// Below this displacement a pump gets no current (facts 4.4).
const PUMP_DISPLACEMENT_MIN: f64 = 0.005;
/// Motor current at displacement 0, and how much less at displacement 1, mA (facts 4.4).
const MOTOR_MA: [f64; 2] = [650.0, 500.0];
/// From here on a motor counts as at full displacement and gets no current (facts 4.4).
const MOTOR_DISPLACEMENT_FULL: f64 = 0.992;

/// Currents `[A, B]` of an arm valve's solenoids for `opening` -1 (retract, A) to 1 (extend, B):
/// whole mA, cut off towards zero as the firmware stores them (facts 3.5), so none below 0.25 %.
#[must_use]
pub fn valve_ma(opening: f64) -> [f64; 2] {
    let [start, span] = VALVE_MA;
    let above = (span * bounded(opening, -1.0..=1.0).abs()).trunc();
    if above == 0.0 { [0.0; 2] } else { on_side(start + above, opening < 0.0) }
}

/// Opening of an arm valve at those currents, -1 (retract) to 1 (extend).
#[must_use]
pub fn valve_opening(solenoid_a_ma: f64, solenoid_b_ma: f64) -> f64 {
    above(solenoid_b_ma, VALVE_MA) - above(solenoid_a_ma, VALVE_MA)
}

/// Currents `[A, B]` of a steering valve for `opening` -1 (right, B) to 1 (left, A); none below
/// 0.4 %.
#[must_use]
pub fn steer_ma(opening: f64) -> [f64; 2] {
    let opening = bounded(opening, -1.0..=1.0);
    if opening.abs() < STEER_OPENING_MIN {
        return [0.0; 2];
    }
    let [start, span] = STEER_MA;
    on_side(start + span * opening.abs(), opening > 0.0)
}

/// Opening of a steering valve at those currents, -1 (right) to 1 (left).
#[must_use]
pub fn steer_opening(a_ma: f64, b_ma: f64) -> f64 {
    above(a_ma, STEER_MA) - above(b_ma, STEER_MA)
}

/// Currents `[A, B]` of a pump for `displacement` -1 (reverse, A) to 1 (forward, B).
#[must_use]
pub fn pump_ma(displacement: f64) -> [f64; 2] {
    let displacement = bounded(displacement, -1.0..=1.0);
    if displacement.abs() < PUMP_DISPLACEMENT_MIN {
        return [0.0; 2];
    }
    let [start, span] = PUMP_MA;
    on_side(start + span * displacement.abs(), displacement < 0.0)
}

/// Displacement of a pump at those currents, -1 (reverse) to 1 (forward).
#[must_use]
pub fn pump_displacement(a_ma: f64, b_ma: f64) -> f64 {
    above(b_ma, PUMP_MA) - above(a_ma, PUMP_MA)
}

/// Current of a wheel motor for `displacement` 0 to 1, mA.
#[must_use]
pub fn motor_ma(displacement: f64) -> f64 {
    let displacement = bounded(displacement, 0.0..=1.0);
    if displacement >= MOTOR_DISPLACEMENT_FULL {
        return 0.0;
    }
    let [empty, span] = MOTOR_MA;
    empty - span * displacement
}

/// Displacement of a wheel motor at `ma`, 0 to 1. Without current it is full.
#[must_use]
pub fn motor_displacement(ma: f64) -> f64 {
    let [empty, span] = MOTOR_MA;
    bounded((empty - ma.max(0.0)) / span, 0.0..=1.0)
}

/// Share of the span that a current is into, 0 to 1.
fn above(ma: f64, [start, span]: [f64; 2]) -> f64 {
    bounded((ma - start) / span, 0.0..=1.0)
}

const fn on_side(ma: f64, a: bool) -> [f64; 2] {
    if a { [ma, 0.0] } else { [0.0, ma] }
}

/// `value` in `range`; what is not a number moves nothing.
fn bounded(value: f64, range: RangeInclusive<f64>) -> f64 {
    if value.is_nan() { 0.0 } else { value.clamp(*range.start(), *range.end()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_currents_are_met() {
        assert_eq!(valve_ma(0.30), [0.0, 520.0]);
        assert_eq!(valve_ma(-0.30), [520.0, 0.0]);
        assert_eq!(valve_ma(0.0024), [0.0; 2]); // 0.96 mA is cut off to none
        assert_eq!(valve_ma(-0.0026), [401.0, 0.0]);
        assert_eq!(valve_ma(0.294), [0.0, 517.0]); // 117.6 mA above the dead-band
        assert_eq!(steer_ma(1.0), [730.0, 0.0]);
        assert_eq!(steer_ma(-0.5), [0.0, 572.5]);
        assert_eq!(steer_ma(0.0039), [0.0; 2]);
        assert_eq!(pump_ma(1.0), [0.0, 605.0]);
        assert_eq!(pump_ma(-0.5), [400.0, 0.0]);
        assert_eq!(pump_ma(0.0049), [0.0; 2]);
        assert_eq!(motor_ma(1.0), 0.0);
        assert_eq!(motor_ma(0.5), 400.0);
        assert_eq!(motor_ma(0.0), 650.0);
    }

    #[test]
    fn the_hydraulics_follow_the_currents() {
        for step in -100..=100 {
            let x = f64::from(step) / 100.0;
            let [a, b] = valve_ma(x);
            assert!((valve_opening(a, b) - x).abs() <= 1.0 / 400.0 + 1e-12);
            let [a, b] = steer_ma(x);
            assert!((steer_opening(a, b) - x).abs() < 1e-12);
            let [a, b] = pump_ma(x);
            assert!((pump_displacement(a, b) - x).abs() < 1e-12);
            let full = x.abs() >= MOTOR_DISPLACEMENT_FULL;
            let expected = if full { 1.0 } else { x.abs() };
            assert!((motor_displacement(motor_ma(x.abs())) - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn what_is_not_a_number_moves_nothing() {
        assert_eq!(valve_ma(f64::NAN), [0.0; 2]);
        assert_eq!(valve_opening(f64::NAN, f64::NAN), 0.0);
        assert_eq!(steer_opening(f64::NAN, 0.0), 0.0);
        assert_eq!(pump_displacement(0.0, f64::NAN), 0.0);
        assert_eq!(motor_displacement(f64::NAN), 1.0);
    }
}
