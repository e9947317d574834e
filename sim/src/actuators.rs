//! The blocks between actuation and rigid bodies, joined: motion in, loads out.

use xt28_machine::{GRAVITY_M_S2, Linkage, Machine, PerWheel, Wheel};

use crate::blocks::{
    Cylinder, CylinderInput, CylinderState, Drive, DriveInput, DriveOutput, DriveState, Steering,
    SteeringInput, SteeringState, Valve, ValveState,
};
use crate::bodies::{HingeMotion, HingeSpring, Loads, Motion};
use crate::{Actuation, Effects, REFERENCE_STROKE_M, VehicleState};

/// Below this wheel speed the rolling drag fades, rad/s: dry friction without a jump (assumed).
const DRAG_FADE_RAD_S: f64 = 0.05;
/// Torque that the parking brake holds at each wheel, Nm (assumed).
const BRAKE_TORQUE_NM: f64 = 20_000.0;

/// Arm hydraulics, steering, drive and brake with what they remember.
#[derive(Clone, Debug)]
pub(crate) struct Actuators {
    linkage: Linkage,
    reference_rad: f64,
    valves: PerWheel<Valve>,
    cylinder: Cylinder,
    steering: Steering,
    drive: Drive,
    rolling_resistance_m: PerWheel<f64>,
    valve_states: PerWheel<ValveState>,
    cylinders: PerWheel<CylinderState>,
    joints: [SteeringState; 2],
    shaft: DriveState,
}

impl Actuators {
    /// The actuators of this machine, arms at `stroke_m` near their load, stepped every `dt_s` s.
    pub(crate) fn new(
        machine: &Machine,
        effects: &Effects,
        stroke_m: PerWheel<f64>,
        dt_s: f64,
    ) -> Self {
        let cylinder = Cylinder::new(machine);
        let linkage = machine.linkage();
        let weight_n = machine.mass_kg() * GRAVITY_M_S2 / 6.0;
        let valves = effects.arms.map(Valve::new);
        let steering = Steering::new(machine, &effects.steering);
        let drive = Drive::new(machine, effects);
        Self {
            linkage,
            reference_rad: linkage.at_stroke(REFERENCE_STROKE_M).angle_rad,
            valve_states: valves.map(|valve| valve.closed(dt_s)),
            valves,
            cylinders: stroke_m
                .map(|s| cylinder.settled(s, weight_n / linkage.at_stroke(s).force_ratio)),
            cylinder,
            joints: [steering.straight(dt_s), steering.straight(dt_s)],
            steering,
            shaft: drive.at_rest(dt_s),
            drive,
            rolling_resistance_m: PerWheel::from_fn(|wheel| {
                let added = effects.wheels[wheel].rolling_resistance.added;
                (machine.wheels.rolling_resistance + added) * machine.wheels.radius_m
            }),
        }
    }

    /// Steps every block over `dt_s` s; what the drive does is noted in `state`.
    pub(crate) fn step(
        &mut self,
        actuation: &Actuation,
        motion: &Motion,
        state: &mut VehicleState,
        dt_s: f64,
    ) -> Loads {
        let arm = self.move_arms(actuation, motion, dt_s);
        let joint = self.turn_joints(actuation, motion, dt_s);
        let drive = self.drive_wheels(actuation, motion, dt_s);
        state.wheel_torque_nm = drive.wheel_torque_nm;
        state.pump_pressure_pa = drive.pump_pressure_pa;
        state.engine_speed_rpm = drive.engine_speed_rpm;
        let brake_nm = if actuation.brake_released { 0.0 } else { BRAKE_TORQUE_NM };
        Loads {
            arm,
            joint,
            drive_nm: drive.wheel_torque_nm,
            drag_nm: self.rolling_drag_nm(motion),
            hold_nm: drive.hold_nm.map(|nm| nm + brake_nm),
        }
    }

    /// Writes what the cylinders show in this motion.
    pub(crate) fn observe(&self, motion: &Motion, state: &mut VehicleState) {
        for wheel in Wheel::ALL {
            let (input, _) = self.cylinder_input(motion.arm[wheel], 0.0);
            let force_n = self.cylinder.oil_force_n(self.cylinders[wheel], &input);
            let [a, b] = self.cylinder.pressures_pa(force_n);
            state.stroke_m[wheel] = input.stroke_m;
            state.stroke_rate_m_s[wheel] = input.stroke_rate_m_s;
            state.cylinder_force_n[wheel] = force_n;
            (state.pressure_a_pa[wheel], state.pressure_b_pa[wheel]) = (a, b);
        }
    }

    /// What a cylinder sees of its arm's motion, and its lever about the arm's hinge, m.
    fn cylinder_input(&self, arm: HingeMotion, opening: f64) -> (CylinderInput, f64) {
        let angle_rad = self.reference_rad + arm.angle_rad;
        let lever_m = self.linkage.lever_m(angle_rad);
        let input = CylinderInput {
            opening,
            stroke_m: self.linkage.stroke_m(angle_rad),
            stroke_rate_m_s: arm.rate_rad_s * lever_m,
        };
        (input, lever_m)
    }

    fn move_arms(
        &mut self,
        actuation: &Actuation,
        motion: &Motion,
        dt_s: f64,
    ) -> PerWheel<HingeSpring> {
        PerWheel::from_fn(|wheel| {
            let command = actuation.arm_opening[wheel];
            let opening = self.valves[wheel].step(&mut self.valve_states[wheel], command, dt_s);
            let (input, lever_m) = self.cylinder_input(motion.arm[wheel], opening);
            let state = self.cylinder.step(self.cylinders[wheel], &input, dt_s);
            self.cylinders[wheel] = state;
            // The cylinder's law about the hinge, linearised at this angle.
            let force = self.cylinder.force(state, &input);
            HingeSpring::through(
                motion.arm[wheel],
                force.force_n * lever_m,
                force.stiffness_n_m * lever_m * lever_m,
                force.damping_n_s_m * lever_m * lever_m,
            )
        })
    }

    fn turn_joints(
        &mut self,
        actuation: &Actuation,
        motion: &Motion,
        dt_s: f64,
    ) -> [HingeSpring; 2] {
        core::array::from_fn(|i| {
            let input = SteeringInput {
                opening: actuation.steer_opening[i],
                angle_rad: motion.joint[i].angle_rad,
                rate_rad_s: motion.joint[i].rate_rad_s,
            };
            self.steering.step(&mut self.joints[i], &input, dt_s);
            HingeSpring {
                stiffness_nm: self.steering.stiffness_nm(),
                damping_nms: self.steering.damping_nms(),
                rest_rad: self.joints[i].rest_rad,
            }
        })
    }

    fn drive_wheels(&mut self, actuation: &Actuation, motion: &Motion, dt_s: f64) -> DriveOutput {
        let input = DriveInput {
            pump_displacement: actuation.pump_displacement,
            motor_displacement: actuation.motor_displacement,
            engine_speed_rpm: actuation.engine_speed_rpm,
            wheel_speed_rad_s: motion.wheel_rate_rad_s,
        };
        self.drive.step(&mut self.shaft, &input, dt_s)
    }

    fn rolling_drag_nm(&self, motion: &Motion) -> PerWheel<f64> {
        PerWheel::from_fn(|wheel| {
            let normal_n = motion.ground_force_n[wheel].max(0.0);
            let fade = (motion.wheel_rate_rad_s[wheel] / DRAG_FADE_RAD_S).tanh();
            -self.rolling_resistance_m[wheel] * normal_n * fade
        })
    }
}
