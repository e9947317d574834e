//! Wheels against one another: all roll over the same ground, so their speeds differ only by bends and
//! by the arms' swing, and by who slips, misreads or rolls on a soft tyre.
//!
//! A wheel speed sensor sits on the arm. When an arm swings at standstill, its wheel rolls to where
//! the arm puts it, and the sensor turns with the arm beside it; both are known from the stroke.

mod creep;

use xt28_machine::{ArmPose, GRAVITY_M_S2, Machine, PerWheel, Side, Wheel};
use xt28_sim::{Effects, Parts};

use super::axles::Axles;
use super::circuits::{PRESSURE_AT_TORQUE_MAX_PA, motor_nm};
use super::grade::Grade;
use super::press::{normals_n, own_n, rolling_radius_m};
use super::stance::{Held, Holds};
use super::traction::Traction;
use crate::diagnosis::kinematics::Kinematics;
use crate::diagnosis::signals::{DT_S, SMOOTHED, Samples, Signals, median};
use creep::{creeping, creeps_at_most};

/// What rolling leaves open; `NaN` where nothing can be said.
#[derive(Clone, Debug)]
pub(super) struct RollingErrors {
    /// Each wheel's speed that the six together say less its own, rad/s as the sensor reads.
    pub(super) wheel_rad_s: PerWheel<Samples>,
    /// Speed of the front axle over ground that the wheels say, m/s.
    pub(super) ahead_m_s: Samples,
}

/// A wheel whose cylinder carries less tells nothing of the machine's speed, N (assumed).
pub(super) const CARRYING_N: f64 = 8_000.0;
/// Torque at which a tyre creeps by as much as else separates two models, Nm (seen on the nominal logs
/// of a second plant: 0.1 m/s at 10 kNm).
const CREEPS_NM: f64 = 400.0;
/// Resistance to rolling that is ordinary, times that of the machine file: bends, scrub and a slope of half a
/// degree among it.
const ORDINARY: f64 = 1.75;
/// Speed at which a log's wheels tell what resists them, rad/s.
const TRAVELS_RAD_S: f64 = 0.3;
/// Samples of the log from one look at the wheels to the next.
pub(super) const SAMPLES_PER_LOOK: usize = 5;
/// Weight of what pushes tell of a speed, beside a wheel that holds.
const COASTS: f64 = 0.02;
/// How fast a wheel's foot may give way to what an idle motor holds it by, m/s/N: from not at all to a little
/// more than a rigid-body engine's friction of 60 kN s/m.
const CREEPS_M_S_N: [f64; 8] = [0.0, 1.2e-6, 2.0e-6, 3.2e-6, 5.0e-6, 8.0e-6, 1.25e-5, 2.0e-5];
/// Bend beyond which wheels slip by their drive more than rolling can tell, rad.
const BENT_RAD: f64 = 0.02;

/// Rolling over a run. No log says how its tyres creep where idle motors hold them or wheels roll harder than is
/// known; what the wheels part by does.
#[must_use]
pub(super) fn rolling_errors(s: &Signals, machine: &Machine, effects: &Effects) -> RollingErrors {
    let free = held_errors(s, machine, effects, None);
    let parts = Parts::new(machine, effects);
    let Some(held) = Held::new(s, machine, effects, &parts, 0.0) else {
        let most_m_s_n = creeps_at_most(machine, effects, &parts);
        let creep = most_m_s_n.iter().any(|(_, most)| *most > 0.0);
        return if creep { creeping(s, machine, effects, &free, &most_m_s_n) } else { free };
    };
    let left = |holds: &Holds| left_m2_s2(&free, holds, parts.radius_m);
    let holds = CREEPS_M_S_N.map(|creep_m_s_n| held.on(creep_m_s_n));
    let best = holds.iter().min_by(|a, b| left(a).total_cmp(&left(b)));
    held_errors(s, machine, effects, best)
}

/// Squares of what is about left of the wheels' speeds where `holds` drag their feet, of which none but
/// the mean moves the machine.
fn left_m2_s2(free: &RollingErrors, holds: &Holds, radius_m: f64) -> f64 {
    let at = |i: usize| {
        let slips_m_s = holds.slips_m_s(i);
        let mean_m_s = slips_m_s.sum() / 6.0;
        let of = |(w, slips_m_s): (Wheel, &f64)| {
            let error_m_s = radius_m * free.wheel_rad_s[w][i] + slips_m_s - mean_m_s;
            if error_m_s.is_finite() { error_m_s * error_m_s } else { 0.0 }
        };
        slips_m_s.iter().map(of).sum::<f64>()
    };
    (0..free.ahead_m_s.len()).step_by(SAMPLES_PER_LOOK).map(at).sum()
}

/// Rolling over a run in which idle motors hold wheels as `holds` says.
fn held_errors(
    s: &Signals,
    machine: &Machine,
    effects: &Effects,
    holds: Option<&Holds>,
) -> RollingErrors {
    let kinematics = s.kinematics(|| wheel_kinematics(s, machine));
    let parts = Parts::new(machine, effects);
    let own_n = PerWheel::from_fn(|w| own_n(machine, &parts, w));
    let mass_kg = machine.mass_kg() + effects.masses.payload.mass_kg;
    let is_plane = Grade::known(s).is_some();
    let mut errors = RollingErrors {
        wheel_rad_s: PerWheel::from_fn(|_| vec![f64::NAN; s.len]),
        ahead_m_s: vec![0.0; s.len],
    };
    let step_s = SAMPLES_PER_LOOK as f64 * DT_S;
    let (mut ahead, mut before) = (0.0, None);
    for (i, moves) in (0..s.len).step_by(SAMPLES_PER_LOOK).zip(kinematics) {
        let end = (i + SAMPLES_PER_LOOK).min(s.len);
        let load_n = |w| s.cylinder_load_n[w][i];
        let normal_n = normals_n(&own_n, load_n, &moves.pose);
        let radius_m = PerWheel::from_fn(|w| rolling_radius_m(&parts, w, normal_n[w]));
        let mut traction =
            Traction::new(s, machine, effects, &normal_n, i, (before.as_ref(), step_s));
        let held_m_s = holds.map_or(PerWheel::splat(0.0), |holds| holds.slips_m_s(i));
        traction.creeps_m_s = PerWheel::from_fn(|w| traction.creeps_m_s[w] + held_m_s[w]);
        let ground_m_s = ground_speeds(s, effects, moves, (&radius_m, &traction), i);
        let carries = PerWheel::from_fn(|w| load_n(w) > CARRYING_N);
        let (standing_m_s, by_ahead) = (&moves.standing_m_s, &moves.by_ahead);
        let coasts_m_s = ahead + traction.speeds_up_m_s2(mass_kg) * step_s;
        let (mut product, mut square) = (0.0, 0.0);
        for (wheel, _) in carries.iter().filter(|(_, carries)| **carries) {
            let (by_ahead, holds) = (by_ahead[wheel], traction.holds[wheel]);
            product += holds * by_ahead * (ground_m_s[wheel] - standing_m_s[wheel]);
            square += holds * by_ahead * by_ahead;
            // Where all slide nothing tells the speed but what they push with.
            product += (1.0 - holds) * COASTS * coasts_m_s;
            square += (1.0 - holds) * COASTS;
        }
        // Where no wheel carries the machine, none says that it stands.
        if square == 0.0 {
            errors.ahead_m_s[i..end].fill(ahead);
            continue;
        }
        ahead = product / square;
        errors.ahead_m_s[i..end].fill(ahead);
        // At the ends of a log a smooth slope is not that of what the wheels say.
        let is_whole = i >= SMOOTHED && i + SMOOTHED <= s.len;
        let is_told =
            is_plane && is_whole && s.joint_rad.iter().all(|rad| rad[i].abs() <= BENT_RAD);
        for (wheel, _) in carries.iter().filter(|(_, carries)| **carries) {
            let e = &effects.wheels[wheel];
            let error = standing_m_s[wheel] + ahead * by_ahead[wheel] - ground_m_s[wheel];
            let told_m_s = traction.told_m_s(wheel, error);
            if is_told {
                let per_m =
                    e.wheel_speed_scale.factor / (radius_m[wheel] * (1.0 - e.slippery_ground.slip));
                errors.wheel_rad_s[wheel][i..end].fill(told_m_s * per_m / doubt(s, machine, i));
            }
        }
        before = Some(traction);
    }
    errors
}

/// How many times wider a wheel's speed is to be taken at the torque of sample `i`, from one.
fn doubt(s: &Signals, machine: &Machine, i: usize) -> f64 {
    let over = |a: usize| (s.pump_pressure_pa[a + 1][i] - s.pump_pressure_pa[a][i]).abs();
    let torque_nm =
        0.5 * (over(0) + over(2)) * machine.wheels.torque_max_nm / PRESSURE_AT_TORQUE_MAX_PA;
    1.0 + (torque_nm + s.resists_nm) / CREEPS_NM
}

/// Lets all runs of one machine know with what torque its wheels resist their rolling, by those that travel.
pub fn share_resistance<'a>(runs: impl Iterator<Item = &'a mut Signals>, machine: &Machine) {
    let runs: Vec<&mut Signals> = runs.collect();
    let most_nm = runs.iter().map(|s| resists_nm(s, machine)).fold(0.0, f64::max);
    runs.into_iter().for_each(|s| s.resists_nm = most_nm);
}

/// Torque with which a log's wheels resist their rolling beyond what is ordinary, Nm, by what its motors make
/// while it travels. Tyres creep by it as by a motor's, and where arms swing at standstill by it alone.
fn resists_nm(s: &Signals, machine: &Machine) -> f64 {
    let w = &machine.wheels;
    let torques_nm = (0..s.len)
        .step_by(SAMPLES_PER_LOOK)
        .map(|i| (i, s.mean_wheel_speed_rad_s(i)))
        .filter(|(_, speed)| speed.abs() > TRAVELS_RAD_S)
        .map(|(i, speed)| {
            let front = motor_nm(s, machine, Wheel::Fr, i) + motor_nm(s, machine, Wheel::Fl, i);
            0.5 * front * speed.signum()
        })
        .filter(|nm| nm.is_finite());
    let Some(median_nm) = median(torques_nm) else { return 0.0 };
    let weight_nm = machine.mass_kg() * GRAVITY_M_S2 * w.radius_m / 6.0;
    (median_nm - ORDINARY * w.rolling_resistance * weight_nm).max(0.0)
}

/// How wheels move with their arms and frames at each step.
pub(super) fn wheel_kinematics(s: &Signals, machine: &Machine) -> Vec<Kinematics> {
    let (axles, linkage) = (Axles::new(machine), machine.linkage());
    let at = |i: usize| {
        let pose = PerWheel::from_fn(|w| linkage.at_stroke(s.smooth_stroke_m[w][i]));
        let after = PerWheel::from_fn(|w| linkage.at_stroke(s.smooth_stroke_m[w][i] + 1e-4));
        let by_stroke = |w: Wheel, of: fn(&ArmPose) -> f64| {
            // Front arms point forward, the others backward.
            let forward = if w.axle() as usize == 0 { 1.0 } else { -1.0 };
            (of(&after[w]) - of(&pose[w])) / 1e-4 * forward * s.smooth_stroke_rate_m_s[w][i]
        };
        let [joint, rate] =
            [&s.joint_rad, &s.joint_rate_rad_s].map(|of| [0, 1].map(|j: usize| of[j][i]));
        let [standing_m_s, one] =
            [0.0, 1.0].map(|ahead| expected_speeds(&axles, machine, joint, rate, ahead));
        Kinematics {
            turns_rad_s: PerWheel::from_fn(|w| by_stroke(w, |pose| pose.angle_rad)),
            carried_m_s: PerWheel::from_fn(|w| by_stroke(w, |pose| pose.reach_m)),
            by_ahead: PerWheel::from_fn(|w| one[w] - standing_m_s[w]),
            standing_m_s,
            pose,
        }
    };
    (0..s.len).step_by(SAMPLES_PER_LOOK).map(at).collect()
}

/// Speed at which each wheel's frame goes over the ground by what its sensor reads, m/s.
fn ground_speeds(
    s: &Signals,
    effects: &Effects,
    moves: &Kinematics,
    (radius_m, traction): (&PerWheel<f64>, &Traction),
    i: usize,
) -> PerWheel<f64> {
    PerWheel::from_fn(|w| {
        let e = &effects.wheels[w];
        let rolls = s.smooth_wheel_speed_rad_s[w][i] / e.wheel_speed_scale.factor * radius_m[w];
        // Arms swing by more than a sensor reads that reads in proportion too little.
        let swings = 1.0 / e.stroke_scale.factor;
        let turns = swings * moves.turns_rad_s[w] * radius_m[w];
        // Turned on its arm and with its arm it rolls; less what it is carried ahead of its frame.
        let travels = (rolls + turns) * (1.0 - e.slippery_ground.slip) - traction.creeps_m_s[w];
        travels - swings * moves.carried_m_s[w]
    })
}

/// Speed of each wheel's frame ahead there on a machine whose front axle goes `ahead`, m/s.
fn expected_speeds(
    axles: &Axles,
    machine: &Machine,
    joint: [f64; 2],
    rate: [f64; 2],
    ahead: f64,
) -> PerWheel<f64> {
    let motion = axles.rolling(joint, rate, ahead);
    let half_track = machine.wheels.track_m / 2.0;
    PerWheel::from_fn(|w| {
        let frame = w.axle() as usize;
        let left = if w.side() == Side::Left { half_track } else { -half_track };
        motion.along_m_s[frame] - left * motion.turn_rad_s[frame]
    })
}

#[cfg(test)]
mod tests {
    use xt28_machine::Axle;

    use super::super::circuits::PRESSURE_AT_TORQUE_MAX_PA;
    use super::super::still::still;
    use super::*;

    /// A machine whose front arms swing to and fro by 4 cm at standstill while all sensors say that no wheel
    /// turns beside its arm.
    fn swinging() -> Signals {
        let mut s = still(20);
        for w in Wheel::ALL {
            s.cylinder_load_n[w].fill(60.0e3);
            s.smooth_stroke_m[w].fill(0.2);
            s.stroke_m[w].fill(0.2);
        }
        for i in 200..s.len {
            let (sin, cos) = (2.0 * f64::from(u32::try_from(i - 200).unwrap()) * DT_S).sin_cos();
            for w in Wheel::ALL.into_iter().filter(|w| w.axle() == Axle::Front) {
                s.smooth_stroke_m[w][i] = 0.2 + 0.04 * sin;
                s.smooth_stroke_rate_m_s[w][i] = 0.08 * cos;
            }
        }
        s
    }

    fn largest_rad_s(motors_hold_by_nm: f64) -> f64 {
        let mut effects = Effects::default();
        for w in Wheel::ALL {
            effects.wheels[w].standstill_drag.torque_nm = motors_hold_by_nm;
        }
        let errors = rolling_errors(&swinging(), &Machine::xt28(), &effects);
        // Not before an arm has swung, nor at the end, which no smooth slope tells.
        let of =
            |(_, e): (_, &Samples)| e[300..1900].iter().fold(0.0_f64, |most, e| most.max(e.abs()));
        errors.wheel_rad_s.iter().map(of).fold(0.0, f64::max)
    }

    #[test]
    fn idle_motors_that_hold_keep_wheels_from_rolling_by_the_swing_of_their_arms() {
        let [free, held] = [0.0, 6.0e3].map(largest_rad_s);
        assert!(free > 0.03, "{free}");
        assert!(held < 0.3 * free, "{held} of {free}");
    }

    /// A machine that drives straight on tyres that creep by 6 um/s a newton, its left wheels rolling harder by
    /// `added`, all pushed alike by 1.5 kNm.
    fn dragged(added: f64) -> Signals {
        let (machine, mut s) = (Machine::xt28(), still(20));
        for pump in [1, 3] {
            s.pump_pressure_pa[pump]
                .fill(1.5e3 / machine.wheels.torque_max_nm * PRESSURE_AT_TORQUE_MAX_PA);
        }
        for w in Wheel::ALL {
            s.cylinder_load_n[w].fill(25.0e3);
            let slower = if w.side() == Side::Left { 6.0e-6 * added * 25.0e3 } else { 0.0 };
            for speed in [&mut s.smooth_wheel_speed_rad_s[w], &mut s.wheel_speed_rad_s[w]] {
                speed.fill((1.0 - slower) / machine.wheels.radius_m);
            }
        }
        s
    }

    #[test]
    fn wheels_that_roll_harder_than_others_turn_slower_on_tyres_that_creep() {
        let (s, machine) = (dragged(0.06), Machine::xt28());
        let largest = |harder: &[Wheel]| {
            let mut effects = Effects::default();
            for w in harder {
                effects.wheels[*w].rolling_resistance.added = 0.06;
            }
            let errors = rolling_errors(&s, &machine, &effects);
            let of =
                |(_, e): (_, &Samples)| e[500..1500].iter().fold(0.0_f64, |m, e| m.max(e.abs()));
            errors.wheel_rad_s.iter().map(of).fold(0.0, f64::max)
        };
        let left = largest(&[Wheel::Fl, Wheel::Ml, Wheel::Bl]);
        for others in [&[][..], &Wheel::ALL, &[Wheel::Fr, Wheel::Mr, Wheel::Br], &[Wheel::Ml]] {
            let other = largest(others);
            assert!(left < 0.6 * other, "{left}, with {others:?} {other}");
        }
    }

    #[test]
    fn arms_swing_by_more_than_a_sensor_reads_that_reads_too_little() {
        let (machine, mut s, factor) = (Machine::xt28(), swinging(), 0.8);
        for (k, moves) in wheel_kinematics(&s, &machine).iter().enumerate() {
            for w in Wheel::ALL {
                // A wheel that rolls to where its arm puts it.
                let rolls_rad_s =
                    moves.carried_m_s[w] / machine.wheels.radius_m - moves.turns_rad_s[w];
                s.smooth_wheel_speed_rad_s[w][k * SAMPLES_PER_LOOK..(k + 1) * SAMPLES_PER_LOOK]
                    .fill(rolls_rad_s / factor);
            }
        }
        let largest = |scale: f64| {
            let mut effects = Effects::default();
            effects.wheels.0.iter_mut().for_each(|e| e.stroke_scale.factor = scale);
            let errors = rolling_errors(&s, &machine, &effects).wheel_rad_s;
            let of = |(_, e): (_, &Samples)| {
                e[300..1900].iter().fold(0.0_f64, |most, e| most.max(e.abs()))
            };
            errors.iter().map(of).fold(0.0, f64::max)
        };
        assert!(largest(factor) < 0.1 * largest(1.0), "{} of {}", largest(factor), largest(1.0));
    }

    /// Left wheels that give way along the ground as they push, all pushed alike by 1.5 kNm.
    #[test]
    fn tyres_that_are_softer_may_creep_as_well() {
        let (mut s, machine) = (dragged(0.0), Machine::xt28());
        for w in Wheel::ALL.into_iter().filter(|w| w.side() == Side::Left) {
            for speed in [&mut s.smooth_wheel_speed_rad_s[w], &mut s.wheel_speed_rad_s[w]] {
                speed.iter_mut().for_each(|rad_s| *rad_s += 0.04);
            }
        }
        let largest = |stiffness_n_m: Option<f64>| {
            let mut effects = Effects::default();
            for w in Wheel::ALL.into_iter().filter(|w| w.side() == Side::Left) {
                if let Some(stiffness_n_m) = stiffness_n_m {
                    effects.wheels[w].soft_tyre.stiffness_n_m = stiffness_n_m;
                }
            }
            let errors = rolling_errors(&s, &machine, &effects).wheel_rad_s;
            let of =
                |(_, e): (_, &Samples)| e[500..1500].iter().fold(0.0_f64, |m, e| m.max(e.abs()));
            errors.iter().map(of).fold(0.0, f64::max)
        };
        let [stiff, soft] = [None, Some(2.0e6)].map(largest);
        assert!(soft < 0.3 * stiff, "{soft} of {stiff}");
    }
}
