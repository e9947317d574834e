//! The articulation joints on measured inputs: the valve's opening in, how far the oil leads the joint out.
//!
//! The lock turns a joint by k (oil - angle), and what turns it against its damper and against the
//! tyres is known: so the oil that the valve has let in can be held against the joint's own motion at
//! every instant, and nothing has to be integrated but the valve. A relief valve gives way to what is
//! measured; the torque it then lets stand must still be the one that this motion takes.

use xt28_machine::Machine;
use xt28_sim::{Effects, Steering};

use super::controllers::steer_opening_asked;
use super::current_step::{STEER_STEP, within_step};
use super::scrub::scrubs_nm;
use crate::diagnosis::belief::EffectSchedule;
use crate::diagnosis::floor::Signal;
use crate::diagnosis::signals::{DT_S, Samples, Signals, moving_mean};

/// What the oil leads the joint by less what this motion takes.
#[derive(Clone, Debug, Default)]
pub(super) struct JointErrors {
    /// Mean over [`SLOW_S`], rad: rates, play, scrub.
    pub(super) slow_rad: Samples,
    /// What changes faster, rad: delays and lags.
    pub(super) fast_rad: Samples,
    /// Rate at which the relief valve would have to let oil go for the joint to move as it does, mean over
    /// [`SLOW_S`], rad/s, where that motion takes less torque than the valve holds: the torque that
    /// stands hides by how much a rate is wrong.
    pub(super) relief_rad_s: Samples,
}

impl JointErrors {
    /// Each with the signal that it is an error of.
    pub(super) fn by_signal(self) -> [(Signal, Samples); 3] {
        [
            (Signal::JointAngle, self.slow_rad),
            (Signal::JointFast, self.fast_rad),
            (Signal::JointRelief, self.relief_rad_s),
        ]
    }
}

/// What is slower is told by the scrub of tyres as much as by the valve, s.
const SLOW_S: f64 = 1.0;
/// What sound machines leave of the slow and of the fast error while they steer, in floors (nominal logs
/// of a second plant, and sound machines of our own).
const ORDINARY: [f64; 2] = [0.8, 0.7];
/// Half a play beyond which its time counts wholly, rad: less is told by no wire.
const EXCUSED_RAD: f64 = 0.0025;
/// Share of the relief valve's torque up to which a motion is sure to take less (assumed: what tyres take is
/// known to a third).
const SURELY_LESS: f64 = 0.85;

/// Errors of the front (0) or rear (1) joint over a run.
#[must_use]
pub(super) fn joint_errors(
    signals: &Signals,
    machine: &Machine,
    schedule: EffectSchedule<'_>,
    joint: usize,
) -> JointErrors {
    let effects = schedule.effects;
    let steering = &Steering::both(machine, &effects.steering)[joint];
    let mut state = steering.straight(DT_S);
    let angle = &signals.joint_rad[joint];
    let stiffness_nm = steering.stiffness_nm();
    let half_play = 0.5 * effects.steering.backlash.width_rad;
    let reach = machine.articulation.torque_max_nm / stiffness_nm + half_play;
    let openings = finer_openings(signals, machine, schedule, joint);
    let mut oil_rad = angle.first().copied().unwrap_or_default();
    // Within the play nothing is held: where the joint is then is the ground's matter, and a play that
    // is wide enough would explain anything. So that time counts as an ordinary error, also where it
    // would be less without a play: counted as that, sound machines get one (docs/diagnosis-log.md, item 48).
    let excused = (half_play / EXCUSED_RAD).powi(2).min(1.0);
    let mut is_free = vec![false; signals.len];
    // Until the first turn of a run a joint stands as it would without a play, and costs no more.
    let untouched = untouched(angle, &signals.steer_opening[joint]);
    let mut let_go_rad_s = vec![0.0; signals.len];
    let damp = |rate_rad_s: &f64| steering.damping_nms() * rate_rad_s;
    let damped_nm: Samples = signals.joint_rate_rad_s[joint].iter().map(damp).collect();
    let mut error: Samples = (0..signals.len)
        .map(|i| {
            let rate = steering.open(&mut state, openings[i], DT_S);
            let led_rad = oil_rad + rate * DT_S;
            oil_rad = led_rad.clamp(angle[i] - reach, angle[i] + reach);
            let_go_rad_s[i] = (led_rad - oil_rad) / DT_S;
            let gap = oil_rad - angle[i];
            let twist = gap - gap.clamp(-half_play, half_play);
            is_free[i] = i >= untouched && half_play > 0.0 && twist == 0.0;
            (if i < untouched { gap } else { twist }) - damped_nm[i] / stiffness_nm
        })
        .collect();
    let scrub_nm =
        scrub_of_make(signals, machine, effects, joint, (&error, &is_free, stiffness_nm));
    for i in 0..signals.len {
        if (damped_nm[i] + scrub_nm[i]).abs() >= SURELY_LESS * machine.articulation.torque_max_nm {
            let_go_rad_s[i] = 0.0;
        }
        error[i] = if is_free[i] { 0.0 } else { error[i] - scrub_nm[i] / stiffness_nm };
    }
    let mut slow_rad = moving_mean(&error, SLOW_S);
    let mut fast_rad: Samples = error.iter().zip(&slow_rad).map(|(all, slow)| all - slow).collect();
    for i in (0..signals.len).filter(|&i| is_free[i]) {
        slow_rad[i] = excused * ORDINARY[0] * Signal::JointAngle.floor().sigma;
        fast_rad[i] = excused * ORDINARY[1] * Signal::JointFast.floor().sigma;
    }
    JointErrors { slow_rad, fast_rad, relief_rad_s: moving_mean(&let_go_rad_s, SLOW_S) }
}

/// What the tyres take of a joint: of firm ones, or of ones of a make that creep, or in between, as leaves least of
/// `error`, which is without it.
fn scrub_of_make(
    signals: &Signals,
    machine: &Machine,
    effects: &Effects,
    joint: usize,
    (error, is_free, stiffness_nm): (&[f64], &[bool], f64),
) -> Samples {
    let [mut firm, creeping] = scrubs_nm(signals, machine, effects, joint);
    let (mut product, mut square) = (0.0, f64::MIN_POSITIVE);
    for i in (0..signals.len).filter(|&i| !is_free[i]) {
        let more_nm = creeping[i] - firm[i];
        product += more_nm * (error[i] * stiffness_nm - firm[i]);
        square += more_nm * more_nm;
    }
    let share = (product / square).clamp(0.0, 1.0);
    firm.iter_mut().zip(&creeping).for_each(|(nm, creeping)| *nm += share * (creeping - *nm));
    firm
}

/// The first instant at which a joint has been turned, by its valve or by the ground.
fn untouched(angle_rad: &[f64], openings: &[f64]) -> usize {
    let start_rad = angle_rad.first().copied().unwrap_or_default();
    let mut instants = angle_rad.iter().zip(openings);
    let is_touched =
        |(angle, opening): (&f64, &f64)| *opening != 0.0 || (angle - start_rad).abs() > EXCUSED_RAD;
    instants.position(is_touched).unwrap_or(angle_rad.len())
}

/// Openings finer than the wire tells them: what the ECU's law asks for, within the step logged. By the law that is
/// believed: one that always asks for more than the ECU's does would have the valve open wider by half a step at
/// every instant, and the joint's oil sums that up.
fn finer_openings(
    signals: &Signals,
    machine: &Machine,
    schedule: EffectSchedule<'_>,
    joint: usize,
) -> Samples {
    let asked = steer_opening_asked(signals, machine, schedule, joint);
    let within = |(asked, logged): (&f64, &f64)| within_step(*asked, *logged, STEER_STEP);
    asked.iter().zip(&signals.steer_opening[joint]).map(within).collect()
}

#[cfg(test)]
mod tests {
    use xt28_machine::Wheel;

    use super::super::still::still;
    use super::*;

    /// Largest rate not followed, as a share of its floor, of a front joint that turns right at `share` of the
    /// rate at which its valve lets it, the valve half open for 4 s.
    fn not_followed(share: f64) -> f64 {
        let (machine, effects) = (Machine::xt28(), Effects::default());
        let mut signals = still(10);
        let [steering, _] = Steering::both(&machine, &effects.steering);
        let mut state = steering.straight(DT_S);
        let mut angle_rad = 0.0;
        for i in 0..signals.len {
            let opening = if (200..600).contains(&i) { -0.5 } else { 0.0 };
            let rate_rad_s = share * steering.open(&mut state, opening, DT_S);
            angle_rad += rate_rad_s * DT_S;
            signals.steer_opening[0][i] = opening;
            signals.joint_rate_rad_s[0][i] = rate_rad_s;
            signals.joint_rad[0][i] = angle_rad;
        }
        let errors = joint_errors(&signals, &machine, (&effects).into(), 0);
        let largest = errors.relief_rad_s.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
        largest / Signal::JointRelief.floor().sigma
    }

    /// What it costs, in squares of floors, to believe that a front joint has a play, its valve half open from
    /// `from` to `to`.
    fn costs(from: usize, to: usize) -> f64 {
        let (machine, mut effects) = (Machine::xt28(), Effects::default());
        effects.steering.backlash.width_rad = 0.03;
        let mut signals = still(10);
        signals.steer_opening[0][from..to].fill(-0.5);
        let slow = joint_errors(&signals, &machine, (&effects).into(), 0).slow_rad;
        let sigma = Signal::JointAngle.floor().sigma;
        slow.iter().map(|rad| (rad / sigma).powi(2)).sum()
    }

    #[test]
    fn a_play_costs_nothing_until_somebody_steers() {
        assert_eq!(costs(0, 0), 0.0);
        let signals = still(10);
        assert_eq!(untouched(&signals.joint_rad[0], &signals.steer_opening[0]), signals.len);
        // Held within the play from the first turn on.
        assert!(costs(500, 501) > 0.3 * signals.len as f64, "{}", costs(500, 501));
        assert!(costs(500, 501) < 0.35 * signals.len as f64, "{}", costs(500, 501));
    }

    /// An ECU with weaker gains, a front joint that is asked to swing and stays behind: what its currents leave open is
    /// told by its own law and not by the one of a sound machine.
    #[test]
    fn openings_are_told_within_a_step_by_the_law_that_is_believed() {
        let (machine, mut weak) = (Machine::xt28(), Effects::default());
        weak.steering.gain.kp_factor = 0.7;
        let mut s = still(20);
        for w in Wheel::ALL {
            // It stands as the log begins, so that nothing is summed up.
            s.wheel_speed_rad_s[w][100..].fill(2.0);
        }
        let swing = |i: usize| 0.2 * (0.005 * i as f64).sin();
        s.target_joint_rad = (0..s.len).map(swing).collect();
        s.joint_rad[0] = (0..s.len).map(|i| swing(i.saturating_sub(40))).collect();
        let asked = steer_opening_asked(&s, &machine, (&weak).into(), 0);
        s.steer_opening[0] =
            asked.iter().map(|asked| (asked / STEER_STEP).round() * STEER_STEP).collect();
        let off = |effects: &Effects| {
            let finer = finer_openings(&s, &machine, effects.into(), 0);
            let steps = finer.iter().zip(&asked).map(|(finer, asked)| (finer - asked).abs());
            steps.sum::<f64>() / (STEER_STEP * s.len as f64)
        };
        assert!(off(&weak) < 0.01, "{}", off(&weak));
        assert!(off(&Effects::default()) > 0.5, "{}", off(&Effects::default()));
    }

    #[test]
    fn a_rate_that_the_relief_valve_would_hide_is_told() {
        assert!(not_followed(1.0) < 0.1, "{}", not_followed(1.0));
        assert!(not_followed(0.5) > 3.0, "{}", not_followed(0.5));
    }
}
