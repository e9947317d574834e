//! Loop gain at the valves by injection, and the stability margins that it leaves.
//!
//! The loop is broken in thought between ECU and valves, in one direction of the six openings at a
//! time: height, roll, pitch, and the three that only shift load. A sum of sines d is added there in
//! closed loop. What the plant gets is u + d, what the ECU answers is u, so the loop gain is
//! L = -u / (u + d) at each of the frequencies injected, both taken along that direction.

use std::f64::consts::{PI, TAU};

use xt28_machine::{Machine, PerWheel};

use crate::rig::Rig;

/// Length of the window analysed, s, and what goes before it.
const WINDOW_S: f64 = 40.0;
const SETTLE_S: f64 = 20.0;
const TICK_S: f64 = 0.01;
/// Frequencies as multiples of one period a window, so that none leaks into another.
const HARMONICS: [u32; 15] = [2, 3, 4, 6, 8, 11, 15, 20, 27, 36, 48, 64, 86, 115, 150];
/// Amplitude of each sine, share of full opening: well above the valve's step of 1/400.
const AMPLITUDE: f64 = 0.015;

/// Directions of the six openings, FR FL MR ML BR BL. The last three move no frame: they are
/// orthogonal to 1, x and y at the nominal places of the wheels.
pub(crate) const DIRECTIONS: [(&str, [f64; 6]); 6] = [
    ("height", [1.0, 1.0, 1.0, 1.0, 1.0, 1.0]),
    ("roll", [-1.0, 1.0, -1.0, 1.0, -1.0, 1.0]),
    ("pitch", [-1.0, -1.0, 0.0, 0.0, 1.0, 1.0]),
    ("middle against ends", [0.388, 0.388, -1.0, -1.0, 0.612, 0.612]),
    ("front against rear twist", [-1.0, 1.0, 0.0, 0.0, 1.0, -1.0]),
    ("middle against ends twist", [-0.5, 0.5, 1.0, -1.0, -0.5, 0.5]),
];

/// A complex number, as real and imaginary part.
type Complex = [f64; 2];

/// Loop gain at one frequency.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point {
    pub(crate) rad_s: f64,
    pub(crate) gain: f64,
    /// Continued downwards from the point before, so that it never jumps by a turn.
    pub(crate) phase_rad: f64,
}

/// What a loop keeps from instability.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Margins {
    /// Where the gain is one, rad/s; the highest such frequency.
    pub(crate) crossover_rad_s: f64,
    /// Phase above -180 degrees there.
    pub(crate) phase_deg: f64,
    /// Gain below one where the phase is -180 degrees, dB; infinite where it never is.
    pub(crate) gain_db: f64,
    /// Further delay that the phase margin stands, s.
    pub(crate) delay_s: f64,
}

/// Loop gain along one direction, closed loop, valves `delay_ticks` late.
pub(crate) fn loop_gain(machine: &Machine, direction: &[f64; 6], delay_ticks: usize) -> Vec<Point> {
    let norm = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
    let direction = PerWheel(direction.map(|d| d / norm));
    let along = |opening: &PerWheel<f64>| {
        direction.iter().map(|(wheel, d)| d * opening[wheel]).sum::<f64>()
    };
    let stroke_m = PerWheel::splat(machine.levelling.height_m);
    let mut rig = Rig::new(machine, stroke_m, delay_ticks);
    let mut answer = [[0.0; 2]; HARMONICS.len()];
    let mut sent = answer;
    let ticks = |seconds: f64| (seconds / TICK_S).round() as u32;
    for tick in 0..ticks(SETTLE_S + WINDOW_S) {
        let t_s = f64::from(tick) * TICK_S;
        let injected = injection(t_s) * norm.recip().max(1.0);
        let opening = rig.tick(direction.map(|d| d * injected));
        if tick < ticks(SETTLE_S) {
            continue;
        }
        let (u, e) = (along(&opening), along(&opening) + injected);
        for (k, harmonic) in HARMONICS.into_iter().enumerate() {
            let (sin, cos) = (frequency_rad_s(harmonic) * t_s).sin_cos();
            answer[k] = [answer[k][0] + u * cos, answer[k][1] - u * sin];
            sent[k] = [sent[k][0] + e * cos, sent[k][1] - e * sin];
        }
    }
    points(&answer, &sent)
}

fn points(answer: &[Complex], sent: &[Complex]) -> Vec<Point> {
    let mut last_rad = -PI / 2.0;
    let gains = answer.iter().zip(sent).map(|(u, e)| over([-u[0], -u[1]], *e));
    let point = |(harmonic, l): (u32, Complex)| {
        let raw_rad = l[1].atan2(l[0]);
        last_rad = raw_rad + TAU * ((last_rad - raw_rad) / TAU).round();
        let gain = l[0].hypot(l[1]);
        Point { rad_s: frequency_rad_s(harmonic), gain, phase_rad: last_rad }
    };
    HARMONICS.into_iter().zip(gains).map(point).collect()
}

fn over(a: Complex, b: Complex) -> Complex {
    let square = b[0] * b[0] + b[1] * b[1];
    [(a[0] * b[0] + a[1] * b[1]) / square, (a[1] * b[0] - a[0] * b[1]) / square]
}

fn frequency_rad_s(harmonic: u32) -> f64 {
    TAU * f64::from(harmonic) / WINDOW_S
}

/// The sum of sines at `t_s`, with Schroeder's phases, which keep its peak low.
fn injection(t_s: f64) -> f64 {
    let count = HARMONICS.len() as f64;
    let sine = |(k, harmonic): (usize, u32)| {
        let phase_rad = -PI * (k as f64) * (k as f64 + 1.0) / count;
        AMPLITUDE * (frequency_rad_s(harmonic) * t_s + phase_rad).sin()
    };
    HARMONICS.into_iter().enumerate().map(sine).sum()
}

impl Margins {
    /// Margins of a loop gain, interpolated between its points over the logarithms. `None` for a
    /// gain that is nowhere one: below it there is no loop, above it no measurement.
    pub(crate) fn of(points: &[Point]) -> Option<Self> {
        let crossing = |value: &dyn Fn(&Point) -> f64| {
            let pair = points.windows(2).rfind(|p| value(&p[0]) > 0.0 && value(&p[1]) <= 0.0)?;
            let (a, b) = (value(&pair[0]), value(&pair[1]));
            Some((pair[0], pair[1], a / (a - b)))
        };
        let blend = |a: f64, b: f64, share: f64| a + share * (b - a);
        let (a, b, share) = crossing(&|p| p.gain.ln())?;
        let crossover_rad_s = blend(a.rad_s.ln(), b.rad_s.ln(), share).exp();
        let phase_rad = PI + blend(a.phase_rad, b.phase_rad, share);
        let gain_db = crossing(&|p| p.phase_rad + PI).map_or(f64::INFINITY, |(a, b, share)| {
            -20.0 * blend(a.gain.log10(), b.gain.log10(), share)
        });
        let delay_s = phase_rad / crossover_rad_s;
        Some(Self { crossover_rad_s, phase_deg: phase_rad.to_degrees(), gain_db, delay_s })
    }
}
