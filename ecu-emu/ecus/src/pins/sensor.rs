//! Analogue and frequency inputs: strokes, pressures, joint angles, wheel speeds.

use core::f64::consts::TAU;

use super::Calibration;

/// What a sensor can put out, mV (assumed; inside the diagnosis window).
const OUTPUT_MV: [f64; 2] = [300.0, 4700.0];
/// Every linear sensor here has its zero at 0.5 V and its span in the next 4 V (facts 3.2, 4.9).
const ZERO_MV: f64 = 500.0;
pub(super) const SPAN_MV: f64 = 4000.0;

/// Chamber pressure over the span of a pressure input, Pa (facts 3.2).
const PRESSURE_SPAN_PA: f64 = 25.0e6;
/// Pump pressure over the span of its input, Pa (facts 4.9).
const PUMP_SPAN_PA: f64 = 60.0e6;
/// Pulses of a wheel motor's speed sensor in one revolution (facts 4.8).
const PULSES_PER_REVOLUTION: f64 = 67.0;
/// Motor revolutions in one of the wheel (facts 4.8).
const GEAR: f64 = 48.3;

/// Voltage of a cylinder's position sensor at `stroke_m`, mV; the nominal machine's, as are all here.
/// [`Calibration`] has any machine's.
#[must_use]
pub fn stroke_mv(stroke_m: f64) -> f64 {
    Calibration::default().stroke_mv(stroke_m)
}

/// Stroke at `mv`, m, at least 0. The firmware would wrap a negative one to 65 m; ours stops at 0.
#[must_use]
pub fn stroke_m(mv: f64) -> f64 {
    Calibration::default().stroke_m(mv)
}

/// Voltage of a chamber's pressure sensor at `pa`, mV.
#[must_use]
pub fn pressure_mv(pa: f64) -> f64 {
    linear_mv(pa, PRESSURE_SPAN_PA)
}

/// Chamber pressure at `mv`, Pa, at least 0.
#[must_use]
pub fn pressure_pa(mv: f64) -> f64 {
    linear(mv, PRESSURE_SPAN_PA)
}

/// Voltage of a pump's pressure sensor at `pa`, mV.
#[must_use]
pub fn pump_mv(pa: f64) -> f64 {
    linear_mv(pa, PUMP_SPAN_PA)
}

/// Pump pressure at `mv`, Pa, clamped to the 0..600 bar of the sensor.
#[must_use]
pub fn pump_pa(mv: f64) -> f64 {
    linear(mv, PUMP_SPAN_PA).min(PUMP_SPAN_PA)
}

/// Voltage of the front joint's sensor at `rad`, left > 0, mV.
#[must_use]
pub fn joint_front_mv(rad: f64) -> f64 {
    Calibration::default().joint_front_mv(rad)
}

/// Front joint at `mv`, rad, left > 0, clamped to 25 deg.
#[must_use]
pub fn joint_front_rad(mv: f64) -> f64 {
    Calibration::default().joint_front_rad(mv)
}

/// Voltage of the rear joint's sensor at `rad`, left > 0, mV.
#[must_use]
pub fn joint_rear_mv(rad: f64) -> f64 {
    Calibration::default().joint_rear_mv(rad)
}

/// Rear joint at `mv`, rad, left > 0, clamped to 25 deg.
#[must_use]
pub fn joint_rear_rad(mv: f64) -> f64 {
    Calibration::default().joint_rear_rad(mv)
}

/// Frequency of a wheel motor's sensor while the wheel turns at `rad_s`, Hz. Without direction.
#[must_use]
pub fn wheel_hz(rad_s: f64) -> f64 {
    rad_s.abs() / TAU * GEAR * PULSES_PER_REVOLUTION
}

/// Wheel speed at `hz`, rad/s, with the sign of the direction input.
#[must_use]
pub fn wheel_rad_s(hz: f64, forward: bool) -> f64 {
    // No sensor gives more than 10 kHz: that is a wheel at 14 m/s.
    let speed_rad_s = floor_nan(hz).clamp(0.0, 1.0e4) / (GEAR * PULSES_PER_REVOLUTION) * TAU;
    if forward { speed_rad_s } else { -speed_rad_s }
}

pub(super) fn linear_mv(value: f64, span: f64) -> f64 {
    output_mv(ZERO_MV + value / span * SPAN_MV)
}

pub(super) fn linear(mv: f64, span: f64) -> f64 {
    (input_mv(mv) - ZERO_MV).max(0.0) / SPAN_MV * span
}

pub(super) fn joint_mv(rad: f64, max_deg: f64, [right, straight, left]: [f64; 3]) -> f64 {
    let share = rad.to_degrees() / max_deg;
    let slope = if share < 0.0 { straight - right } else { left - straight };
    output_mv(straight + share * slope)
}

pub(super) fn joint_rad(mv: f64, max_deg: f64, [right, straight, left]: [f64; 3]) -> f64 {
    let above = input_mv(mv) - straight;
    let slope = if above < 0.0 { straight - right } else { left - straight };
    ((above / slope).clamp(-1.0, 1.0) * max_deg).to_radians()
}

/// What the converter can see: 0 to 5.5 V.
fn input_mv(mv: f64) -> f64 {
    floor_nan(mv).clamp(0.0, 5500.0)
}

fn output_mv(mv: f64) -> f64 {
    let [low, high] = OUTPUT_MV;
    // `max` first: it turns NaN into the lower end.
    mv.max(low).min(high)
}

fn floor_nan(value: f64) -> f64 {
    if value.is_nan() { 0.0 } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-9 * b.abs().max(1.0)
    }

    /// Points worked out by hand from facts 3.2, 4.6, 4.8 and 4.9.
    #[test]
    fn the_published_points_are_met() {
        assert!(close(stroke_mv(0.2425), 2500.0));
        assert!(close(stroke_m(4800.0), 0.521_375));
        assert!(close(stroke_m(400.0), 0.0));
        assert!(close(pressure_mv(12.5e6), 2500.0));
        assert!(close(pressure_pa(2500.0), 1000.0 * (6.25 * 2500.0 - 3125.0)));
        assert!(close(pump_mv(300e5), 2500.0));
        assert!(close(joint_front_mv((-25.0_f64).to_radians()), 1727.0));
        assert!(close(joint_front_mv(12.5_f64.to_radians()), (3296.0 + 4509.0) / 2.0));
        assert!(close(joint_rear_rad(867.0).to_degrees(), -25.0));
        assert!(close(joint_rear_rad(3464.0).to_degrees(), 25.0));
        // 12.9 rpm of the wheel is 696 Hz, and 1 m/s.
        assert!((wheel_hz(12.9 * TAU / 60.0) - 696.0).abs() < 0.5);
    }

    #[test]
    fn reading_undoes_writing_over_the_range() {
        for step in 0..=100 {
            let x = f64::from(step) / 100.0;
            assert!(close(stroke_m(stroke_mv(0.5 * x)), 0.5 * x));
            assert!(close(pressure_pa(pressure_mv(25e6 * x)), 25e6 * x));
            let angle = (x - 0.5) * 0.87;
            assert!(close(joint_front_rad(joint_front_mv(angle)), angle));
            assert!(close(joint_rear_rad(joint_rear_mv(angle)), angle));
            let speed = (x - 0.5) * 8.0;
            assert!(close(wheel_rad_s(wheel_hz(speed), speed >= 0.0), speed));
        }
    }

    #[test]
    fn no_signal_reads_as_nan() {
        for mv in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, 1e300] {
            let all = [stroke_m(mv), pressure_pa(mv), pump_pa(mv), joint_front_rad(mv)];
            assert!(all.iter().all(|v| v.is_finite()), "{mv}: {all:?}");
            assert!(wheel_rad_s(mv, true).is_finite());
            assert!((300.0..=4700.0).contains(&stroke_mv(mv)));
        }
    }
}
