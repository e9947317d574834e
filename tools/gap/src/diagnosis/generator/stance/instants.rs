//! The instants at which a machine's stance is judged, with all that a log says of each.

use xt28_machine::{Machine, PerWheel, Wheel};

use super::filter::{felt_rad, headings_felt, turned_rad};
use super::motion::{Motion, lagged};
use crate::diagnosis::gauge::rod_n;
use crate::diagnosis::generator::SAMPLES_PER_RESIDUAL;
use crate::diagnosis::generator::circuits::motor_nm;
use crate::diagnosis::generator::loads::is_off_scale;
use crate::diagnosis::generator::position_control::end_of;
use crate::diagnosis::instant::{AtWheel, Instant};
use crate::diagnosis::signals::{DT_S, Samples, Signals};

/// Time constant of the filter through which the ECU sees pressures, s: 0.94088 a tick (facts 3.2).
pub(super) const PRESSURE_FILTER_S: f64 = 0.164;
/// Samples of the log from one instant to the next: a machine that sways does so within seconds.
const SAMPLES_PER_INSTANT: usize = 25;
/// Instants from one at which the stance is judged to the next, half a second: it changes slowly.
pub(super) const STANDING: usize = 2;
/// Time from one instant to the next, s.
#[allow(clippy::cast_precision_loss)]
pub(super) const STEP_S: f64 = SAMPLES_PER_INSTANT as f64 * DT_S;
/// Speed over which rolling resistance fades in, rad/s: 5 cm/s at the rim (assumed).
const FADES_RAD_S: f64 = 0.07;
/// Stroke by which arms press wheels that a brake holds against one another: no log says how hard.
const SWINGS_M: f64 = 0.0003;
/// Samples until wheels that a brake let go have rolled to where nothing presses them.
const ROLLS_BACK: usize = 100;
/// Stroke rate at which an instant is twice as doubtful as one at rest, m/s, and how long that lasts, s.
const DOUBT_M_S: f64 = 0.02;
const DOUBT_S: f64 = 1.0;

/// The instants of a run.
pub(super) fn instants(s: &Signals, machine: &Machine) -> Vec<Instant> {
    let motion = Motion::new(s, machine);
    let late = |samples: &Samples| lagged(samples.iter().copied(), PRESSURE_FILTER_S);
    let still = |reading: &Samples, felt: &Samples| {
        lagged(reading.iter().zip(felt).map(|(r, f)| r - f), PRESSURE_FILTER_S)
    };
    let joint = [late(&s.joint_rad[0]), late(&s.joint_rad[1])];
    let felt = felt_rad(s, machine, &motion);
    let attitude = [still(&s.roll_rad, &felt[0]), still(&s.pitch_rad, &felt[1])];
    let acceleration = [late(&motion.left_m_s2), late(&motion.ahead_m_s2)];
    let heading = headings_felt(&headings(s, &motion)).map(|felt| felt.map(|part| late(&part)));
    let turned = turned_rad(&motion.turn_rad_s).map(|angle| late(&angle));
    let (doubt, held) = (doubts(s), held_against_arms(s));
    let wheels = PerWheel::from_fn(|w| wheel_samples(s, machine, w));
    let settles_s = s.settles_s();
    (SAMPLES_PER_INSTANT..s.len)
        .step_by(SAMPLES_PER_INSTANT)
        .map(|i| Instant {
            sample: i,
            is_calm: motion.is_calm[i],
            is_read: i as f64 * DT_S >= settles_s
                && Wheel::ALL.into_iter().all(|w| is_read(s, machine, w, i)),
            rolls_freely: !held[i],
            doubt: doubt[i],
            joint_rad: [joint[0][i], joint[1][i]],
            attitude_rad: [attitude[0][i], attitude[1][i]],
            acceleration_m_s2: [acceleration[0][i], acceleration[1][i]],
            heading: [0, 1].map(|angle| [0, 1].map(|part| heading[angle][part][i])),
            turned_rad: [turned[0][i], turned[1][i]],
            wheels: PerWheel::from_fn(|w| wheels[w](i)),
        })
        .collect()
}

/// Values at every so many `instants`, each held until the next, one for each of a residual over a run of `len` samples.
pub(super) fn held_between(values: &[f64], instants: usize, len: usize) -> Samples {
    let stride = SAMPLES_PER_INSTANT * instants;
    let held = |k| values.get(k * SAMPLES_PER_RESIDUAL / stride).copied().unwrap_or(f64::NAN);
    (0..len / SAMPLES_PER_RESIDUAL).map(held).collect()
}

/// When the instant is, s, whose value [`held_between`] gives `at_s` into a run.
#[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)]
pub(super) fn read_at_s(instants: usize, at_s: f64) -> f64 {
    let stride = SAMPLES_PER_INSTANT * instants;
    let block = (at_s / DT_S).round().max(0.0) as usize / stride;
    (SAMPLES_PER_INSTANT + stride * block) as f64 * DT_S
}

fn wheel_samples(s: &Signals, machine: &Machine, wheel: Wheel) -> impl Fn(usize) -> AtWheel {
    let late = |samples: Samples| lagged(samples.into_iter(), PRESSURE_FILTER_S);
    let stroke_m = late(s.stroke_m[wheel].clone());
    let load_n = s.cylinder_load_n[wheel].clone();
    let rod_n: Samples = (0..s.len).map(|i| rod_n(s, machine, wheel, i)).collect();
    let torque_nm = late(pump_torque_nm(s, machine, wheel));
    let speed_rad_s = &s.wheel_speed_rad_s[wheel];
    let rolls = late(speed_rad_s.iter().map(|speed| (speed / FADES_RAD_S).tanh()).collect());
    move |i| AtWheel {
        stroke_m: stroke_m[i],
        load_n: load_n[i],
        rod_n: rod_n[i],
        torque_nm: torque_nm[i],
        rolls: rolls[i],
    }
}

/// Torque of the wheel's motor, Nm, sample by sample.
pub(super) fn pump_torque_nm(s: &Signals, machine: &Machine, wheel: Wheel) -> Samples {
    (0..s.len).map(|i| motor_nm(s, machine, wheel, i)).collect()
}

/// Whether the pressures of a cylinder say all that its arm carries: they are on their scale, and no end
/// stop carries with them.
fn is_read(s: &Signals, machine: &Machine, wheel: Wheel, i: usize) -> bool {
    !is_off_scale(s, wheel, i) && end_of(machine, s.stroke_reading_m[wheel][i]) == 0.0
}

/// Where the parking brake holds wheels that arms have swung since it was put on, or did so just now.
fn held_against_arms(s: &Signals) -> Vec<bool> {
    let (mut put_on_m, mut since) = (None, ROLLS_BACK);
    let step = |i: usize| {
        let stroke_m = PerWheel::from_fn(|w| s.smooth_stroke_m[w][i]);
        if s.is_braked(i) {
            let from_m: PerWheel<f64> = *put_on_m.get_or_insert(stroke_m);
            let swings = |w: Wheel| (stroke_m[w] - from_m[w]).abs() > SWINGS_M;
            if Wheel::ALL.into_iter().any(swings) {
                since = 0;
            }
        } else {
            put_on_m = None;
            since += 1;
        }
        since < ROLLS_BACK
    };
    (0..s.len).map(step).collect()
}

/// How many times as doubtful as at rest each sample is: arms that move shake the machine.
fn doubts(s: &Signals) -> Samples {
    let mut shaken = 0.0_f64;
    let step = |i: usize| {
        let fastest = s.stroke_rate_m_s.iter().map(|(_, rate)| rate[i].abs()).fold(0.0, f64::max);
        shaken = fastest.max(shaken * (-DT_S / DOUBT_S).exp());
        1.0 + shaken / DOUBT_M_S
    };
    (0..s.len).map(step).collect()
}

/// Heading by the receiver, by wheels and joints where it says none, rad.
#[allow(clippy::cast_precision_loss)]
fn headings(s: &Signals, motion: &Motion) -> Samples {
    let mut turned = s.headings.first().map_or(0.0, |heading| heading[1]);
    let step = |(i, rate): (usize, &f64)| {
        let told = s.heading_at(i as f64 * DT_S);
        turned = told.map_or(turned + rate * DT_S, |[heading, _]| heading);
        turned
    };
    motion.turn_rad_s.iter().enumerate().map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_residual_knows_when_it_was_read() {
        for instants in [1, STANDING] {
            // Each instant's value is its time.
            let step = instants * SAMPLES_PER_INSTANT;
            let times: Samples =
                (0..40).map(|k| (SAMPLES_PER_INSTANT + k * step) as f64 * DT_S).collect();
            let residuals = held_between(&times, instants, 40 * step);
            for (k, read_s) in residuals.iter().enumerate() {
                let at_s = (k * SAMPLES_PER_RESIDUAL) as f64 * DT_S;
                assert!((read_at_s(instants, at_s) - read_s).abs() < 1e-9, "{at_s}: {read_s}");
            }
        }
    }
}
