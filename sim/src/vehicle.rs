//! The whole vehicle: the blocks joined to the rigid bodies, advanced in fixed steps.

use core::time::Duration;

use xt28_machine::{GRAVITY_M_S2, Machine, PerWheel, Wheel};

use crate::rigid_bodies::{HingeMotion, HingeSpring, RigidBodies};
use crate::rigid_parts::{REFERENCE_STROKE_M, arm_sign, vector};
use crate::{
    Actuation, Cylinder, CylinderInput, CylinderState, Drive, DriveInput, DriveState, Steering,
    SteeringInput, SteeringState, Terrain, VehicleState,
};

/// Time a vehicle advances in one step.
pub const STEP: Duration = Duration::from_millis(5);
/// Below this wheel speed the rolling drag fades, rad/s: dry friction without a jump (assumed).
const DRAG_FADE_RAD_S: f64 = 0.05;
/// Torque that the parking brake holds at each wheel, Nm (assumed).
const BRAKE_TORQUE_NM: f64 = 20_000.0;

/// Anything that can stand behind the ECUs: takes what their output stages do, shows what their
/// sensors feel.
pub trait Plant {
    /// Advances by [`STEP`] under constant actuation.
    fn step(&mut self, actuation: &Actuation);

    /// The state after the last step.
    fn state(&self) -> &VehicleState;
}

/// The reference plant on rapier3d.
pub struct Vehicle {
    machine: Machine,
    bodies: RigidBodies,
    cylinder: Cylinder,
    steering: Steering,
    drive: Drive,
    memory: Memory,
    state: VehicleState,
}

/// What the blocks remember between steps.
#[derive(Clone, Copy, Debug)]
struct Memory {
    cylinders: PerWheel<CylinderState>,
    joints: [SteeringState; 2],
    drive: DriveState,
    front_velocity_m_s: [f64; 3],
    brake_released: bool,
}

impl Vehicle {
    /// The machine on `terrain`, front axle at the origin heading east, arms at `stroke_m`.
    ///
    /// The arms start near their load, so the machine settles within about a second.
    #[must_use]
    pub fn new(machine: &Machine, terrain: &Terrain, stroke_m: PerWheel<f64>) -> Self {
        let cylinder = Cylinder::new(machine);
        let linkage = machine.linkage();
        let weight_n = machine.mass_kg() * GRAVITY_M_S2 / 6.0;
        let cylinders =
            stroke_m.map(|s| cylinder.settled(s, weight_n / linkage.at_stroke(s).force_ratio));
        let mut vehicle = Self {
            bodies: RigidBodies::new(machine, terrain, stroke_m),
            cylinder,
            steering: Steering::new(machine),
            drive: Drive::new(machine),
            memory: Memory {
                cylinders,
                joints: [SteeringState::default(); 2],
                drive: DriveState::default(),
                front_velocity_m_s: [0.0; 3],
                brake_released: true,
            },
            state: VehicleState::default(),
            machine: machine.clone(),
        };
        vehicle.observe(STEP.as_secs_f64());
        vehicle
    }

    fn move_arms(&mut self, actuation: &Actuation, dt_s: f64) -> PerWheel<HingeSpring> {
        let linkage = self.machine.linkage();
        let reference_rad = linkage.at_stroke(REFERENCE_STROKE_M).angle_rad;
        let motion = self.bodies.arm_motion();
        PerWheel::from_fn(|wheel| {
            let sign = arm_sign(&self.machine, wheel);
            let angle_rad = reference_rad + sign * motion[wheel].angle_rad;
            let lever_m = linkage.lever_m(angle_rad);
            let input = CylinderInput {
                opening: actuation.arm_opening[wheel],
                stroke_m: linkage.stroke_m(angle_rad),
                stroke_rate_m_s: sign * motion[wheel].rate_rad_s * lever_m,
            };
            let state = self.cylinder.step(self.memory.cylinders[wheel], &input, dt_s);
            self.memory.cylinders[wheel] = state;
            let still = CylinderInput { stroke_rate_m_s: 0.0, ..input };
            let force = self.cylinder.force(state, &still);
            // The cylinder's law about the hinge, linearised at this angle.
            let stiffness_nm = force.stiffness_n_m * lever_m * lever_m;
            HingeSpring {
                stiffness_nm,
                damping_nms: force.damping_n_s_m * lever_m * lever_m,
                rest_rad: motion[wheel].angle_rad + sign * force.force_n * lever_m / stiffness_nm,
            }
        })
    }

    fn turn_joints(&mut self, actuation: &Actuation, dt_s: f64) -> [HingeSpring; 2] {
        let motion = self.bodies.joint_motion();
        core::array::from_fn(|i| {
            let input = SteeringInput {
                opening: actuation.steer_opening[i],
                angle_rad: motion[i].angle_rad,
                rate_rad_s: motion[i].rate_rad_s,
            };
            self.memory.joints[i] = self.steering.step(self.memory.joints[i], &input, dt_s);
            HingeSpring {
                stiffness_nm: self.steering.stiffness_nm(),
                damping_nms: self.steering.damping_nms(),
                rest_rad: self.memory.joints[i].rest_rad,
            }
        })
    }

    fn drive_wheels(&mut self, actuation: &Actuation, dt_s: f64) {
        let speeds = self.bodies.wheel_rate_rad_s();
        let input = DriveInput {
            pump_displacement: actuation.pump_displacement,
            motor_displacement: actuation.motor_displacement,
            engine_speed_rpm: actuation.engine_speed_rpm,
            wheel_speed_rad_s: speeds,
        };
        let (state, out) = self.drive.step(self.memory.drive, &input, dt_s);
        self.memory.drive = state;
        let w = &self.machine.wheels;
        let drag_nm = PerWheel::from_fn(|wheel| {
            let normal_n = self.state.ground_force_n[wheel].max(0.0);
            -w.rolling_resistance * normal_n * w.radius_m * (speeds[wheel] / DRAG_FADE_RAD_S).tanh()
        });
        self.bodies.set_wheel_torques(out.wheel_torque_nm, drag_nm);
        self.state.wheel_torque_nm = out.wheel_torque_nm;
        self.state.pump_pressure_pa = out.pump_pressure_pa;
        self.state.engine_speed_rpm = actuation.engine_speed_rpm;
        if self.memory.brake_released != actuation.brake_released {
            self.memory.brake_released = actuation.brake_released;
            let torque_nm = if actuation.brake_released { 0.0 } else { BRAKE_TORQUE_NM };
            self.bodies.set_brakes(torque_nm);
        }
    }

    fn observe(&mut self, dt_s: f64) {
        self.observe_arms();
        let joints = self.bodies.joint_motion();
        self.state.joint_rad = joints.map(|m| m.angle_rad);
        self.state.joint_rate_rad_s = joints.map(|m| m.rate_rad_s);
        self.state.wheel_speed_rad_s = self.bodies.wheel_rate_rad_s();
        self.state.ground_force_n = self.bodies.ground_force_n(dt_s);
        self.observe_front_frame(dt_s);
    }

    fn observe_arms(&mut self) {
        let linkage = self.machine.linkage();
        let reference_rad = linkage.at_stroke(REFERENCE_STROKE_M).angle_rad;
        let motion = self.bodies.arm_motion();
        for wheel in Wheel::ALL {
            let sign = arm_sign(&self.machine, wheel);
            let HingeMotion { angle_rad, rate_rad_s } = motion[wheel];
            let angle_rad = reference_rad + sign * angle_rad;
            let input = CylinderInput {
                opening: 0.0,
                stroke_m: linkage.stroke_m(angle_rad),
                stroke_rate_m_s: sign * rate_rad_s * linkage.lever_m(angle_rad),
            };
            let force_n = self.cylinder.oil_force_n(self.memory.cylinders[wheel], &input);
            let [a, b] = self.cylinder.pressures_pa(force_n);
            let s = &mut self.state;
            s.stroke_m[wheel] = input.stroke_m;
            s.stroke_rate_m_s[wheel] = input.stroke_rate_m_s;
            s.cylinder_force_n[wheel] = force_n;
            (s.pressure_a_pa[wheel], s.pressure_b_pa[wheel]) = (a, b);
        }
    }

    fn observe_front_frame(&mut self, dt_s: f64) {
        let body = &self.bodies.world.bodies[self.bodies.frames[0]];
        let turn = *body.rotation();
        let into_frame = |v: rapier3d::math::Vector| (turn.inverse() * v).to_array().map(f64::from);
        let (x, y, z) = (
            turn * rapier3d::math::Vector::X,
            turn * rapier3d::math::Vector::Y,
            turn * rapier3d::math::Vector::Z,
        );
        let s = &mut self.state;
        s.position_m = body.translation().to_array().map(f64::from);
        s.yaw_rad = f64::from(x.y).atan2(f64::from(x.x));
        s.pitch_rad = f64::from(x.z).asin();
        s.roll_rad = -f64::from(y.z).atan2(f64::from(z.z));
        s.front_rate_rad_s = into_frame(body.angvel());
        let velocity = body.linvel();
        let before = vector(self.memory.front_velocity_m_s);
        #[allow(clippy::cast_possible_truncation)]
        let acceleration = (velocity - before) / dt_s as f32;
        let gravity = self.bodies.world.gravity;
        s.front_specific_force_m_s2 = into_frame(acceleration - gravity);
        self.memory.front_velocity_m_s = velocity.to_array().map(f64::from);
        let antenna = body.position() * vector(self.machine.sensors.gnss_antenna_m);
        s.antenna_position_m = antenna.to_array().map(f64::from);
        s.antenna_velocity_m_s = body.velocity_at_point(antenna).to_array().map(f64::from);
    }
}

impl Plant for Vehicle {
    fn step(&mut self, actuation: &Actuation) {
        let dt_s = STEP.as_secs_f64();
        let arms = self.move_arms(actuation, dt_s);
        let joints = self.turn_joints(actuation, dt_s);
        self.bodies.set_springs(joints, arms);
        self.drive_wheels(actuation, dt_s);
        self.bodies.step(dt_s);
        self.observe(dt_s);
    }

    fn state(&self) -> &VehicleState {
        &self.state
    }
}
