//! What the ECU's attitude filter makes of a machine that speeds up, bends and leans.
//!
//! The firmware's filter keeps whole thousandths of a degree and cuts off, so that it stops up to 0.2 deg
//! (roll) or 0.1 deg (pitch) short of what the accelerometer says (facts 5); other ECUs keep fractions.
//! No log says which it comes from. Its readings do: both filters are driven with what strokes and
//! wheels say, and the one that cuts off is taken where its readings lie much nearer.

use xt28_machine::{GRAVITY_M_S2, Machine};

use super::lean::planes;
use super::motion::Motion;
use crate::diagnosis::signals::{DT_S, Samples, Signals, median};

/// Share of the turned angle that the filter keeps a tick: 2 s for roll, 1 s for pitch (facts 5).
pub(super) const KEEP: [f64; 2] = [0.995, 0.99];
/// Unit in which the firmware's filter keeps angles, rad.
const UNIT_RAD: f64 = 1.0e-3 * core::f64::consts::PI / 180.0;
/// The filter that cuts off is taken where it leaves less than this share of what the other leaves: both
/// leave the errors of strokes, and a sound filter must not be traded for a little of them.
const MUCH_NEARER: f64 = 0.5;

/// Roll and pitch that the filter reads beside the lean of the front frame, rad.
#[must_use]
pub(super) fn felt_rad(s: &Signals, machine: &Machine, motion: &Motion) -> [Samples; 2] {
    let planes = planes(s, machine);
    // Ahead tips the reading nose up, to the left tips it left side high.
    let roll = Felt {
        lean_rad: planes.iter().map(|plane| plane.slope_y).collect(),
        tip_rad: motion.left_m_s2.iter().map(|a| -a / GRAVITY_M_S2).collect(),
        keep: KEEP[0],
    };
    let pitch = Felt {
        lean_rad: planes.iter().map(|plane| -plane.slope_x).collect(),
        tip_rad: motion.ahead_m_s2.iter().map(|a| a / GRAVITY_M_S2).collect(),
        keep: KEEP[1],
    };
    [roll.beside_lean_rad(&s.roll_rad), pitch.beside_lean_rad(&s.pitch_rad)]
}

/// Cosine and sine of the heading as the filters of roll and of pitch have them.
///
/// A machine that turns on a slope turns about the slope's normal: its gyroscopes feel no roll and no pitch, and the
/// filter learns of its new attitude from the accelerometer alone, in a second or two.
#[must_use]
pub(super) fn headings_felt(heading_rad: &Samples) -> [[Samples; 2]; 2] {
    let parts =
        [f64::cos, f64::sin].map(|part: fn(f64) -> f64| heading_rad.iter().map(move |h| part(*h)));
    KEEP.map(|keep| {
        parts.clone().map(|part| {
            let mut felt = None;
            let follow = |now: f64| {
                let last = felt.unwrap_or(now);
                let next = keep * last + (1.0 - keep) * now;
                felt = Some(next);
                next
            };
            part.map(follow).collect()
        })
    })
}

/// How far a machine that turns at `turn_rad_s` does so within the memory of the filters of roll and of pitch, rad.
///
/// A frame that stands nose down on its arms turns about the ground's normal and not about its own: the gyroscope of
/// its roll feels a part of the turn, and the filter takes that for a roll until the accelerometer has taken it back.
#[must_use]
pub(super) fn turned_rad(turn_rad_s: &Samples) -> [Samples; 2] {
    KEEP.map(|keep| {
        let mut turned = 0.0;
        let step = |rate: &f64| {
            turned = keep * (turned + rate * DT_S);
            turned
        };
        turn_rad_s.iter().map(step).collect()
    })
}

/// One angle: what the gyroscope and the accelerometer feel of it.
struct Felt {
    /// Lean of the front frame, rad.
    lean_rad: Samples,
    /// What the accelerometer takes for a lean beside it, rad.
    tip_rad: Samples,
    keep: f64,
}

impl Felt {
    /// What a filter reads beside the lean, by the one that `reading` speaks for.
    fn beside_lean_rad(&self, reading: &Samples) -> Samples {
        let whole = self.filtered(0.0, |angle| angle);
        let offset_rad = median(reading.iter().zip(&whole).map(|(read, angle)| read - angle))
            .unwrap_or_default();
        let cut = self.filtered(offset_rad, |angle| (angle / UNIT_RAD).trunc() * UNIT_RAD);
        let cut: Samples = cut.iter().map(|angle| angle - offset_rad).collect();
        let is_cut = left(reading, &cut) < MUCH_NEARER * left(reading, &whole);
        let filtered = if is_cut { cut } else { whole };
        filtered.iter().zip(&self.lean_rad).map(|(angle, lean)| angle - lean).collect()
    }

    /// Readings of a filter that `keeps` so much of an angle, on a unit mounted `offset_rad` off.
    fn filtered(&self, offset_rad: f64, keeps: impl Fn(f64) -> f64) -> Samples {
        let mut last_rad = self.lean_rad.first().map_or(0.0, |lean| lean + offset_rad);
        let mut angle_rad = last_rad + self.tip_rad.first().copied().unwrap_or_default();
        let step = |(lean, tip): (&f64, &f64)| {
            let stands_rad = lean + offset_rad;
            let turned_rad = stands_rad - last_rad;
            last_rad = stands_rad;
            let leans_rad = stands_rad + tip;
            angle_rad = keeps(self.keep * (angle_rad + turned_rad) + (1.0 - self.keep) * leans_rad);
            angle_rad
        };
        self.lean_rad.iter().zip(&self.tip_rad).map(step).collect()
    }
}

/// Sum of the squares of what `filtered` leaves of a reading about its middle.
fn left(reading: &Samples, filtered: &Samples) -> f64 {
    let apart = || reading.iter().zip(filtered).map(|(read, angle)| read - angle);
    let middle = median(apart()).unwrap_or_default();
    apart().map(|error| (error - middle).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bend of eight seconds, felt as a lean of 0.7 deg, of a machine that leans by `lean_rad`.
    fn bend(lean_rad: f64) -> Felt {
        let tip = |i: usize| if (300..1100).contains(&i) { -0.7_f64.to_radians() } else { 0.0 };
        Felt {
            lean_rad: vec![lean_rad; 2000],
            tip_rad: (0..2000).map(tip).collect(),
            keep: KEEP[0],
        }
    }

    /// What a gateway reads: hundredths of a degree.
    fn read(angles: Samples) -> Samples {
        let unit = 0.01_f64.to_radians();
        angles.into_iter().map(|angle| (angle / unit).round() * unit).collect()
    }

    #[test]
    fn each_filter_is_known_by_its_readings() {
        for offset_rad in [0.0, 0.01, -0.004] {
            let felt = bend(0.002);
            for cuts in [false, true] {
                let keeps = |angle: f64| {
                    if cuts { (angle / UNIT_RAD).trunc() * UNIT_RAD } else { angle }
                };
                let reading = read(felt.filtered(offset_rad, keeps));
                let beside = felt.beside_lean_rad(&reading);
                let apart = (0..2000)
                    .map(|i| (reading[i] - beside[i] - felt.lean_rad[i] - offset_rad).abs())
                    .fold(0.0, f64::max);
                assert!(
                    apart < 0.1_f64.to_radians(),
                    "{cuts} {offset_rad}: {}",
                    apart.to_degrees()
                );
            }
        }
    }

    #[test]
    fn a_filter_that_cuts_off_stops_short() {
        let felt = bend(0.0);
        let reading = felt.filtered(0.0, |angle| (angle / UNIT_RAD).trunc() * UNIT_RAD);
        assert!((reading[1099].to_degrees() + 0.5).abs() < 0.01, "{}", reading[1099].to_degrees());
    }

    #[test]
    fn a_log_without_samples_feels_nothing() {
        let felt = Felt { lean_rad: vec![], tip_rad: vec![], keep: KEEP[0] };
        assert!(felt.beside_lean_rad(&vec![]).is_empty());
    }

    /// A frame that stands nose down by 0.02 rad on its arms and goes round to the left on level ground.
    #[test]
    fn a_turn_is_felt_as_a_roll_by_a_unit_that_leans() {
        let (turn_rad_s, nose_down_rad) = (0.1_f64, 0.02_f64);
        // Up, in the unit's axes: ahead, left, up.
        let up = [nose_down_rad.sin(), 0.0, nose_down_rad.cos()];
        // Right side high is a turn against the ahead axis; the accelerometer feels none.
        let rolls_rad_s = -turn_rad_s * up[0];
        let [keep, _] = KEEP;
        let reading = (0..1000).fold(0.0, |angle, _| keep * (angle + rolls_rad_s * DT_S));
        let turned = turned_rad(&vec![turn_rad_s; 1000]);
        // The ground rises ahead of a frame that stands nose down.
        let ground_rises = nose_down_rad.tan();
        assert!((turned[0][999] * ground_rises + reading).abs() < 1e-5, "{reading}");
        assert!(reading < -0.003, "{reading}");
    }
}
