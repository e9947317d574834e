//! Holding one request to the limits: absolute, rate and distance from the measured value.

use crate::{Arms, Clamps, Command, Limits, Measured, State, WHEELS};

/// An arm this close to an end of its range is not driven further by valve, m (assumed: two steps
/// of the command frame).
const END_MARGIN_M: f64 = 0.004;

/// `request` held to `limits`, coming from the state's last command over `dt_s`, and what was changed.
/// All numbers must be finite.
pub(crate) fn hold(
    limits: &Limits,
    request: &Command,
    state: &State,
    measured: &Measured,
    dt_s: f64,
) -> (Command, Clamps) {
    let last = &state.last;
    let throttle = throttle(limits, request, last.throttle, dt_s);
    let angle = Channel {
        low: -limits.angle_max_rad,
        high: limits.angle_max_rad,
        step: limits.angle_rate_rad_s * dt_s,
        error: limits.angle_error_rad,
    };
    let front_angle_rad =
        angle.hold(request.front_angle_rad, last.front_angle_rad, measured.front_angle_rad);
    let (arms, arms_clamped) = arms(limits, request, state, measured, dt_s);
    let brake = request.brake && brake_may_close(limits, state, measured);
    let clamps = Clamps {
        brake: brake != request.brake,
        throttle: differs(throttle, request.throttle),
        steering: differs(front_angle_rad, request.front_angle_rad),
        arms: arms_clamped,
    };
    (Command { throttle, front_angle_rad, arms, brake }, clamps)
}

/// A brake that closes on turning wheels locks them: it waits for the machine to stand, but not for ever,
/// as a machine that rolls on with its throttle at zero needs it most. Once closed it stays closed.
fn brake_may_close(limits: &Limits, state: &State, measured: &Measured) -> bool {
    let waited_ns = state.braking_since_ns.map_or(0, |since| state.last_ns.saturating_sub(since));
    state.last.brake
        || libm::fabs(measured.speed_m_s) <= limits.brake_speed_m_s
        || waited_ns >= limits.brake_wait_ns
}

/// Free to fall towards zero, slow to grow; a change of direction passes zero.
fn throttle(limits: &Limits, request: &Command, last: f64, dt_s: f64) -> f64 {
    if request.brake {
        return 0.0;
    }
    let wanted = bound(request.throttle, -limits.throttle_max, limits.throttle_max);
    let step = limits.throttle_rate_s * dt_s;
    let from = if wanted * last > 0.0 { libm::fabs(last) } else { 0.0 };
    let magnitude = bound(libm::fabs(wanted), 0.0, from + step);
    libm::copysign(bound(magnitude, 0.0, limits.throttle_max), wanted)
}

fn arms(
    limits: &Limits,
    request: &Command,
    state: &State,
    measured: &Measured,
    dt_s: f64,
) -> (Arms, [bool; WHEELS]) {
    let mut clamped = [false; WHEELS];
    let arms = match request.arms {
        Arms::Off => Arms::Off,
        Arms::Automatic => Arms::Automatic,
        Arms::Position(mut strokes) => {
            let channel = Channel {
                low: 0.0,
                high: limits.stroke_max_m,
                step: limits.stroke_rate_m_s * dt_s,
                error: limits.stroke_error_m,
            };
            for (wheel, stroke) in strokes.iter_mut().enumerate() {
                let Some(wanted) = *stroke else { continue };
                let is = measured.stroke_m[wheel];
                let before = match state.last.arms {
                    Arms::Position(before) => before[wheel],
                    Arms::Off | Arms::Automatic | Arms::Valve(_) => None,
                };
                // Coming from another mode or from hold, the arm starts from where it is, once that is known.
                let is_known = state.steadiness.has_arm(wheel, limits.steady_ns, state.last_ns);
                let from = before.or_else(|| is_known.then_some(is));
                let held = from.map(|from| channel.hold(wanted, from, is));
                clamped[wheel] = held.is_none_or(|held| differs(held, wanted));
                *stroke = held;
            }
            Arms::Position(strokes)
        }
        Arms::Valve(mut openings) => {
            for (wheel, opening) in openings.iter_mut().enumerate() {
                let held = valve(limits, *opening, measured.stroke_m[wheel]);
                clamped[wheel] = differs(held, *opening);
                *opening = held;
            }
            Arms::Valve(openings)
        }
    };
    (arms, clamped)
}

/// An opening within its limit, and zero where it would drive the arm out of its range.
fn valve(limits: &Limits, wanted: f64, stroke_m: f64) -> f64 {
    let at_top = stroke_m > limits.stroke_max_m - END_MARGIN_M;
    let at_bottom = stroke_m < END_MARGIN_M;
    if (wanted > 0.0 && at_top) || (wanted < 0.0 && at_bottom) {
        return 0.0;
    }
    bound(wanted, -limits.opening_max, limits.opening_max)
}

/// One position-like channel.
struct Channel {
    low: f64,
    high: f64,
    /// Largest change in this step.
    step: f64,
    /// Largest distance from the measured value.
    error: f64,
}

impl Channel {
    /// What is measured holds a target back and never drives it: a reading that leaps, as with a broken wire,
    /// would have it go where nobody asked, and the arm or joint after it once the reading heals.
    fn hold(&self, wanted: f64, from: f64, measured: f64) -> f64 {
        let close = bound(wanted, measured - self.error, measured + self.error);
        let onward =
            if from < wanted { bound(close, from, wanted) } else { bound(close, wanted, from) };
        let near = bound(onward, from - self.step, from + self.step);
        bound(near, self.low, self.high)
    }
}

/// Like `f64::clamp`, but without a panic for any bounds.
fn bound(x: f64, low: f64, high: f64) -> f64 {
    if x < low {
        low
    } else if x > high {
        high
    } else {
        x
    }
}

/// Bitwise except that 0 equals -0.
#[allow(clippy::float_cmp)] // an unchanged number is the very same number
fn differs(a: f64, b: f64) -> bool {
    a != b
}
