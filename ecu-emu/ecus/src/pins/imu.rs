//! The inertial unit's two frames (facts 2.3), between the front frame's axes and the ECU's angles.
//!
//! Roll grows with the right side, pitch with the nose (facts 1.1), so both are the body's rates
//! about x (forward) and y (left) turned round. The unit's own X and Y are those in which the
//! firmware's filter (facts 5) reads a still machine's lean with the right sign: X to the right, Y
//! to the back.

use xt28_dbc::{CanId, Frame};
use xt28_machine::GRAVITY_M_S2;

const RATE_ID: CanId = CanId::Standard(0x1FD);
const ACCELERATION_ID: CanId = CanId::Standard(0x2FD);
/// Counts per deg/s (facts 2.3).
const COUNTS_PER_DEG_S: f64 = 50.0;
/// Counts per g (assumed: the ECU uses ratios only).
const COUNTS_PER_G: f64 = 1000.0;

/// One frame of the unit, as the ECU understands it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ImuReading {
    /// How fast pitch and roll grow, deg/s.
    Rate { pitch_deg_s: f64, roll_deg_s: f64 },
    /// Counts of acceleration along X, Y, Z.
    Acceleration([f64; 3]),
}

/// Both frames for a front frame that turns at `rate_rad_s` and feels `specific_force_m_s2`, axes x
/// forward, y left, z up. Values beyond a frame's range saturate.
#[must_use]
pub fn imu_frames(rate_rad_s: [f64; 3], specific_force_m_s2: [f64; 3]) -> [Frame; 2] {
    let [roll, pitch, _] = rate_rad_s.map(|rate| -rate.to_degrees() * COUNTS_PER_DEG_S);
    let [forward, left, up] = specific_force_m_s2.map(|f| f / GRAVITY_M_S2 * COUNTS_PER_G);
    let rates = [pitch, roll].map(counts);
    let accelerations = [-forward, -left, up].map(counts);
    [words(RATE_ID, &rates), words(ACCELERATION_ID, &accelerations)]
}

/// The reading in a frame; `None` for a frame that is not the unit's, or not of its length.
pub(crate) fn read_imu(frame: &Frame) -> Option<ImuReading> {
    let word = |low: u8, high: u8| f64::from(i16::from_le_bytes([low, high]));
    match (frame.id(), frame.data()) {
        (RATE_ID, &[a, b, c, d]) => Some(ImuReading::Rate {
            pitch_deg_s: word(a, b) / COUNTS_PER_DEG_S,
            roll_deg_s: word(c, d) / COUNTS_PER_DEG_S,
        }),
        // Y comes before X.
        (ACCELERATION_ID, &[a, b, c, d, e, f]) => {
            Some(ImuReading::Acceleration([word(c, d), word(a, b), word(e, f)]))
        }
        _ => None,
    }
}

#[allow(clippy::cast_possible_truncation)] // `as` saturates, and gives 0 for NaN
fn counts(value: f64) -> [u8; 2] {
    (value.round() as i16).to_le_bytes()
}

fn words(id: CanId, words: &[[u8; 2]]) -> Frame {
    Frame::new(id, words.as_flattened()).expect("at most three words")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nose_up_and_right_side_high_read_positive() {
        // Turning about x by the right hand lifts the left side; about y it drops the nose.
        let [rates, _] = imu_frames([-0.1, -0.2, 9.0], [0.0; 3]);
        let Some(ImuReading::Rate { pitch_deg_s, roll_deg_s }) = read_imu(&rates) else {
            panic!("{rates:?}")
        };
        assert!((pitch_deg_s - 0.2_f64.to_degrees()).abs() <= 0.01);
        assert!((roll_deg_s - 0.1_f64.to_degrees()).abs() <= 0.01);

        // Nose up by 0.1: x points up a little. Right side high by 0.2: y points down a little.
        let force = [0.1_f64.sin(), -0.2_f64.sin(), 1.0].map(|f| f * GRAVITY_M_S2);
        let [_, acceleration] = imu_frames([0.0; 3], force);
        assert_eq!(acceleration.data().len(), 6);
        let Some(ImuReading::Acceleration([x, y, z])) = read_imu(&acceleration) else {
            panic!("{acceleration:?}")
        };
        assert_eq!([x, y, z], [199.0, -100.0, 1000.0]);
    }

    #[test]
    fn out_of_range_saturates_and_foreign_frames_are_left_alone() {
        let [rates, _] = imu_frames([-1e9, f64::NAN, 0.0], [0.0; 3]);
        assert_eq!(rates.data(), [0, 0, 0xFF, 0x7F]);
        let short = Frame::new(RATE_ID, &[0; 3]).unwrap();
        assert_eq!(read_imu(&short), None);
        assert_eq!(read_imu(&Frame::new(CanId::Extended(0x1FD), &[0; 4]).unwrap()), None);
    }
}
