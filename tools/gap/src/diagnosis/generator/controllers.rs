//! The steering controllers on measured inputs: command and reading in, the opening they ask for out.

use xt28_machine::Machine;

use super::current_step::{STEER_STEP, middle_of_cut};
use super::summed::best_sum;
use crate::diagnosis::belief::EffectSchedule;
use crate::diagnosis::signals::{DT_S, Samples, Signals};

/// Limit of the steering integral, deg s (the machine's conventions).
pub(in crate::diagnosis) const STEER_WINDUP_DEG_S: f64 = 40.0;
/// Halvings of a tenth of that, to a fifth of a thousandth of it.
const HALVINGS: usize = 9;

/// Opening that the steering PI would ask of the front (0) or rear (1) joint less the one asked for.
///
/// Which of two neighbouring samples the ECU saw is not known: where what it would ask jumps between
/// them, anything in between is right. Nor is it known whether a current is rounded to the wire's steps or
/// cut off: it is taken for what leaves less of the front joint, for both come from one ECU, and a rear joint that
/// follows otherwise than is believed may look as if its currents were of the other kind. `NaN` where the machine is
/// about to start or to stop.
#[must_use]
pub(super) fn steer_opening_error(
    signals: &Signals,
    machine: &Machine,
    schedule: EffectSchedule<'_>,
    joint: usize,
) -> Samples {
    let [rounded, cut] = errors_of(signals, machine, schedule, 0);
    let squares = |errors: &Samples| -> f64 {
        errors.iter().filter(|error| !error.is_nan()).map(|error| error * error).sum()
    };
    let is_cut = squares(&cut) < squares(&rounded);
    let [rounded, cut] =
        if joint == 0 { [rounded, cut] } else { errors_of(signals, machine, schedule, joint) };
    if is_cut { cut } else { rounded }
}

/// What is asked of a joint less what its currents mean, where they are rounded and where they are cut off.
fn errors_of(
    signals: &Signals,
    machine: &Machine,
    schedule: EffectSchedule<'_>,
    joint: usize,
) -> [Samples; 2] {
    let asked = steer_opening_asked(signals, machine, schedule, joint);
    let logged = &signals.steer_opening[joint];
    let cut: Samples = logged.iter().map(|opening| middle_of_cut(*opening, STEER_STEP)).collect();
    let kinds = [(logged, 0.5 * STEER_STEP), (&cut, STEER_STEP)];
    kinds.map(|(meant, unseen)| error_of(signals, machine, [&asked, meant], unseen))
}

/// What is asked less what is meant by the currents logged, sample by sample. Where there is none, anything up to
/// `unseen` may be asked: near its target a joint is asked for less than a step for seconds, which is no noise.
fn error_of(
    signals: &Signals,
    machine: &Machine,
    [asked, meant]: [&Samples; 2],
    unseen: f64,
) -> Samples {
    let end = signals.len.saturating_sub(1);
    let threshold_m_s = machine.articulation.speed_threshold_m_s;
    let mut error = 0.0;
    (0..signals.len)
        .map(|i| {
            if signals.is_fresh_drive_current[i] {
                let near = &asked[i.saturating_sub(1)..=(i + 1).min(end)];
                let least = near.iter().copied().fold(f64::INFINITY, f64::min);
                let most = near.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                error = meant[i].clamp(least, most) - meant[i];
                if meant[i] == 0.0 {
                    error = (error.abs() - unseen).max(0.0).copysign(error);
                }
            }
            let speed_m_s = signals.mean_wheel_speed_rad_s(i) * machine.wheels.radius_m;
            let starts =
                speed_m_s.abs() > 0.5 * threshold_m_s && speed_m_s.abs() < 2.0 * threshold_m_s;
            if starts { f64::NAN } else { error }
        })
        .collect()
}

/// Opening that the steering PI would ask of the front (0) or rear (1) joint at every sample.
///
/// What the PI had summed up before the log began is in no log of a machine that was driving then: the
/// sum that fits best is taken. A machine that stands has none. A follower that becomes another within the run has
/// summed up the errors of the one before.
#[must_use]
pub(super) fn steer_opening_asked(
    signals: &Signals,
    machine: &Machine,
    schedule: EffectSchedule<'_>,
    joint: usize,
) -> Samples {
    let pi = Pi::new(signals, machine, schedule, joint);
    let stands = (0..signals.len).find(|i| pi.error_deg[*i].is_none());
    let driving = stands.unwrap_or(signals.len);
    pi.asked(signals.len, pi.best_sum(driving)).collect()
}

/// The steering PI (paper; gains and threshold of the machine file) on what it had before it.
struct Pi<'a> {
    kp_per_deg: f64,
    ki_per_s: f64,
    /// Target less angle; none where the machine is too slow to steer.
    error_deg: Vec<Option<f64>>,
    /// Openings logged.
    logged: &'a [f64],
}

impl<'a> Pi<'a> {
    fn new(
        signals: &'a Signals,
        machine: &Machine,
        schedule: EffectSchedule<'_>,
        joint: usize,
    ) -> Self {
        let (a, gain) = (&machine.articulation, schedule.effects.steering.gain);
        let deg = |rad: f64| rad.to_degrees();
        let mut followed_deg = signals.joint_rad[0].first().map_or(0.0, |rad| deg(*rad));
        let followers = schedule.of(|effects| effects.steering.rear_follower);
        let error_deg = |i: usize| {
            let follower = followers.at(i as f64 * DT_S);
            let front_deg = deg(signals.joint_rad[0][i]);
            followed_deg = if follower.time_constant_s > 0.0 {
                front_deg + (followed_deg - front_deg) * (-DT_S / follower.time_constant_s).exp()
            } else {
                front_deg
            };
            let speed_m_s = signals.mean_wheel_speed_rad_s(i) * machine.wheels.radius_m;
            let target_deg = match joint {
                0 => deg(signals.target_joint_rad[i]),
                _ => a.rear_ratio * follower.ratio_factor * followed_deg,
            };
            let error_deg = target_deg - deg(signals.joint_rad[joint][i]);
            (speed_m_s.abs() >= a.speed_threshold_m_s).then_some(error_deg)
        };
        Self {
            kp_per_deg: a.kp_per_deg * gain.kp_factor,
            ki_per_s: a.ki_per_s * gain.ki_factor,
            error_deg: (0..signals.len).map(error_deg).collect(),
            logged: &signals.steer_opening[joint],
        }
    }

    /// What is asked over the first `len` samples with `sum_deg_s` summed up before.
    fn asked(&self, len: usize, mut sum_deg_s: f64) -> impl Iterator<Item = f64> {
        self.error_deg[..len].iter().map(move |error_deg| {
            let Some(error_deg) = error_deg else {
                sum_deg_s = 0.0;
                return 0.0;
            };
            sum_deg_s =
                (sum_deg_s + error_deg * DT_S).clamp(-STEER_WINDUP_DEG_S, STEER_WINDUP_DEG_S);
            (self.kp_per_deg * (error_deg + self.ki_per_s * sum_deg_s)).clamp(-1.0, 1.0)
        })
    }

    /// The sum before the log by which the first `driving` samples fit best.
    fn best_sum(&self, driving: usize) -> f64 {
        if driving == 0 {
            return 0.0;
        }
        best_sum(STEER_WINDUP_DEG_S, HALVINGS, |sum| {
            self.asked(driving, sum).zip(self.logged).map(|(a, logged)| (a - logged).powi(2)).sum()
        })
    }
}

#[cfg(test)]
mod tests {
    use xt28_machine::Wheel;
    use xt28_sim::Effects;

    use super::super::still::still;
    use super::*;

    /// A machine that turns, its rear joint told to follow 0.5 s behind, its currents rounded to the wire's steps.
    fn turning(machine: &Machine) -> Signals {
        let mut s = still(20);
        for w in Wheel::ALL {
            s.wheel_speed_rad_s[w].fill(2.0);
        }
        s.is_fresh_drive_current.fill(true);
        for i in 0..s.len {
            let t = i as f64 * DT_S;
            // Steadily to one side and back, so that what is late is late by the same all the while.
            let front_rad = |t: f64| 0.45 - 0.09 * (t - 10.0).abs();
            s.joint_rad[0][i] = front_rad(t);
            s.joint_rad[1][i] = 0.5 * front_rad(t - 1.5);
            s.target_joint_rad[i] = front_rad(t + 1.0);
        }
        for joint in [0, 1] {
            let asked = steer_opening_asked(&s, machine, (&late(0.5)).into(), joint);
            s.steer_opening[joint] =
                asked.iter().map(|asked| (asked / STEER_STEP).round() * STEER_STEP).collect();
        }
        s
    }

    fn late(time_constant_s: f64) -> Effects {
        let mut effects = Effects::default();
        effects.steering.rear_follower.time_constant_s = time_constant_s;
        effects
    }

    #[test]
    fn a_joint_that_is_asked_for_less_than_a_step_is_no_other_controller() {
        let machine = Machine::xt28();
        let mut s = still(20);
        for w in Wheel::ALL {
            s.wheel_speed_rad_s[w].fill(2.0);
        }
        s.is_fresh_drive_current.fill(true);
        let per_rad = machine.articulation.kp_per_deg * 1_f64.to_degrees();
        let left = |s: &Signals| {
            let errors = steer_opening_error(s, &machine, (&Effects::default()).into(), 0);
            errors.into_iter().filter(|e| !e.is_nan()).fold(0.0_f64, |most, e| most.max(e.abs()))
        };
        // Now to one side and now to the other, so that nothing is summed up.
        let mut off = |steps: f64| {
            for i in 0..s.len {
                let side = if i % 200 < 100 { 1.0 } else { -1.0 };
                s.joint_rad[0][i] = side * steps * STEER_STEP / per_rad;
            }
            left(&s)
        };
        let [little, much] = [0.4, 3.0].map(&mut off);
        assert!(little == 0.0 && much > 1.5 * STEER_STEP, "{little} {much}");
    }

    /// Currents taken for cut off make up for a follower that is too quick.
    #[test]
    fn currents_of_the_rear_joint_are_of_the_kind_of_the_front_ones() {
        let machine = Machine::xt28();
        let s = turning(&machine);
        let squares = |time_constant_s: f64| -> f64 {
            let errors = steer_opening_error(&s, &machine, (&late(time_constant_s)).into(), 1);
            errors.iter().filter(|error| !error.is_nan()).map(|error| error * error).sum()
        };
        let squares = [0.38, 0.44, 0.5].map(squares);
        assert!(squares[0] > 10.0 * squares[2] && squares[1] > 3.0 * squares[2], "{squares:?}");
    }

    fn pi(logged: &[f64]) -> Pi<'_> {
        let steering = (0..600).map(|i| Some(9.0 * (f64::from(i) * 0.02).sin()));
        let stands = core::iter::repeat_n(None, 100);
        let again = (0..300).map(|i| Some(4.0 - 0.01 * f64::from(i)));
        let error_deg = steering.chain(stands).chain(again).collect();
        Pi { kp_per_deg: 0.025, ki_per_s: 0.2, error_deg, logged }
    }

    #[test]
    fn what_was_summed_up_before_a_log_that_begins_while_driving_is_found() {
        for sum_deg_s in [-33.3, -7.0, 0.0, 18.8, 40.0] {
            let logged: Vec<f64> = pi(&[]).asked(1000, sum_deg_s).collect();
            let found = pi(&logged).best_sum(600);
            assert!((found - sum_deg_s).abs() < 0.02, "{sum_deg_s}: {found}");
        }
    }

    #[test]
    fn a_machine_that_stands_forgets_what_was_summed_up() {
        let from = |sum_deg_s| pi(&[]).asked(1000, sum_deg_s).collect::<Vec<f64>>();
        let [none, much] = [from(0.0), from(30.0)];
        assert!(none[300] < much[300]);
        assert_eq!(none[600..], much[600..]);
    }

    /// A follower that turns half as far from 10 s on: what it had summed up until then is that of a sound one.
    #[test]
    fn a_follower_that_becomes_another_has_summed_up_what_was_before() {
        let (machine, sound) = (Machine::xt28(), Effects::default());
        let (mut s, mut half) = (turning(&machine), Effects::default());
        half.steering.rear_follower.ratio_factor = 0.5;
        // It stands as the log begins, so that nothing is summed up.
        Wheel::ALL.into_iter().for_each(|w| s.wheel_speed_rad_s[w][..100].fill(0.0));
        let late = EffectSchedule::late(&sound, 10.0, &half);
        s.steer_opening[1] = steer_opening_asked(&s, &machine, late, 1);
        let asked = |schedule| steer_opening_asked(&s, &machine, schedule, 1);
        let [always, never] = [asked((&half).into()), asked((&sound).into())];
        assert!(s.steer_opening[1][..999] == never[..999]);
        let parts = |other: &Samples| (s.steer_opening[1][1100] - other[1100]).abs();
        assert!(parts(&never) > 0.01 && parts(&always) > 0.01);
    }
}
