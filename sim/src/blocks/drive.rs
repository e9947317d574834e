//! Engine and hydrostatic transmission: two circuits of three parallel motors, equal pressure in each.
//!
//! A circuit is a differential (paper 3.2): its motors share the torque by their displacement, and
//! the displacement-weighted mean of their speeds follows the pump, giving way under torque. The engine
//! holds the mean of all six without steady error, within its torque and power.
//!
//! Pressure here is a convention, the one of the logs: proportional to the circuit's torque alone, 350 bar
//! above charge at a wheel's largest. Displacement is left out of it on purpose, so a pressure tells the
//! torque whatever the motors are set to. What a motor makes at most leaves it out too: a real one at
//! a third of its displacement stalls at a third of the torque, those of the logs do not.

mod resume;

use xt28_machine::{Machine, PerWheel, Wheel};

use super::slip_trim::{GAIN_NMS, slip_trim_nm};
use crate::effects::{DelayLine, DriveEffects, Effects, Lag, StandstillDrag};

/// Time in which the engine's speed answers to load, s (assumed).
const ENGINE_ANSWER_S: f64 = 0.2;
/// Speed ratio of the sequence law: full displacement of pump and motors is a third of full speed.
const FULL_DISPLACEMENT_SHARE: f64 = 1.0 / 3.0;
/// Charge pressure of the closed circuits, Pa (assumed).
const CHARGE_PRESSURE_PA: f64 = 25.0e5;
/// Pressure above charge at the largest wheel torque, Pa (convention, see above).
const PRESSURE_AT_TORQUE_MAX_PA: f64 = 350.0e5;
/// Share of torque or power asked beyond what there is, over which the integral comes to rest (assumed): at
/// once would be a jump wherever they begin to run short.
const SHORT: f64 = 0.05;

/// Parameters of the transmission.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    circuits: [[Wheel; 3]; 2],
    speed_full_rad_s: f64,
    engine_speed_rpm: f64,
    engine_torque_max_nm: f64,
    engine_power_w: f64,
    wheel_torque_max_nm: f64,
    circuit_gain_nms: f64,
    mean_integral_nm: f64,
    effects: DriveEffects,
    standstill_drag: PerWheel<StandstillDrag>,
}

/// What the transmission remembers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DriveState {
    asked_ratio: [DelayLine; 2],
    lagging_ratio: [Lag; 2],
    /// What each circuit was to do in the last step: of a lag with a lead, not the lag's output alone.
    target_rad_s: [f64; 2],
    felt_power_w: Lag,
    power_w: f64,
    /// Integral part of the torque that holds the mean speed, Nm a wheel.
    pub mean_torque_nm: f64,
}

/// What acts on the transmission.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveInput {
    /// Displacement of pumps 1 and 2, -1 to 1.
    pub pump_displacement: [f64; 2],
    /// Displacement of each wheel motor, 0 to 1.
    pub motor_displacement: PerWheel<f64>,
    /// Speed the engine's governor holds, rpm.
    pub engine_speed_rpm: f64,
    /// Speed of each wheel about its axle, rad/s; forward > 0.
    pub wheel_speed_rad_s: PerWheel<f64>,
}

/// What the transmission does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DriveOutput {
    /// Torque on each wheel, Nm; forward > 0.
    pub wheel_torque_nm: PerWheel<f64>,
    /// Pressures 1A 1B 2A 2B, Pa; B is the forward side (facts 1.1).
    pub pump_pressure_pa: [f64; 4],
    /// Power taken from the engine, W.
    pub power_w: f64,
    /// Share of the wanted power that the engine gives, 0 to 1.
    pub power_share: f64,
    /// Speed of the engine under that load, rpm.
    pub engine_speed_rpm: f64,
    /// Torque with which each motor holds its wheel at rest, Nm.
    pub hold_nm: PerWheel<f64>,
}

impl Drive {
    /// The transmission of this machine.
    ///
    /// # Panics
    /// For circuits that no machine file can have: reading one refuses them.
    #[must_use]
    pub fn new(machine: &Machine, effects: &Effects) -> Self {
        let w = &machine.wheels;
        Self {
            circuits: machine.circuits().expect("checked when the machine was read"),
            speed_full_rad_s: machine.drive.speed_full_m_s / w.radius_m,
            engine_speed_rpm: machine.drive.engine_speed_rpm,
            engine_torque_max_nm: machine.drive.engine_torque_max_nm,
            engine_power_w: machine.drive.engine_power_w,
            wheel_torque_max_nm: w.torque_max_nm,
            circuit_gain_nms: machine.vehicle.circuit_gain_nms,
            mean_integral_nm: machine.vehicle.mean_integral_nm,
            effects: effects.drive,
            standstill_drag: PerWheel::from_fn(|wheel| effects.wheels[wheel].standstill_drag),
        }
    }

    /// How much a motor's torque falls at the most as its own and the circuit's other wheels turn faster together, or
    /// it against them, Nm a rad/s.
    pub(crate) const fn slope_max_nms(machine: &Machine) -> f64 {
        machine.vehicle.circuit_gain_nms.max(GAIN_NMS)
    }

    /// A transmission at rest, to be stepped every `dt_s` s.
    #[must_use]
    pub fn at_rest(&self, dt_s: f64) -> DriveState {
        let line = DelayLine::new(self.effects.throttle_delay.delay_s, dt_s, 0.0);
        DriveState { asked_ratio: [line.clone(), line], ..DriveState::default() }
    }

    /// Torques and pressures now; the state goes on by `dt_s` s.
    pub fn step(&self, state: &mut DriveState, input: &DriveInput, dt_s: f64) -> DriveOutput {
        let droop = &self.effects.engine_droop;
        let governed_rpm = input.engine_speed_rpm;
        let felt_w = state.felt_power_w.step(state.power_w, ENGINE_ANSWER_S, dt_s);
        let speed_share = droop.speed_share(felt_w);
        // Displacements come late; what the engine's speed changes by is in the oil at once.
        let targets = self.targets_rad_s(state, input, dt_s).map(|target| target * speed_share);
        let engine_speed_rpm = governed_rpm * speed_share;
        let input = &DriveInput { engine_speed_rpm, ..*input };
        let means = [0, 1].map(|c| self.mean_rad_s(c, input));
        let mean_error = (targets[0] + targets[1] - means[0] - means[1]) / 2.0;

        let mut out = DriveOutput { engine_speed_rpm, ..DriveOutput::default() };
        // Of what there is, the share that is asked.
        let (mut asked, mut circuit_nm) = (0.0_f64, [0.0; 2]);
        let most_nm = self.wheel_torque_max_nm;
        for c in 0..2 {
            let own_nm = self.circuit_gain_nms * (targets[c] - means[c]);
            let wanted_nm = state.mean_torque_nm + own_nm;
            circuit_nm[c] = wanted_nm.clamp(-most_nm, most_nm);
            asked = asked.max(wanted_nm.abs() / most_nm);
            self.share(c, circuit_nm[c], means[c], input, &mut out.wheel_torque_nm);
        }
        let limit = self.limit_power(input, &mut out);
        for (c, circuit_nm) in circuit_nm.into_iter().enumerate() {
            let above =
                PRESSURE_AT_TORQUE_MAX_PA * limit * circuit_nm.abs() / self.wheel_torque_max_nm;
            for &wheel in &self.circuits[c] {
                out.hold_nm[wheel] = self.standstill_drag[wheel].holds_nm(targets[c]);
            }
            let forward = usize::from(circuit_nm >= 0.0);
            out.pump_pressure_pa[2 * c + forward] = CHARGE_PRESSURE_PA + above;
            out.pump_pressure_pa[2 * c + 1 - forward] = CHARGE_PRESSURE_PA;
        }
        let winds_up = mean_error * (circuit_nm[0] + circuit_nm[1]) > 0.0;
        let short = if winds_up { asked.max(limit.recip()) - 1.0 } else { 0.0 };
        self.integrate(state, mean_error * (1.0 - short / SHORT).clamp(0.0, 1.0), dt_s);
        state.power_w = out.power_w;
        out
    }

    /// What each circuit is to do at the governor's speed, once displacement has become speed, rad/s.
    fn targets_rad_s(&self, state: &mut DriveState, input: &DriveInput, dt_s: f64) -> [f64; 2] {
        let e = &self.effects;
        state.target_rad_s = core::array::from_fn(|c| {
            let asked = self.ratio(c, input);
            let arrived = state.asked_ratio[c].step(asked, e.throttle_delay.delay_s, dt_s);
            let ratio = e.lag.follow(&mut state.lagging_ratio[c], arrived, dt_s);
            // Where nothing is late it is what is asked to the bit, which rounds in another order.
            if ratio == asked {
                self.target_rad_s(c, input)
            } else {
                self.full_rad_s(input) * ratio
            }
        });
        state.target_rad_s
    }

    /// Mean wheel speed that pump `c` asks of its circuit, rad/s (facts 4.4: linear in throttle).
    fn target_rad_s(&self, c: usize, input: &DriveInput) -> f64 {
        let (motors, full) = (self.motors(c, input), self.full_rad_s(input));
        if motors <= 0.0 { 0.0 } else { full * input.pump_displacement[c] * 3.0 / motors }
    }

    /// Displacement of pump `c` over that of its motors, as a share of what it is at full displacement of both.
    fn ratio(&self, c: usize, input: &DriveInput) -> f64 {
        let motors = self.motors(c, input);
        if motors <= 0.0 { 0.0 } else { input.pump_displacement[c] * 3.0 / motors }
    }

    /// Displacement of the motors of circuit `c` together, 0 to 3.
    fn motors(&self, c: usize, input: &DriveInput) -> f64 {
        self.circuits[c].iter().map(|&w| input.motor_displacement[w]).sum()
    }

    /// Mean wheel speed at full displacement of pump and motors, rad/s.
    fn full_rad_s(&self, input: &DriveInput) -> f64 {
        let engine = input.engine_speed_rpm / self.engine_speed_rpm;
        self.speed_full_rad_s * FULL_DISPLACEMENT_SHARE * engine
    }

    /// Displacement-weighted mean speed of circuit `c`: what the oil flow sees, rad/s.
    fn mean_rad_s(&self, c: usize, input: &DriveInput) -> f64 {
        let (mut flow, mut motors) = (0.0, 0.0);
        for &wheel in &self.circuits[c] {
            flow += input.motor_displacement[wheel] * input.wheel_speed_rad_s[wheel];
            motors += input.motor_displacement[wheel];
        }
        if motors > 0.0 { flow / motors } else { 0.0 }
    }

    /// One pressure, three motors: torque by displacement, and the trim of a wheel that runs away.
    fn share(
        &self,
        c: usize,
        circuit_nm: f64,
        mean_rad_s: f64,
        input: &DriveInput,
        torque_nm: &mut PerWheel<f64>,
    ) {
        let motors = self.motors(c, input);
        if motors <= 0.0 {
            return;
        }
        for &wheel in &self.circuits[c] {
            let off = input.wheel_speed_rad_s[wheel] - mean_rad_s;
            let share = 3.0 * input.motor_displacement[wheel] / motors;
            torque_nm[wheel] = ((circuit_nm - slip_trim_nm(off)) * share)
                .clamp(-self.wheel_torque_max_nm, self.wheel_torque_max_nm);
        }
    }

    /// Scales the torques to what the engine gives; returns the scale, 0 to 1.
    fn limit_power(&self, input: &DriveInput, out: &mut DriveOutput) -> f64 {
        let wanted_w: f64 =
            out.wheel_torque_nm.iter().map(|(w, nm)| nm * input.wheel_speed_rad_s[w]).sum();
        let shaft_rad_s = input.engine_speed_rpm * core::f64::consts::TAU / 60.0;
        let most_w = (self.engine_power_w * self.effects.engine_droop.power_factor)
            .min(self.engine_torque_max_nm * shaft_rad_s);
        let limit = if wanted_w > most_w { most_w / wanted_w } else { 1.0 };
        out.wheel_torque_nm = out.wheel_torque_nm.map(|nm| nm * limit);
        (out.power_w, out.power_share) = (wanted_w * limit, limit);
        limit
    }

    fn integrate(&self, state: &mut DriveState, mean_error: f64, dt_s: f64) {
        let max = self.wheel_torque_max_nm;
        let torque = state.mean_torque_nm + self.mean_integral_nm * mean_error * dt_s;
        state.mean_torque_nm = torque.clamp(-max, max);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{DriveLag, EngineDroop, ThrottleDelay};

    const DT_S: f64 = 0.005;

    fn nominal() -> Drive {
        Drive::new(&Machine::xt28(), &Effects::default())
    }

    fn with(drive: DriveEffects) -> Drive {
        Drive::new(&Machine::xt28(), &Effects { drive, ..Effects::default() })
    }

    fn input(pump: f64, speed_rad_s: f64) -> DriveInput {
        DriveInput {
            pump_displacement: [pump; 2],
            motor_displacement: PerWheel::splat(1.0),
            engine_speed_rpm: 1200.0,
            wheel_speed_rad_s: PerWheel::splat(speed_rad_s),
        }
    }

    #[test]
    fn full_pump_and_motor_ask_for_a_third_of_full_speed() {
        let machine = Machine::xt28();
        let third = machine.drive.speed_full_m_s / machine.wheels.radius_m / 3.0;
        let mut state = DriveState::default();
        let out = nominal().step(&mut state, &input(1.0, third), DT_S);
        assert!(out.wheel_torque_nm.0.iter().all(|nm| nm.abs() < 1e-6));
        assert!(state.mean_torque_nm.abs() < 1e-9);
    }

    #[test]
    fn the_motors_of_a_circuit_push_alike_however_fast_they_turn() {
        let mut input = input(1.0, 0.5);
        input.wheel_speed_rad_s[Wheel::Fr] = 0.6;
        input.wheel_speed_rad_s[Wheel::Bl] = 0.4;
        let out = nominal().step(&mut DriveState::default(), &input, DT_S);
        assert!((out.wheel_torque_nm[Wheel::Fr] - out.wheel_torque_nm[Wheel::Ml]).abs() < 1e-9);
        assert!((out.wheel_torque_nm[Wheel::Fr] - out.wheel_torque_nm[Wheel::Bl]).abs() < 1e-9);
    }

    #[test]
    fn neither_engine_nor_motors_are_overdrawn() {
        let machine = Machine::xt28();
        for power_factor in [1.0, 0.05] {
            let engine_droop = EngineDroop { power_factor, ..EngineDroop::default() };
            let drive = with(DriveEffects { engine_droop, ..DriveEffects::default() });
            let mut state = drive.at_rest(DT_S);
            for _ in 0..2000 {
                let out = drive.step(&mut state, &input(1.0, 0.6), DT_S);
                assert!(out.power_w <= machine.drive.engine_power_w * power_factor + 1e-6);
                for nm in out.wheel_torque_nm.0 {
                    assert!(nm.abs() <= machine.wheels.torque_max_nm);
                }
            }
        }
    }

    /// Torque asked of a wheel in each step after the pump opened, wheels held.
    fn torque_nm(drive: &Drive, steps: usize) -> Vec<f64> {
        let mut state = drive.at_rest(DT_S);
        (0..steps)
            .map(|_| drive.step(&mut state, &input(0.1, 0.0), DT_S).wheel_torque_nm[Wheel::Fr])
            .collect()
    }

    #[test]
    fn a_delay_comes_before_the_first_torque() {
        let throttle_delay = ThrottleDelay { delay_s: 0.3 };
        let late = with(DriveEffects { throttle_delay, ..DriveEffects::default() });
        let (prompt, late) = (torque_nm(&nominal(), 100), torque_nm(&late, 160));
        assert!(late[..60].iter().all(|nm| *nm == 0.0));
        assert_eq!(prompt, late[60..]);
    }

    #[test]
    fn a_lag_lets_the_speed_come_slowly() {
        let lag = DriveLag { time_constant_s: 0.4, lead_s: 0.0 };
        let drive = with(DriveEffects { lag, ..DriveEffects::default() });
        let mut state = drive.at_rest(DT_S);
        let mut after = |steps| {
            for _ in 0..steps {
                drive.step(&mut state, &input(0.1, 0.0), DT_S);
            }
            state.target_rad_s[0]
        };
        assert!((after(80) / after(2000) - 0.632).abs() < 1e-3);
    }

    #[test]
    fn droop_takes_speed_by_power() {
        let engine_droop = EngineDroop { droop_per_w: 5.0e-6, power_factor: 1.0 };
        let drive = with(DriveEffects { engine_droop, ..DriveEffects::default() });
        let mut state = drive.at_rest(DT_S);
        let mut out = DriveOutput::default();
        for _ in 0..2000 {
            out = drive.step(&mut state, &input(1.0, 0.3), DT_S);
        }
        let wanted_rpm = 1200.0 * (1.0 - 5.0e-6 * out.power_w);
        assert!(out.power_w > 5_000.0);
        assert!((out.engine_speed_rpm - wanted_rpm).abs() < 0.5, "{}", out.engine_speed_rpm);
        let mut resumed = drive.resumed(&input(1.0, 0.3), &out.wheel_torque_nm, DT_S);
        let next = drive.step(&mut resumed, &input(1.0, 0.3), DT_S);
        assert!((next.wheel_torque_nm.sum() / out.wheel_torque_nm.sum() - 1.0).abs() < 1e-6);
    }

    /// A throttle that comes late delays displacements; an engine that gives way, or whose governor is set
    /// anew, is felt at once.
    #[test]
    fn an_engine_s_speed_does_not_wait_for_the_throttle() {
        let engine_droop = EngineDroop { droop_per_w: 5.0e-6, power_factor: 1.0 };
        let loaded = |delay_s: f64, time_constant_s: f64| {
            let throttle_delay = ThrottleDelay { delay_s };
            let lag = DriveLag { time_constant_s, lead_s: 0.0 };
            let drive = with(DriveEffects { engine_droop, throttle_delay, lag });
            let mut state = drive.resumed(&input(1.0, 0.66), &PerWheel::splat(2e3), DT_S);
            let mut after = |engine_speed_rpm| {
                let input = DriveInput { engine_speed_rpm, ..input(1.0, 0.6) };
                drive.step(&mut state, &input, DT_S).wheel_torque_nm.sum()
            };
            (0..60).map(|i| after(if i < 30 { 1200.0 } else { 1300.0 })).collect::<Vec<f64>>()
        };
        for late in [loaded(0.5, 0.0), loaded(0.0, 0.5)] {
            for (late_nm, prompt_nm) in late.iter().zip(loaded(0.0, 0.0)) {
                assert!((late_nm / prompt_nm - 1.0).abs() < 1e-6, "{late_nm}, not {prompt_nm} Nm");
            }
        }
    }

    #[test]
    fn motors_hold_where_told_and_only_at_rest() {
        let mut effects = Effects::default();
        effects.wheels[Wheel::Mr].standstill_drag.torque_nm = 3000.0;
        let drive = Drive::new(&Machine::xt28(), &effects);
        let hold = |pump| drive.step(&mut drive.at_rest(DT_S), &input(pump, 0.0), DT_S).hold_nm;
        assert_eq!(hold(0.0)[Wheel::Mr], 3000.0);
        assert_eq!(hold(0.0).sum(), 3000.0);
        assert_eq!(hold(0.5).sum(), 0.0);
    }
}
