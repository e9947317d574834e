//! The blocks between actuation and rigid bodies, joined: motion in, loads out.

use xt28_machine::{GRAVITY_M_S2, Linkage, Machine, PerWheel, Wheel};

use crate::blocks::{
    Arm, ArmInput, ArmState, CylinderMotion, Drive, DriveInput, DriveOutput, DriveState,
    FlowSharing, Steering, SteeringState,
};
use crate::bodies::{HingeMotion, HingeSpring, Loads, Motion, RollingDrag};
use crate::{Actuation, Effects, Held, REFERENCE_STROKE_M, VehicleState};

/// Below this wheel speed the rolling drag fades, rad/s: dry friction without a jump (assumed).
const DRAG_FADE_RAD_S: f64 = 0.05;
/// Torque that the parking brake holds at each wheel, Nm (assumed).
const BRAKE_TORQUE_NM: f64 = 20_000.0;

/// Arm hydraulics, steering, drive and brake with what they remember.
#[derive(Clone, Debug)]
pub(crate) struct Actuators {
    linkage: Linkage,
    reference_rad: f64,
    arms: PerWheel<Arm>,
    flow: FlowSharing,
    steering: [Steering; 2],
    drive: Drive,
    rolling_resistance_m: PerWheel<f64>,
    arm_states: PerWheel<ArmState>,
    joints: [SteeringState; 2],
    shaft: DriveState,
}

/// An arm whose valve has moved, waiting for its share of the oil.
#[derive(Clone, Copy, Debug, Default)]
struct OpenArm {
    input: ArmInput,
    speed_m_s: f64,
    lever_m: f64,
}

impl Actuators {
    /// The actuators of this machine, arms at `stroke_m` near their load, stepped every `dt_s` s.
    pub(crate) fn new(
        machine: &Machine,
        effects: &Effects,
        stroke_m: PerWheel<f64>,
        dt_s: f64,
    ) -> Self {
        let linkage = machine.linkage();
        let weight_n = machine.mass_kg() * GRAVITY_M_S2 / 6.0;
        let arms = PerWheel::from_fn(|wheel| Arm::new(machine, &effects.arms[wheel]));
        let settled = |wheel: Wheel| {
            let stroke_m = stroke_m[wheel];
            let load_n = weight_n / linkage.at_stroke(stroke_m).force_ratio;
            arms[wheel].settled(stroke_m, load_n, dt_s)
        };
        let steering = Steering::both(machine, &effects.steering);
        let drive = Drive::new(machine, effects);
        Self {
            linkage,
            reference_rad: linkage.at_stroke(REFERENCE_STROKE_M).angle_rad,
            arm_states: PerWheel::from_fn(settled),
            arms,
            flow: FlowSharing::new(machine, effects.pump_flow),
            joints: steering.each_ref().map(|joint| joint.straight(dt_s)),
            steering,
            shaft: drive.at_rest(dt_s),
            drive,
            rolling_resistance_m: PerWheel::from_fn(|wheel| {
                let added = effects.wheels[wheel].rolling_resistance.added;
                (machine.wheels.rolling_resistance + added).max(0.0) * machine.wheels.radius_m
            }),
        }
    }

    /// Takes every block up where `measured` has it, its command having stood for long.
    pub(crate) fn resume(
        &mut self,
        measured: &VehicleState,
        actuation: &Actuation,
        motion: &Motion,
        dt_s: f64,
    ) {
        let actuation = &actuation.saturated();
        for wheel in Wheel::ALL {
            let (cylinder, _) = self.cylinder_motion(motion.arm[wheel]);
            let load_n = measured.cylinder_force_n[wheel];
            let command = actuation.arm_opening[wheel];
            let input = ArmInput { command, load_n, motion: cylinder };
            self.arm_states[wheel] = self.arms[wheel].resumed(&input, dt_s);
        }
        for (i, joint) in self.joints.iter_mut().enumerate() {
            *joint = self.steering[i].resumed(actuation.steer_opening[i], motion.joint[i], dt_s);
        }
        let input = drive_input(actuation, motion);
        self.shaft = self.drive.resumed(&input, &measured.wheel_torque_nm, dt_s);
    }

    /// Gives the held blocks the oil, and the drive the torque, with which they show what is measured.
    /// Spools, delays and seals stay as they are.
    pub(crate) fn hold(
        &mut self,
        measured: &VehicleState,
        actuation: &Actuation,
        motion: &Motion,
        held: Held,
    ) {
        if held.arms {
            for wheel in Wheel::ALL {
                let cylinder = CylinderMotion {
                    stroke_m: measured.stroke_m[wheel],
                    stroke_rate_m_s: measured.stroke_rate_m_s[wheel],
                };
                let load_n = measured.cylinder_force_n[wheel];
                self.arms[wheel].refill(&mut self.arm_states[wheel], load_n, &cylinder);
            }
        }
        if held.joints {
            for (i, joint) in self.joints.iter_mut().enumerate() {
                let (angle_rad, rate_rad_s) = (measured.joint_rad[i], measured.joint_rate_rad_s[i]);
                self.steering[i].refill(joint, HingeMotion { angle_rad, rate_rad_s });
            }
        }
        if held.drive {
            let input = drive_input(&actuation.saturated(), motion);
            let (speed, torque) = (&measured.wheel_speed_rad_s, &measured.wheel_torque_nm);
            self.drive.reload(&mut self.shaft, &input, speed, torque);
        }
    }

    /// The hinge of an arm whose cylinder moves so.
    pub(crate) fn arm_motion(&self, stroke_m: f64, stroke_rate_m_s: f64) -> HingeMotion {
        let at_rad = self.linkage.at_stroke(stroke_m).angle_rad;
        HingeMotion {
            angle_rad: at_rad - self.reference_rad,
            rate_rad_s: stroke_rate_m_s / self.linkage.lever_m(at_rad),
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
        let actuation = &actuation.saturated();
        let arms = self.open_arms(actuation, motion, dt_s);
        let joints_rad_s = core::array::from_fn(|i| {
            self.steering[i].open(&mut self.joints[i], actuation.steer_opening[i], dt_s)
        });
        let flow_share = self.flow_share(&arms, joints_rad_s);
        let arm = self.fill_arms(&arms, flow_share, motion, dt_s);
        let joint = self.turn_joints(joints_rad_s, flow_share, motion, dt_s);
        let drive = self.drive_wheels(actuation, motion, dt_s);
        state.wheel_torque_nm = drive.wheel_torque_nm;
        state.pump_pressure_pa = drive.pump_pressure_pa;
        state.engine_speed_rpm = drive.engine_speed_rpm;
        let brake_nm = if actuation.brake_released { 0.0 } else { BRAKE_TORQUE_NM };
        Loads {
            arm,
            joint,
            drive_nm: drive.wheel_torque_nm,
            drag: self.rolling_drag(motion),
            hold_nm: drive.hold_nm.map(|nm| nm + brake_nm),
            on_wheel: PerWheel::default(),
        }
    }

    /// Writes what the cylinders show in this motion.
    pub(crate) fn observe(&self, motion: &Motion, state: &mut VehicleState) {
        for wheel in Wheel::ALL {
            let (cylinder, _) = self.cylinder_motion(motion.arm[wheel]);
            let force_n = self.arms[wheel].oil_force_n(&self.arm_states[wheel], &cylinder);
            let [a, b] = self.arms[wheel].pressures_pa(force_n);
            state.stroke_m[wheel] = cylinder.stroke_m;
            state.stroke_rate_m_s[wheel] = cylinder.stroke_rate_m_s;
            state.cylinder_force_n[wheel] = force_n;
            (state.pressure_a_pa[wheel], state.pressure_b_pa[wheel]) = (a, b);
        }
    }

    /// How a cylinder moves with its arm, and its lever about the arm's hinge, m.
    fn cylinder_motion(&self, arm: HingeMotion) -> (CylinderMotion, f64) {
        let angle_rad = self.reference_rad + arm.angle_rad;
        let lever_m = self.linkage.lever_m(angle_rad);
        let motion = CylinderMotion {
            stroke_m: self.linkage.stroke_m(angle_rad),
            stroke_rate_m_s: arm.rate_rad_s * lever_m,
        };
        (motion, lever_m)
    }

    /// Moves the spools of the arms' valves; what then acts on the cylinders.
    fn open_arms(
        &mut self,
        actuation: &Actuation,
        motion: &Motion,
        dt_s: f64,
    ) -> PerWheel<OpenArm> {
        PerWheel::from_fn(|wheel| {
            let (cylinder, lever_m) = self.cylinder_motion(motion.arm[wheel]);
            let (arm, state) = (&self.arms[wheel], &mut self.arm_states[wheel]);
            let input = ArmInput {
                command: actuation.arm_opening[wheel],
                load_n: arm.oil_force_n(state, &cylinder),
                motion: cylinder,
            };
            OpenArm { speed_m_s: arm.open(state, &input, dt_s), input, lever_m }
        })
    }

    /// Lets each cylinder have its share of the oil; the force about its arm's hinge, linearised
    /// around this motion.
    fn fill_arms(
        &mut self,
        open: &PerWheel<OpenArm>,
        flow_share: f64,
        motion: &Motion,
        dt_s: f64,
    ) -> PerWheel<HingeSpring> {
        PerWheel::from_fn(|wheel| {
            let OpenArm { input, speed_m_s, lever_m } = &open[wheel];
            let state = &mut self.arm_states[wheel];
            let force = self.arms[wheel].fill(state, input, flow_share * speed_m_s, dt_s);
            HingeSpring::through(
                motion.arm[wheel],
                force.force_n * lever_m,
                force.stiffness_n_m * lever_m * lever_m,
                force.damping_n_s_m * lever_m * lever_m,
            )
        })
    }

    /// Share of the oil asked for that the pump delivers.
    fn flow_share(&self, arms: &PerWheel<OpenArm>, joints_rad_s: [f64; 2]) -> f64 {
        let arms_m3_s = arms.map(|arm| self.flow.cylinder_m3_s(arm.speed_m_s)).sum();
        let [front_m3_s, rear_m3_s] = joints_rad_s.map(|rate| self.flow.joint_m3_s(rate));
        self.flow.share(arms_m3_s + front_m3_s + rear_m3_s)
    }

    /// Turns both joints at their share of the rates asked for.
    fn turn_joints(
        &mut self,
        asked_rad_s: [f64; 2],
        flow_share: f64,
        motion: &Motion,
        dt_s: f64,
    ) -> [HingeSpring; 2] {
        core::array::from_fn(|i| {
            let rate_rad_s = flow_share * asked_rad_s[i];
            self.steering[i].turn(&mut self.joints[i], motion.joint[i], rate_rad_s, dt_s);
            self.steering[i].spring(&self.joints[i], motion.joint[i])
        })
    }

    fn drive_wheels(&mut self, actuation: &Actuation, motion: &Motion, dt_s: f64) -> DriveOutput {
        self.drive.step(&mut self.shaft, &drive_input(actuation, motion), dt_s)
    }

    fn rolling_drag(&self, motion: &Motion) -> PerWheel<RollingDrag> {
        PerWheel::from_fn(|wheel| {
            let load_n = motion.ground_force_n[wheel].max(0.0);
            let most_nm = self.rolling_resistance_m[wheel] * load_n;
            RollingDrag::tanh(most_nm, DRAG_FADE_RAD_S, motion.wheel_rate_rad_s[wheel])
        })
    }
}

fn drive_input(actuation: &Actuation, motion: &Motion) -> DriveInput {
    DriveInput {
        pump_displacement: actuation.pump_displacement,
        motor_displacement: actuation.motor_displacement,
        engine_speed_rpm: actuation.engine_speed_rpm,
        wheel_speed_rad_s: motion.wheel_rate_rad_s,
    }
}
