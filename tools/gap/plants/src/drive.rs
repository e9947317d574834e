//! The hydrostatic drive: an engine, two pumps, six motors.

mod circuit;
mod engine;

use std::f64::consts::TAU;

use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::Motion;

use self::circuit::Circuit;
use self::engine::Engine;
use crate::history::History;
use crate::truth::DriveTruth;

/// Speed asked for below which idle motors hold, rad/s (assumed).
const IDLE_RAD_S: f64 = 0.02;
/// Time in which the oil of idle motors comes to rest, s (assumed).
const IDLE_S: f64 = 0.15;
/// Below this wheel speed rolling drag and a binding bearing fade, rad/s (assumed).
const FADE_RAD_S: f64 = 0.04;

/// What the drive remembers.
#[derive(Clone, Debug)]
pub(crate) struct Drive {
    demands: [History; 2],
    swash_rad_s: [f64; 2],
    /// What the pumps' regulator adds so that the mean of all six wheels is held, rad/s.
    regulated_rad_s: f64,
    circuits: [Circuit; 2],
    engine: Engine,
    wheels: [[Wheel; 3]; 2],
    idle: f64,
    turn_rad: PerWheel<f64>,
}

/// What the DMS asks of the drive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct DriveDemand {
    /// Mean wheel speed of either circuit by the throttle, rad/s at nominal engine speed.
    pub(crate) speed_rad_s: [f64; 2],
    /// Torque trimmed off single wheels, Nm.
    pub(crate) trim_nm: PerWheel<f64>,
}

/// What the drive does to the wheels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct WheelTorques {
    pub(crate) drive_nm: PerWheel<f64>,
    pub(crate) drag_nm: PerWheel<f64>,
    pub(crate) hold_nm: PerWheel<f64>,
}

impl Drive {
    /// At rest, stepped every `dt_s` s.
    ///
    /// # Panics
    /// For circuits that no machine file can have.
    pub(crate) fn at_rest(machine: &Machine, dt_s: f64) -> Self {
        Self {
            demands: [(); 2].map(|()| History::new(dt_s, 0.0)),
            swash_rad_s: [0.0; 2],
            regulated_rad_s: 0.0,
            circuits: [Circuit::default(); 2],
            engine: Engine::idle(machine),
            wheels: machine.circuits().expect("checked when the machine was read"),
            idle: 1.0,
            turn_rad: PerWheel::splat(0.0),
        }
    }

    /// Goes on by `dt_s` s; `rolling` is each wheel's drag torque over normal force and radius.
    pub(crate) fn step(
        &mut self,
        truth: &DriveTruth,
        machine: &Machine,
        rolling: &PerWheel<f64>,
        demand: &DriveDemand,
        motion: &Motion,
        dt_s: f64,
    ) -> WheelTorques {
        let governed = self.engine.speed_rpm() / machine.drive.engine_speed_rpm;
        let speed = &motion.wheel_rate_rad_s;
        let mut torques = WheelTorques::default();
        let mut short_rad_s = 0.0;
        for c in 0..2 {
            self.demands[c].note(demand.speed_rad_s[c]);
            let asked = self.demands[c].back(truth.delay_s);
            let keep = (-dt_s / truth.swash_s.max(1e-9)).exp();
            self.swash_rad_s[c] = asked + keep * (self.swash_rad_s[c] - asked);
            let mean = self.wheels[c].iter().map(|&w| speed[w]).sum::<f64>() / 3.0;
            let pumped = self.swash_rad_s[c] * governed;
            short_rad_s += 0.5 * (pumped - mean);
            let over = pumped + self.regulated_rad_s - mean;
            let nm = self.circuits[c].step(truth, machine, over, dt_s);
            for &wheel in &self.wheels[c] {
                let most = machine.wheels.torque_max_nm;
                torques.drive_nm[wheel] = (nm - demand.trim_nm[wheel]).clamp(-most, most);
            }
        }
        let wanted_w = self.hold_back(truth, &mut torques, speed);
        let full = wanted_w > truth.power_w || self.circuits.iter().any(Circuit::is_relieved);
        if !(full && short_rad_s * self.regulated_rad_s > 0.0) {
            let per_s = machine.vehicle.mean_integral_nm / machine.vehicle.circuit_gain_nms;
            self.regulated_rad_s += per_s * short_rad_s * dt_s;
        }
        self.engine.step(truth, machine, wanted_w.min(truth.power_w), dt_s);
        self.idle(truth, demand, &mut torques, dt_s);
        self.drag(truth, machine, rolling, motion, &mut torques, dt_s);
        torques
    }

    /// Swings the pumps back until the engine can turn them; the power wanted before, W.
    fn hold_back(
        &mut self,
        truth: &DriveTruth,
        torques: &mut WheelTorques,
        speed: &PerWheel<f64>,
    ) -> f64 {
        let wanted_w: f64 = torques.drive_nm.iter().map(|(w, nm)| nm * speed[w]).sum();
        if wanted_w > truth.power_w {
            let share = truth.power_w / wanted_w;
            torques.drive_nm = torques.drive_nm.map(|nm| nm * share);
            for circuit in &mut self.circuits {
                circuit.ease(share);
            }
        }
        wanted_w
    }

    /// Motors that nothing is asked of hold their wheels once their oil is at rest.
    fn idle(
        &mut self,
        truth: &DriveTruth,
        demand: &DriveDemand,
        torques: &mut WheelTorques,
        dt_s: f64,
    ) {
        let still = demand.speed_rad_s.iter().all(|asked| asked.abs() < IDLE_RAD_S);
        let goal = if still { 1.0 } else { 0.0 };
        self.idle = goal + (self.idle - goal) * (-dt_s / IDLE_S).exp();
        torques.hold_nm = truth.idle_hold_nm.map(|nm| nm * self.idle);
    }

    fn drag(
        &mut self,
        truth: &DriveTruth,
        machine: &Machine,
        rolling: &PerWheel<f64>,
        motion: &Motion,
        torques: &mut WheelTorques,
        dt_s: f64,
    ) {
        for wheel in Wheel::ALL {
            let speed = motion.wheel_rate_rad_s[wheel];
            let turn = &mut self.turn_rad[wheel];
            *turn = (*turn + speed * dt_s).rem_euclid(TAU);
            // Bites over a quarter of a turn.
            let bite = turn.cos().max(0.0).powi(4);
            let normal_n = motion.ground_force_n[wheel].max(0.0);
            let dry = rolling[wheel] * normal_n * machine.wheels.radius_m
                + truth.binding_nm[wheel] * bite;
            torques.drag_nm[wheel] = -dry * speed / speed.hypot(FADE_RAD_S);
        }
    }

    /// Pressures 1A 1B 2A 2B, Pa.
    pub(crate) fn pressures_pa(&self) -> [f64; 4] {
        let [first, second] = self.circuits.map(|circuit| circuit.sides_pa());
        [first[0], first[1], second[0], second[1]]
    }

    /// Speed of the engine, rpm.
    pub(crate) fn engine_rpm(&self) -> f64 {
        self.engine.speed_rpm()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::Truth;

    const DT_S: f64 = 0.002;

    fn after(
        change: impl Fn(&mut DriveTruth),
        demand: f64,
        motion: &Motion,
        steps: usize,
    ) -> WheelTorques {
        let mut truth = Truth::nominal();
        change(&mut truth.drive);
        let rolling = PerWheel::splat(0.02);
        let demand = DriveDemand { speed_rad_s: [demand; 2], ..DriveDemand::default() };
        let mut drive = Drive::at_rest(&truth.machine, DT_S);
        let mut step = || drive.step(&truth.drive, &truth.machine, &rolling, &demand, motion, DT_S);
        (0..steps).map(|_| step()).last().unwrap()
    }

    #[test]
    fn a_circuit_pushes_ten_kilonewton_metres_for_a_radian_a_second() {
        // Wheels that turn slower than asked: the regulator adds 14.5 times the shortfall a second.
        let out = after(|_| (), 0.02, &Motion::default(), 100);
        let wanted = 200.0 + 145e3 * 0.02 * (0.2 - 0.012);
        assert!(out.drive_nm.0.iter().all(|nm| (nm / wanted - 1.0).abs() < 0.01), "{out:?}");
        let early = after(|_| (), 0.02, &Motion::default(), 6);
        assert!((early.drive_nm[Wheel::Fr] / 200.0 - 0.632).abs() < 0.1);
    }

    #[test]
    fn delay_and_a_slow_swash_plate_come_before_the_pressure() {
        let late = after(|d| d.delay_s = 0.3, 0.2, &Motion::default(), 149);
        assert_eq!(late.drive_nm[Wheel::Fr], 0.0);
        let [slow, quick] = [0.5, 0.0].map(|swash_s| {
            after(|d| d.swash_s = swash_s, 0.02, &Motion::default(), 50).drive_nm[Wheel::Fr]
        });
        assert!(slow < 0.2 * quick, "{slow} {quick}");
    }

    #[test]
    fn a_weak_engine_gives_no_more_than_it_has() {
        let motion = Motion { wheel_rate_rad_s: PerWheel::splat(1.0), ..Motion::default() };
        let weak = after(|d| d.power_w = 6e3, 1.5, &motion, 500);
        assert!((weak.drive_nm.sum() - 6e3).abs() < 60.0, "{weak:?}");
    }

    #[test]
    fn idle_motors_hold_and_driven_ones_do_not() {
        let hold = |d: &mut DriveTruth| d.idle_hold_nm[Wheel::Mr] = 3e3;
        assert!(after(hold, 0.0, &Motion::default(), 500).hold_nm[Wheel::Mr] > 2999.0);
        assert!(after(hold, 0.5, &Motion::default(), 500).hold_nm[Wheel::Mr] < 10.0);
    }

    #[test]
    fn rolling_drags_and_a_bad_bearing_bites_once_a_turn() {
        let motion = Motion {
            wheel_rate_rad_s: PerWheel::splat(1.0),
            ground_force_n: PerWheel::splat(30e3),
            ..Motion::default()
        };
        let plain = after(|_| (), 1.0, &motion, 10).drag_nm[Wheel::Fl];
        assert!((plain + 0.02 * 30e3 * 0.74).abs() < 1.0, "{plain}");
        let bad = |d: &mut DriveTruth| d.binding_nm[Wheel::Fl] = 4e3;
        let bite = |steps| after(bad, 1.0, &motion, steps).drag_nm[Wheel::Fl] - plain;
        assert!(bite(10) < -3.9e3 && bite(1570).abs() < 1.0);
    }
}
