//! How the machine turns by what its joints read, beside how its receiver says that it turns.
//!
//! Three axles that slip sideways as little as they can go round what joints and speed over ground say,
//! whatever valves, controllers and wheels did to get there. So what parts this from the heading is a joint
//! that is not where its sensor says, or has been there for a while. The speed is the receiver's own: what
//! wheels do shows elsewhere, and a receiver that is late is late in both.

use xt28_machine::{Machine, PerWheel};
use xt28_sim::{Effects, Parts};

use super::SAMPLES_PER_RESIDUAL;
use super::antenna::Antenna;
use super::axles::Axles;
use super::grade::Grade;
use super::press::{axles_n, own_n};
use super::rolling::{self, wheel_kinematics};
use super::side_slip::SideSlip;
use crate::diagnosis::belief::EffectSchedule;
use crate::diagnosis::floor::Signal;
use crate::diagnosis::signals::{DT_S, Samples, Signals};

/// Headings and joints are looked at over so long before and after an instant, s: a receiver tells 0.3 deg.
pub(super) const HALF_S: f64 = 1.0;
/// Samples from one look at the joints to the next within that.
const LOOK: usize = rolling::SAMPLES_PER_LOOK;
/// The same, s.
const LOOK_S: f64 = LOOK as f64 * DT_S;
/// Looks before and after an instant.
const LOOKS: usize = 20;
/// Slower than this tyres decide where a frame goes that a joint turns, m/s.
const ROLLING_M_S: f64 = 0.3;
/// Fixes over which a speed is told lie so far from its instant, s.
const FIXES_S: f64 = 0.5;
/// Headings without which no rate is told.
const HEADINGS_MIN: usize = 5;
/// Of what joints say, the least and the most that machines with nothing wrong turn by: tyres creep under side
/// force (0.97 to 1.01 on machines of three makes, 0.95 on ground as slippery as wet grass).
const TURNS: [f64; 2] = [0.94, 1.03];
/// Share of a turn by which that differs from bend to bend (0.01 to 0.03 on the same machines).
const CREEPS: f64 = 0.05;

/// Share of a turn that ground without friction takes away, all wheels on it (assumed; a third of the friction took
/// 0.06 on a machine of a third make).
const SLIDES: f64 = 0.1;
/// Share of the believed friction from which on no wheel slides sideways in a bend (assumed).
const HOLDS: f64 = 0.6;

/// Rate of turn that the joints say less the receiver's, rad/s, ten a second, the less certain the faster it
/// turns; `NaN` where nothing can be said: without a receiver, at standstill, on ground that is no plane.
///
/// No log says how far its tyres creep. What the turns of a whole run leave does.
#[must_use]
pub(super) fn yaw_rate_error_rad_s(
    s: &Signals,
    machine: &Machine,
    schedule: EffectSchedule<'_>,
) -> Samples {
    let effects = schedule.effects;
    let count = s.len / SAMPLES_PER_RESIDUAL;
    if s.headings.is_empty() || Grade::known(s).is_none() {
        return vec![f64::NAN; count];
    }
    let said = said_by_joints(s, machine, schedule);
    let at_s = |k: usize| (k as f64 + 0.5) * SAMPLES_PER_RESIDUAL as f64 * DT_S;
    let read = s.yaw_rates(|| (0..count).map(|k| rate_read(s, at_s(k))).collect());
    let turns = read.iter().enumerate().map(|(k, read)| Some([around(&said, at_s(k))?, (*read)?]));
    let turns: Vec<Option<[f64; 2]>> = turns.collect();
    let share = share_turned(turns.iter().flatten());
    let lacks = |friction: f64| (1.0 - friction / HOLDS).max(0.0) / 6.0;
    let lacking = effects.wheels.iter().map(|(_, e)| lacks(e.slippery_ground.friction_factor));
    let slides = SLIDES * lacking.sum::<f64>();
    let sigma = Signal::YawRate.floor().sigma;
    let error = |[said, read]: [f64; 2]| {
        let joints = share * said;
        // A machine that slides turns less than its joints ask for, by as much as it may.
        let least = joints * (1.0 - slides);
        let error = read.clamp(least.min(joints), least.max(joints)) - read;
        error / 1.0_f64.hypot(CREEPS * joints / sigma)
    };
    turns.into_iter().map(|turn| turn.map_or(f64::NAN, error)).collect()
}

/// The share of what joints say by which the machine turns in all, of such pairs.
fn share_turned<'a>(turns: impl Iterator<Item = &'a [f64; 2]>) -> f64 {
    let (mut product, mut square) = (0.0, 0.0);
    for [said, read] in turns {
        product += said * read;
        square += said * said;
    }
    let [least, most] = TURNS;
    if square > 0.0 { (product / square).clamp(least, most) } else { 1.0 }
}

/// Rate at which the front frame turns by joints and speed over ground, rad/s, at each look, by the clock of
/// the receiver; `NaN` where it is not told.
fn said_by_joints(s: &Signals, machine: &Machine, schedule: EffectSchedule<'_>) -> Samples {
    let (antenna, slip) = (Antenna::new(schedule), SideSlip::new(s, machine, schedule.effects));
    let axles = Axles::new(machine);
    let parts = Parts::new(machine, &Effects::default());
    let own_n = PerWheel::from_fn(|w| own_n(machine, &parts, w));
    let kinematics = s.kinematics(|| wheel_kinematics(s, machine));
    let looks = (s.len as f64 * DT_S / LOOK_S) as usize;
    let at = |k: usize| {
        let at_s = k as f64 * LOOK_S;
        let ahead_m_s =
            ahead_m_s(s, &antenna, at_s).filter(|ahead_m_s| ahead_m_s.abs() > ROLLING_M_S);
        let then_s = at_s - antenna.late_s(at_s);
        let i = (then_s / DT_S).round().max(0.0) as usize;
        let moves = kinematics.get(i / LOOK);
        let (Some(ahead_m_s), Some(moves)) = (ahead_m_s, moves) else { return f64::NAN };
        let load_n = PerWheel::from_fn(|w| s.cylinder_load_n[w][i]);
        let pressed_n = axles_n(&own_n, &load_n, &moves.pose);
        let [angle, rate] =
            [&s.joint_rad, &s.joint_rate_rad_s].map(|of| [0, 1].map(|joint: usize| of[joint][i]));
        // Where the receiver gets later, its clock stands still.
        let passes = antenna.passed_s([at_s - LOOK_S, at_s]) / LOOK_S;
        let turn = |pressed_n| axles.rolling_under(pressed_n, angle, rate, ahead_m_s).turn_rad_s[0];
        let slipping = |slip: &SideSlip| turn(slip.holds_n_s_m(then_s)) + slip.turn_rad_s(then_s);
        passes * slip.as_ref().map_or_else(|| turn(pressed_n), slipping)
    };
    (0..looks).map(at).collect()
}

/// Speed over ground at `at_s` along the heading then, m/s, by the fixes around.
fn ahead_m_s(s: &Signals, antenna: &Antenna, at_s: f64) -> Option<f64> {
    let from = s.fixes.partition_point(|fix| fix[0] < at_s - FIXES_S);
    let to = s.fixes.partition_point(|fix| fix[0] <= at_s + FIXES_S).checked_sub(1)?;
    let ([t0, x0, y0], [t1, x1, y1]) = (*s.fixes.get(from)?, *s.fixes.get(to)?);
    let [heading, _] = s.heading_at(at_s).filter(|_| t1 - t0 > FIXES_S)?;
    let (sin, cos) = heading.sin_cos();
    let [jumped_m, _] = antenna.jumped_m([t0, t1]);
    let passed_s = Some(antenna.passed_s([t0, t1])).filter(|passed_s| *passed_s > 0.0)?;
    Some((cos * (x1 - x0) + sin * (y1 - y0) - jumped_m) / passed_s)
}

/// What `said` comes to around `at_s`: weighted as a line through evenly spaced headings weights their rates.
fn around(said: &[f64], at_s: f64) -> Option<f64> {
    let middle = (at_s / LOOK_S).round() as usize;
    let looks = said.get(middle.checked_sub(LOOKS)?..=middle + LOOKS)?;
    let (mut sum, mut weights) = (0.0, 0.0);
    for (k, rate) in looks.iter().enumerate() {
        let away = (k as f64 - LOOKS as f64) / LOOKS as f64;
        let weight = 1.0 - away * away;
        sum += weight * rate;
        weights += weight;
    }
    Some(sum / weights).filter(|mean| mean.is_finite())
}

/// Slope of the line through the headings around `at_s`, rad/s.
fn rate_read(s: &Signals, at_s: f64) -> Option<f64> {
    let from = s.headings.partition_point(|heading| heading[0] < at_s - HALF_S);
    let to = s.headings.partition_point(|heading| heading[0] <= at_s + HALF_S);
    let all = &s.headings[from..to];
    let reaches = all.len() >= HEADINGS_MIN && all[all.len() - 1][0] - all[0][0] > HALF_S;
    let mean = |of: usize| all.iter().map(|heading| heading[of]).sum::<f64>() / all.len() as f64;
    let [mean_s, mean_rad] = [mean(0), mean(1)];
    let (mut product, mut square) = (0.0, 0.0);
    for [told_s, heading, _] in all {
        product += (told_s - mean_s) * (heading - mean_rad);
        square += (told_s - mean_s) * (told_s - mean_s);
    }
    reaches.then(|| product / square)
}

#[cfg(test)]
mod tests {
    use xt28_machine::Wheel;

    use super::super::still::still;
    use super::*;

    /// A machine that goes east at 1.3 m/s and winds by joints that swing to 0.3 rad, each by half of its arc. Its
    /// joints read `bias_rad` more than that, `late_s` later.
    fn winding(bias_rad: f64, late_s: f64) -> Signals {
        let (mut s, axles) = (still(40), Axles::new(&Machine::xt28()));
        (s.fixes, s.headings) = (Vec::new(), Vec::new());
        let swing = |at_s: f64| {
            let (sin, cos) = (0.6 * at_s).sin_cos();
            ([0.3 * sin, 0.19 * sin], [0.18 * cos, 0.114 * cos])
        };
        let (mut x_m, mut y_m, mut heading) = (0.0, 0.0, 0.0_f64);
        for i in 0..s.len {
            let at_s = i as f64 * DT_S;
            for w in Wheel::ALL {
                s.cylinder_load_n[w][i] = 60.0e3;
            }
            let (angle, rate) = swing(at_s - late_s);
            for joint in 0..2 {
                s.joint_rad[joint][i] = angle[joint] + bias_rad;
                s.joint_rate_rad_s[joint][i] = rate[joint];
            }
            if i % 12 == 0 {
                s.fixes.push([at_s, x_m, y_m]);
                s.headings.push([at_s, heading, 0.0]);
            }
            let (angle, rate) = swing(at_s);
            let motion = axles.rolling(angle, rate, 1.3);
            let side_m_s = motion.side_m_s[0];
            let (sin, cos) = heading.sin_cos();
            x_m += (1.3 * cos - side_m_s * sin) * DT_S;
            y_m += (1.3 * sin + side_m_s * cos) * DT_S;
            heading += motion.turn_rad_s[0] * DT_S;
        }
        s
    }

    /// Root mean square of what is told of a run, floors.
    fn floors(s: &Signals, effects: &Effects) -> f64 {
        let told = yaw_rate_error_rad_s(s, &Machine::xt28(), effects.into()).into_iter();
        let told: Samples = told.filter(|error| error.is_finite()).collect();
        assert!(told.len() > 300, "{}", told.len());
        let square = told.iter().map(|error| error * error).sum::<f64>() / told.len() as f64;
        square.sqrt() / Signal::YawRate.floor().sigma
    }

    #[test]
    fn a_machine_turns_as_its_joints_say() {
        let left = floors(&winding(0.0, 0.0), &Effects::default());
        assert!(left < 0.5, "{left}");
    }

    #[test]
    fn joints_that_are_elsewhere_or_were_there_before_are_told() {
        for (bias_rad, late_s) in [(0.03, 0.0), (-0.03, 0.0), (0.0, 0.3)] {
            let left = floors(&winding(bias_rad, late_s), &Effects::default());
            assert!(left > 2.0, "{bias_rad} rad, {late_s} s: {left}");
        }
    }

    #[test]
    fn a_receiver_that_is_late_is_so_beside_joints_too() {
        let late = winding(0.0, -0.3);
        let mut effects = Effects::default();
        let without = floors(&late, &effects);
        effects.sensors.gnss_latency.delay_s = 0.3;
        let with = floors(&late, &effects);
        assert!(without > 2.0 && with < 0.5, "{without}, with a late receiver {with}");
    }

    #[test]
    fn a_machine_that_slides_turns_less_and_not_more_or_earlier() {
        let mut slippery = Effects::default();
        for w in Wheel::ALL {
            slippery.wheels[w].slippery_ground.friction_factor = 0.1;
        }
        let mut less = winding(0.0, 0.0);
        less.headings.iter_mut().for_each(|heading| heading[1] *= 0.87);
        let [believed, not] = [&slippery, &Effects::default()].map(|e| floors(&less, e));
        assert!(not > 1.0 && believed < 0.5, "{not}, on slippery ground {believed}");
        let early = floors(&winding(0.0, 0.3), &slippery);
        assert!(early > 2.0, "{early}");
    }

    #[test]
    fn nothing_is_told_at_standstill_or_without_a_receiver() {
        let told = |s: &Signals| {
            let effects = Effects::default();
            let errors = yaw_rate_error_rad_s(s, &Machine::xt28(), (&effects).into());
            errors.iter().any(|error| error.is_finite())
        };
        assert!(!told(&still(20)));
        let mut blind = winding(0.0, 0.0);
        blind.headings.clear();
        assert!(!told(&blind));
    }
}
