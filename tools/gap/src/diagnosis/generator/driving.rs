//! Engine and circuits on measured inputs: throttle and wheel speeds in, pressures out; pressures in,
//! what the wheels make of them out.
//!
//! Between throttle and pressure stands the law that holds the wheels' mean speed, and it is known;
//! so pressures tell at what speed it aimed, to a hundredth of a second. Its integral part is not
//! known: it is drawn to what was measured. Between pressure and speed stand mass, grade and rolling.

use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, Wheel};
use xt28_sim::effects::{Lag, SlipperyGround};
use xt28_sim::{Drive, DriveInput, Effects, Parts};

use super::circuits::{PRESSURE_AT_TORQUE_MAX_PA, circuit_means, circuits_pa};
use super::grade::{Grade, climbs};
use super::lifted::{is_lifted, travels_m_s};
use super::press::{normals_n, own_n};
use super::rolling::{SAMPLES_PER_LOOK, wheel_kinematics};
use super::scrub::scrub_drag_nm;
use super::traction::{TURNS_RAD_S, mean_torque_nm, wheel_kg_m2};
use crate::diagnosis::signals::{DT_S, Samples, Signals, moving_mean};

/// What the block did less what was measured.
#[derive(Clone, Debug, Default)]
pub(super) struct DriveErrors {
    /// Forward less reverse pressure, mean of both circuits, Pa.
    pub(super) pressure_pa: Samples,
    /// Half of what the first circuit has more than the second, Pa.
    pub(super) difference_pa: Samples,
    /// Mean torque on a wheel that mass, grade and rolling take, mean over [`FORCE_S`], Nm.
    pub(super) force_nm: Samples,
}

/// Time in which the integral part of the speed's control is drawn to what was measured, s.
const DRAWN_S: f64 = 0.25;
/// The frames pitch on their arms as the machine speeds up: forces balance over this time only, s.
const FORCE_S: f64 = 2.0;

/// How many times wider the difference of the circuits' pressures is to be taken while a wheel is in the air: that one
/// gains speed faster than a log of it tells (assumed).
const LIFTED_DOUBT: f64 = 2.0;

/// Drives the block with the throttle commanded and the wheel speeds measured.
#[must_use]
pub(super) fn drive_errors(signals: &Signals, machine: &Machine, effects: &Effects) -> DriveErrors {
    let (mut errors, idle_nm) = pressure_errors(signals, machine, effects);
    errors.force_nm = force_error_nm(signals, machine, effects, &idle_nm);
    errors
}

/// Errors of the pressures, and the torque by which idle motors may hold a wheel, mean of the wheels, Nm.
fn pressure_errors(
    signals: &Signals,
    machine: &Machine,
    effects: &Effects,
) -> (DriveErrors, Samples) {
    let drive = Drive::new(machine, effects);
    let mut state = drive.at_rest(DT_S);
    let nm_per_pa = machine.wheels.torque_max_nm / PRESSURE_AT_TORQUE_MAX_PA;
    let mut lag = Lag::new(signals.throttle[0]);
    let (mut common_pa, mut difference_pa, mut since_s) = (0.0, 0.0, 0.0);
    let (mut errors, mut idle_nm) = (DriveErrors::default(), Vec::with_capacity(signals.len));
    for i in 0..signals.len {
        // A command is taken up in the ECU's next period, on average one and a half samples later.
        let taken = |back: usize| signals.throttle[i.saturating_sub(back)];
        let asked = 0.5 * (taken(1) + taken(2));
        let throttle = lag.step(asked, machine.drive.speed_time_constant_s, DT_S);
        let shares = signals.motor_shares(i);
        let input = DriveInput {
            // Motors at a third: what the pump then gives is the throttle's share of full speed. Where some give
            // way to a wheel that spins, it gives way as they do.
            pump_displacement: circuit_means(machine, &shares).map(|mean| throttle * mean),
            motor_displacement: shares.map(|share| share / 3.0),
            engine_speed_rpm: machine.drive.engine_speed_rpm,
            wheel_speed_rad_s: wheel_speeds(signals, effects, i),
        };
        let out = drive.step(&mut state, &input, DT_S);
        let p = out.pump_pressure_pa;
        // What is asked idles a motor, or what is left of it behind a drive that lags: a matter of makes.
        let asked_rad_s = asked * machine.drive.speed_full_m_s / machine.wheels.radius_m;
        let idle = effects
            .wheels
            .iter()
            .map(|(w, e)| e.standstill_drag.holds_nm(asked_rad_s).max(out.hold_nm[w]));
        idle_nm.push(idle.sum::<f64>() / 6.0);
        since_s += DT_S;
        if signals.is_fresh_pump_pressure[i] {
            let over = circuits_pa(signals, i);
            let parts = [p[1] - p[0] - over[0], p[3] - p[2] - over[1]];
            common_pa = (parts[0] + parts[1]) / 2.0;
            difference_pa = difference_error_pa(
                (p[1] - p[0] - p[3] + p[2]) / 2.0,
                (over[0] - over[1]) / 2.0,
                out.power_share,
            );
            if is_lifted(signals, i) {
                difference_pa /= LIFTED_DOUBT;
            }
            let share = (since_s / DRAWN_S).min(1.0);
            state.mean_torque_nm -= share * nm_per_pa * common_pa;
            since_s = 0.0;
        }
        errors.pressure_pa.push(common_pa);
        errors.difference_pa.push(difference_pa);
    }
    (errors, idle_nm)
}

/// What the circuits' pressures differ by less what they were `measured` to, Pa, where the engine gives a share
/// of what is wanted: how pumps that swing back for it share that between them is a matter of makes, from both
/// alike to one alone.
fn difference_error_pa(difference_pa: f64, measured_pa: f64, power_share: f64) -> f64 {
    let wanted_pa = difference_pa / power_share.max(f64::MIN_POSITIVE);
    let [low, high] = [difference_pa.min(wanted_pa), difference_pa.max(wanted_pa)];
    measured_pa.clamp(low, high) - measured_pa
}

/// Wheel speeds at sample `i`, as they are behind sensors that read in proportion too much: the oil
/// knows nothing of sensors.
fn wheel_speeds(signals: &Signals, effects: &Effects, i: usize) -> PerWheel<f64> {
    let scale = |wheel: Wheel| effects.wheels[wheel].wheel_speed_scale.factor;
    PerWheel::from_fn(|wheel| signals.wheel_speed_rad_s[wheel][i] / scale(wheel))
}

/// Torque that the motion takes less the torque there was, mean of the wheels, Nm, where idle motors hold
/// by up to `idle_nm`. `NaN` on ground that is no plane: where each wheel stands is then not known well enough.
fn force_error_nm(
    signals: &Signals,
    machine: &Machine,
    effects: &Effects,
    idle_nm: &Samples,
) -> Samples {
    let Some(ground) = Grade::believed(signals, effects) else {
        return vec![f64::NAN; signals.len];
    };
    let w = &machine.wheels;
    let mass_kg = machine.mass_kg() + effects.masses.payload.mass_kg;
    let wheel_kg_m2 = wheel_kg_m2(machine);
    let carried_kg_m2 = mass_kg * w.radius_m * w.radius_m / 6.0;
    // What the machine travels by. Wheels tell that where all of them hold on to the ground.
    let slips = effects.wheels.iter().any(|(_, e)| e.slippery_ground != SlipperyGround::default());
    let travels_m_s = travels_m_s(signals, machine, effects, slips);
    let parts_from = |i: usize| slips || is_lifted(signals, i);
    let weight_nm = mass_kg * GRAVITY_M_S2 * w.radius_m / 6.0;
    let added = added_resistance(signals, machine, effects);
    let end = signals.len.saturating_sub(1);
    let scrub_nm = scrub_drag_nm(signals, machine, effects);
    let mut error = 0.0;
    let errors: Samples = (0..signals.len)
        .map(|i| {
            if signals.is_fresh_pump_pressure[i] {
                let mean = |i| wheel_speeds(signals, effects, i).sum() / 6.0;
                let (from, to) = (i.saturating_sub(5), (i + 5).min(end));
                #[allow(clippy::cast_precision_loss)] // ten samples
                let over_s = (to - from).max(1) as f64 * DT_S;
                let speeds_up = (mean(to) - mean(from)) / over_s;
                let rolls = (mean(i) / TURNS_RAD_S).tanh();
                let drag_nm = (w.rolling_resistance + added[i / SAMPLES_PER_LOOK]) * weight_nm;
                let travels_up = if parts_from(from) || parts_from(to) {
                    (travels_m_s[to] - travels_m_s[from]) / w.radius_m / over_s
                } else {
                    speeds_up
                };
                let apart = carried_kg_m2 * travels_up
                    + wheel_kg_m2 * speeds_up
                    + drag_nm * rolls
                    + weight_nm * climbs(signals, machine, effects, ground, i)
                    + scrub_nm[i]
                    - mean_torque_nm(signals, machine, i);
                // Whether idle motors brake wheels that still roll is a matter of makes.
                let idle_nm = idle_nm[i].min(w.friction * weight_nm);
                let brakes_nm = idle_nm * rolls;
                let apart = apart + (-apart).clamp(brakes_nm.min(0.0), brakes_nm.max(0.0));
                // A wheel at rest is held by anything up to its rolling resistance and its idle motor.
                let holds_nm = (drag_nm.abs() + idle_nm) * (1.0 - rolls.abs());
                error = (apart.abs() - holds_nm).max(0.0).copysign(apart);
            }
            // No log says what a parking brake takes.
            if signals.is_braked(i) { 0.0 } else { error }
        })
        .collect();
    moving_mean(&errors, FORCE_S)
}

/// What is added to the coefficient of rolling resistance, mean of the wheels, each counted by what it presses with;
/// one for every [`SAMPLES_PER_LOOK`] samples.
fn added_resistance(signals: &Signals, machine: &Machine, effects: &Effects) -> Samples {
    let added = PerWheel::from_fn(|w| effects.wheels[w].rolling_resistance.added);
    let steps = signals.len.div_ceil(SAMPLES_PER_LOOK);
    let mean = added.sum() / 6.0;
    if added.iter().all(|(_, a)| *a == added[Wheel::Fr]) {
        return vec![mean; steps];
    }
    let parts = Parts::new(machine, effects);
    let own_n = PerWheel::from_fn(|w| own_n(machine, &parts, w));
    let kinematics = signals.kinematics(|| wheel_kinematics(signals, machine));
    let each = kinematics.iter().enumerate().map(|(k, moves)| {
        let load_n = |w| signals.cylinder_load_n[w][k * SAMPLES_PER_LOOK];
        let normal_n = normals_n(&own_n, load_n, &moves.pose);
        let by_load: f64 = added.iter().map(|(w, added)| added * normal_n[w]).sum();
        let all_n = normal_n.sum();
        if all_n > 0.0 { by_load / all_n } else { mean }
    });
    each.collect()
}

#[cfg(test)]
mod tests {
    use xt28_machine::Axle;
    use xt28_sim::slip_trim_nm;

    use super::super::press::normal_n;
    use super::super::still::still;
    use super::*;

    #[test]
    fn how_two_pumps_share_a_short_engine_is_left_open_and_nothing_else_is() {
        // Held back to a half: between what both alike would leave of 8 bar and all of them.
        let of = |measured_pa| difference_error_pa(4.0e5, measured_pa, 0.5);
        assert_eq!([of(4.0e5), of(6.0e5), of(8.0e5)], [0.0; 3]);
        assert_eq!([of(3.0e5), of(9.0e5)], [1.0e5, -1.0e5]);
        assert_eq!(difference_error_pa(-4.0e5, -7.0e5, 0.5), 0.0);
        assert_eq!(difference_error_pa(4.0e5, 5.0e5, 1.0), -1.0e5);
    }

    /// Largest torque not accounted for, Nm, of a machine that goes on by itself from 5 s on, faster by `gains_m_s2`,
    /// while nothing is asked of its motors.
    fn left_nm(gains_m_s2: f64, motors_hold_by_nm: f64) -> f64 {
        left_behind_nm(0.0, gains_m_s2, motors_hold_by_nm)
    }

    /// The same of a machine whose drive lags by `lag_s`, until 5 s asked to go.
    fn left_behind_nm(lag_s: f64, gains_m_s2: f64, motors_hold_by_nm: f64) -> f64 {
        let machine = Machine::xt28();
        let (mut s, mut effects) = (still(10), Effects::default());
        let from_m_s = if gains_m_s2 < 0.0 { 1.0 } else { 0.1 };
        effects.drive.lag.time_constant_s = lag_s;
        if lag_s > 0.0 {
            s.throttle[..500].fill(1.0);
        }
        for wheel in Wheel::ALL {
            effects.wheels[wheel].standstill_drag.torque_nm = motors_hold_by_nm;
            for i in 0..s.len {
                let since_s = (f64::from(u32::try_from(i).unwrap()) * DT_S - 5.0).max(0.0);
                let goes_m_s = (from_m_s + gains_m_s2 * since_s).max(0.0);
                s.wheel_speed_rad_s[wheel][i] = goes_m_s / machine.wheels.radius_m;
            }
        }
        let errors = drive_errors(&s, &machine, &effects).force_nm;
        errors[500..].iter().fold(0.0_f64, |most, nm| most.max(nm.abs()))
    }

    #[test]
    fn idle_motors_that_hold_may_brake_a_machine_that_rolls_but_never_speed_it_up() {
        let [braked, sped] = [-0.8, 0.8].map(|gains_m_s2| left_nm(gains_m_s2, 0.0));
        assert!(braked > 500.0 && sped > 500.0, "{braked} {sped}");
        let [braked_nm, sped_nm] = [-0.8, 0.8].map(|gains_m_s2| left_nm(gains_m_s2, 5.0e3));
        assert!(braked_nm < 0.3 * braked, "{braked_nm} of {braked}");
        assert!(sped_nm > 0.9 * sped, "{sped_nm} of {sped}");
        let lags_nm = left_behind_nm(2.0, -0.8, 5.0e3);
        assert!(lags_nm < 0.3 * braked, "{lags_nm} of {braked} behind a drive that lags");
    }

    #[test]
    fn what_a_parking_brake_takes_is_no_torque_that_is_missing() {
        let machine = Machine::xt28();
        let largest_nm = |is_braked: bool| {
            let mut s = still(10);
            s.brake[500..].fill(f64::from(u8::from(is_braked)));
            s.is_fresh_pump_pressure.fill(true);
            // Pumps push against wheels that stand.
            s.pump_pressure_pa[1][500..].fill(0.3 * PRESSURE_AT_TORQUE_MAX_PA);
            let errors = drive_errors(&s, &machine, &Effects::default()).force_nm;
            errors.iter().fold(0.0_f64, |most, nm| most.max(nm.abs()))
        };
        let [pushed, braked] = [false, true].map(largest_nm);
        assert!(pushed > 500.0 && braked == 0.0, "{pushed} {braked}");
    }

    #[test]
    fn wheels_that_roll_hard_brake_by_what_they_press_with() {
        let (machine, mut s) = (Machine::xt28(), still(10));
        let weight_nm = machine.mass_kg() * GRAVITY_M_S2 * machine.wheels.radius_m / 6.0;
        let pose = machine.linkage().at_stroke(0.2);
        let parts = Parts::new(&machine, &Effects::default());
        let (mut front_n, mut all_n) = (0.0, 0.0);
        for w in Wheel::ALL {
            let is_front = w.axle() == Axle::Front;
            let load_n = if is_front { 80.0e3 } else { 20.0e3 };
            s.cylinder_load_n[w].fill(load_n);
            s.smooth_stroke_m[w].fill(0.2);
            s.wheel_speed_rad_s[w].fill(1.0);
            let presses_n = normal_n(own_n(&machine, &parts, w), load_n, &pose);
            front_n += if is_front { presses_n } else { 0.0 };
            all_n += presses_n;
        }
        let resists = machine.wheels.rolling_resistance + 0.08 * front_n / all_n;
        let over_pa =
            resists * weight_nm / machine.wheels.torque_max_nm * PRESSURE_AT_TORQUE_MAX_PA;
        [1, 3].into_iter().for_each(|side| s.pump_pressure_pa[side].fill(over_pa));
        let left_nm = |axle: Axle| {
            let mut effects = Effects::default();
            for w in Wheel::ALL.into_iter().filter(|w| w.axle() == axle) {
                effects.wheels[w].rolling_resistance.added = 0.08;
            }
            drive_errors(&s, &machine, &effects).force_nm[500].abs()
        };
        assert!(front_n > 0.5 * all_n, "{front_n} of {all_n}");
        assert!(left_nm(Axle::Front) < 1.0, "{}", left_nm(Axle::Front));
        assert!(left_nm(Axle::Rear) > 300.0, "{}", left_nm(Axle::Rear));
    }

    /// Torque not accounted for, Nm, of a machine that rolls at 1 rad/s while MR, in the air, turns at `spins_rad_s`
    /// and gains `gains_rad_s2`.
    fn left_beside_one_in_the_air_nm(spins_rad_s: f64, gains_rad_s2: f64) -> f64 {
        let (machine, mut s) = (Machine::xt28(), still(10));
        for w in Wheel::ALL {
            s.cylinder_load_n[w].fill(if w == Wheel::Mr { -20.0e3 } else { 70.0e3 });
            for i in 0..s.len {
                let since_s = f64::from(u32::try_from(i).unwrap()) * DT_S - 5.0;
                let speed = if w == Wheel::Mr { spins_rad_s + gains_rad_s2 * since_s } else { 1.0 };
                s.wheel_speed_rad_s[w][i] = speed;
                s.smooth_wheel_speed_rad_s[w][i] = speed;
            }
        }
        // What spins MR up is the torque of its circuit less its trim; the others bear what resists.
        let inertia_kg_m2 = machine.masses.wheel_kg * machine.vehicle.wheel_gyration_m.powi(2);
        let trim_nm = slip_trim_nm((spins_rad_s - 1.0) * 2.0 / 3.0);
        let second_nm = trim_nm + inertia_kg_m2 * gains_rad_s2;
        let weight_nm = machine.mass_kg() * GRAVITY_M_S2 * machine.wheels.radius_m;
        let others_nm = second_nm - slip_trim_nm((1.0 - spins_rad_s) / 3.0);
        let first_nm = (machine.wheels.rolling_resistance * weight_nm - 2.0 * others_nm) / 3.0;
        for (sides, nm) in [([0, 1], first_nm), ([2, 3], second_nm)] {
            let over_pa = nm / machine.wheels.torque_max_nm * PRESSURE_AT_TORQUE_MAX_PA;
            s.pump_pressure_pa[sides[usize::from(nm > 0.0)]].fill(over_pa.abs());
        }
        s.is_fresh_pump_pressure.fill(true);
        let errors = force_error_nm(&s, &machine, &Effects::default(), &vec![0.0; s.len]);
        errors[500].abs()
    }

    #[test]
    fn a_wheel_in_the_air_neither_pushes_nor_tells_how_the_machine_speeds_up() {
        for (spins_rad_s, gains_rad_s2) in [(1.0, 0.0), (2.5, 0.0), (2.5, 0.4)] {
            let left_nm = left_beside_one_in_the_air_nm(spins_rad_s, gains_rad_s2);
            assert!(left_nm < 30.0, "{left_nm} Nm at {spins_rad_s} rad/s, {gains_rad_s2} rad/s^2");
        }
    }

    /// Largest error of the circuits' pressures, Pa, where BR spins at twice the speed of the others and its motor
    /// has three tenths of its displacement, as its current says where `is_logged`.
    fn spinning_pa(is_logged: bool) -> f64 {
        let (machine, mut s) = (Machine::xt28(), still(10));
        let drive = Drive::new(&machine, &Effects::default());
        let mut state = drive.at_rest(DT_S);
        s.throttle.fill(0.3);
        s.motor_share = PerWheel::from_fn(|w| vec![if w == Wheel::Br { 0.3 } else { 1.0 }; s.len]);
        for i in 0..s.len {
            let goes_rad_s = 0.3 * machine.drive.speed_full_m_s / machine.wheels.radius_m;
            for w in Wheel::ALL {
                let times = if w == Wheel::Br { 2.0 } else { 1.0 };
                s.wheel_speed_rad_s[w][i] = times * goes_rad_s;
            }
            let shares = s.motor_shares(i);
            let input = DriveInput {
                pump_displacement: circuit_means(&machine, &shares).map(|mean| 0.3 * mean),
                motor_displacement: shares.map(|share| share / 3.0),
                engine_speed_rpm: machine.drive.engine_speed_rpm,
                wheel_speed_rad_s: PerWheel::from_fn(|w| s.wheel_speed_rad_s[w][i]),
            };
            let out = drive.step(&mut state, &input, DT_S);
            for side in 0..4 {
                s.pump_pressure_pa[side][i] = out.pump_pressure_pa[side];
            }
        }
        if !is_logged {
            s.motor_share = PerWheel::from_fn(|_| Samples::new());
        }
        let errors = drive_errors(&s, &machine, &Effects::default()).difference_pa;
        errors.iter().fold(0.0_f64, |most, pa| most.max(pa.abs()))
    }

    #[test]
    fn a_wheel_that_spins_on_less_displacement_is_told_by_its_motors_current() {
        let [known, unknown] = [true, false].map(spinning_pa);
        assert!(known < 0.02 * unknown, "{known} of {unknown} Pa");
    }
}
