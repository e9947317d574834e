//! The vehicle as rigid bodies: three frames, six arms and six wheels in one multibody of 20 freedoms.
//!
//! Reduced coordinates (multibody joints) because the soft locks carry the whole weight: impulse
//! joints give way where a lock should hold. Stiff springs are integrated implicitly by the engine.

use rapier3d::prelude::*;
use xt28_machine::{Machine, PerWheel, Wheel};

use crate::Terrain;
use crate::ground_contact::Ground;
use crate::rigid_parts::{
    REFERENCE_STROKE_M, arm_sign, insert_arm, insert_frames, new_world, vector,
};

/// Index of a hinge's own angle among a joint's six coordinates.
const HINGE: usize = 3;

/// The engine's world with handles to every part of the vehicle.
pub(crate) struct RigidBodies {
    pub(crate) world: PhysicsWorld,
    pub(crate) frames: [RigidBodyHandle; 3],
    pub(crate) arms: PerWheel<RigidBodyHandle>,
    pub(crate) wheels: PerWheel<RigidBodyHandle>,
    wheel_colliders: PerWheel<ColliderHandle>,
    ground: ColliderHandle,
    joints: [Hinge; 2],
    arm_hinges: PerWheel<Hinge>,
    wheel_hinges: PerWheel<Hinge>,
}

/// Where a hinge's angle is among the multibody's links and velocities.
#[derive(Clone, Copy, Debug, Default)]
struct Hinge {
    link: usize,
    dof: usize,
}

/// A spring and damper about a hinge, integrated implicitly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HingeSpring {
    pub(crate) stiffness_nm: f64,
    pub(crate) damping_nms: f64,
    pub(crate) rest_rad: f64,
}

/// Angle and rate of a hinge.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct HingeMotion {
    pub(crate) angle_rad: f64,
    pub(crate) rate_rad_s: f64,
}

impl RigidBodies {
    /// The machine on `terrain`, front axle at the origin heading east, arms at `stroke_m`.
    pub(crate) fn new(machine: &Machine, terrain: &Terrain, stroke_m: PerWheel<f64>) -> Self {
        let mut world = new_world(machine);
        let ground = world.colliders.insert(
            ColliderBuilder::new(SharedShape::new(Ground(terrain.clone())))
                .friction(machine.wheels.friction as Real)
                .collision_groups(InteractionGroups::new(
                    Group::GROUP_1,
                    Group::GROUP_2,
                    InteractionTestMode::And,
                )),
        );
        let frames = insert_frames(machine, &mut world);
        let joint_x = [machine.articulation.front_joint_x_m, machine.articulation.rear_joint_x_m];
        for (i, x) in joint_x.into_iter().enumerate() {
            let anchor = vector([x, 0.0, machine.wheels.radius_m]);
            let joint =
                RevoluteJointBuilder::new(Vector::Z).local_anchor1(anchor).local_anchor2(anchor);
            world.insert_multibody_joint(frames[i], frames[i + 1], joint);
        }
        let mut arms = PerWheel::splat(RigidBodyHandle::invalid());
        let mut wheels = arms;
        let mut wheel_colliders = PerWheel::splat(ColliderHandle::invalid());
        for wheel in Wheel::ALL {
            let frame = frames[wheel.axle() as usize];
            (arms[wheel], wheels[wheel], wheel_colliders[wheel]) =
                insert_arm(machine, &mut world, frame, wheel);
        }
        let mut bodies = Self {
            world,
            frames,
            arms,
            wheels,
            wheel_colliders,
            ground,
            joints: Default::default(),
            arm_hinges: PerWheel::splat(Hinge::default()),
            wheel_hinges: PerWheel::splat(Hinge::default()),
        };
        bodies.free_root();
        bodies.index_hinges();
        bodies.place(machine, stroke_m);
        bodies
    }

    /// Sets the spring and damper of each articulation joint and of each arm hinge for the next step.
    pub(crate) fn set_springs(&mut self, joints: [HingeSpring; 2], arms: PerWheel<HingeSpring>) {
        let joints = joints.map(|spring| HingeSpring { rest_rad: -spring.rest_rad, ..spring });
        let (joint_hinges, arm_hinges) = (self.joints, self.arm_hinges);
        let multibody = self.multibody_mut();
        let springs = joint_hinges.iter().zip(&joints).chain(arm_hinges.0.iter().zip(&arms.0));
        for (hinge, spring) in springs {
            set_spring(multibody, *hinge, spring);
        }
    }

    /// Sets the dry friction of the wheel hinges, Nm: what a parking brake holds.
    #[allow(clippy::cast_possible_truncation)]
    pub(crate) fn set_brakes(&mut self, torque_nm: f64) {
        for hinge in self.wheel_hinges.0 {
            self.multibody_mut().frictions_mut()[hinge.dof] = torque_nm as Real;
        }
    }

    /// Puts a drive torque on each wheel, with its reaction on the arm, and a drag from the ground
    /// on the wheel alone; Nm about the axle, forward > 0.
    pub(crate) fn set_wheel_torques(&mut self, drive_nm: PerWheel<f64>, drag_nm: PerWheel<f64>) {
        for wheel in Wheel::ALL {
            let axle = self.world.bodies[self.arms[wheel]].rotation() * Vector::Y;
            #[allow(clippy::cast_possible_truncation)]
            let (drive, drag) = (drive_nm[wheel] as Real, drag_nm[wheel] as Real);
            let arm = &mut self.world.bodies[self.arms[wheel]];
            arm.reset_torques(false);
            arm.add_torque(axle * -drive, false);
            let body = &mut self.world.bodies[self.wheels[wheel]];
            body.reset_torques(false);
            body.add_torque(axle * (drive + drag), false);
        }
    }

    /// Advances the world by `dt_s` s.
    #[allow(clippy::cast_possible_truncation)]
    pub(crate) fn step(&mut self, dt_s: f64) {
        self.world.integration_parameters.dt = dt_s as Real;
        self.world.step();
    }

    /// Angle and rate of each articulation joint; left > 0. The engine counts the turn of the frame
    /// behind, which goes right when the machine bends left.
    pub(crate) fn joint_motion(&self) -> [HingeMotion; 2] {
        self.joints.map(|hinge| {
            let motion = self.motion(hinge);
            HingeMotion { angle_rad: -motion.angle_rad, rate_rad_s: -motion.rate_rad_s }
        })
    }

    /// Angle and rate of each arm about +y, from its reference pose.
    pub(crate) fn arm_motion(&self) -> PerWheel<HingeMotion> {
        self.arm_hinges.map(|hinge| self.motion(hinge))
    }

    /// Rate of each wheel about its axle, against its arm.
    pub(crate) fn wheel_rate_rad_s(&self) -> PerWheel<f64> {
        self.wheel_hinges.map(|hinge| self.motion(hinge).rate_rad_s)
    }

    /// Vertical force of the ground on each wheel over the last step of `dt_s` s, N.
    pub(crate) fn ground_force_n(&self, dt_s: f64) -> PerWheel<f64> {
        self.wheel_colliders.map(|collider| {
            let Some(pair) = self.world.narrow_phase.contact_pair(self.ground, collider) else {
                return 0.0;
            };
            let up = if pair.collider1 == self.ground { 1.0 } else { -1.0 };
            let impulse: f64 = pair
                .manifolds()
                .iter()
                .flat_map(|m| m.points.iter().map(move |p| (m.data.normal.z, p.data.impulse)))
                .map(|(normal_z, impulse)| f64::from(normal_z) * up * f64::from(impulse))
                .sum();
            impulse / dt_s
        })
    }

    fn motion(&self, hinge: Hinge) -> HingeMotion {
        let multibody = self.multibody();
        let angle = multibody.link(hinge.link).map_or(0.0, |link| link.joint().coords()[HINGE]);
        HingeMotion {
            angle_rad: f64::from(angle),
            rate_rad_s: f64::from(multibody.generalized_velocity()[hinge.dof]),
        }
    }

    fn multibody(&self) -> &Multibody {
        let joints = &self.world.multibody_joints;
        joints
            .rigid_body_link(self.frames[0])
            .and_then(|link| joints.get_multibody(link.multibody))
            .expect("the vehicle is one multibody")
    }

    fn multibody_mut(&mut self) -> &mut Multibody {
        multibody_of(&mut self.world.multibody_joints, self.frames[0])
    }

    /// Looks up where each hinge sits.
    fn index_hinges(&mut self) {
        let find = |body: RigidBodyHandle| {
            let id =
                self.world.multibody_joints.rigid_body_link(body).expect("every part is linked");
            let link = self.multibody().link(id.id).expect("the link is there");
            Hinge { link: id.id, dof: link.assembly_id() }
        };
        let joints = [find(self.frames[1]), find(self.frames[2])];
        let (arms, wheels) = (self.arms.map(find), self.wheels.map(find));
        (self.joints, self.arm_hinges, self.wheel_hinges) = (joints, arms, wheels);
    }

    /// Takes the root's freedoms from its body; clears the engine's default joint damping.
    fn free_root(&mut self) {
        let world = &mut self.world;
        let multibody = multibody_of(&mut world.multibody_joints, self.frames[0]);
        multibody.forward_kinematics(&world.bodies, true);
        multibody.damping_mut().fill(0.0);
    }

    /// Swings the arms to their strokes and sets the machine down on its lowest wheels.
    #[allow(clippy::cast_possible_truncation)]
    fn place(&mut self, machine: &Machine, stroke_m: PerWheel<f64>) {
        let linkage = machine.linkage();
        let reference = linkage.at_stroke(REFERENCE_STROKE_M);
        let mut move_by = vec![0.0; self.multibody().ndofs()];
        let mut lift_m = f64::MIN;
        for wheel in Wheel::ALL {
            let pose = linkage.at_stroke(stroke_m[wheel]);
            let angle = arm_sign(machine, wheel) * (pose.angle_rad - reference.angle_rad);
            move_by[self.arm_hinges[wheel].dof] = angle as Real;
            lift_m = lift_m.max(pose.drop_m - reference.drop_m);
        }
        move_by[2] = lift_m as Real;
        let world = &mut self.world;
        let multibody = multibody_of(&mut world.multibody_joints, self.frames[0]);
        multibody.apply_displacements(&move_by);
        multibody.forward_kinematics(&world.bodies, false);
        multibody.update_rigid_bodies(&mut world.bodies, true);
    }
}

/// The multibody of a part; borrows the joints alone, so that the bodies stay free to be read.
fn multibody_of(joints: &mut MultibodyJointSet, part: RigidBodyHandle) -> &mut Multibody {
    let index = joints.rigid_body_link(part).map(|link| link.multibody);
    index.and_then(|index| joints.get_multibody_mut(index)).expect("the vehicle is one multibody")
}

#[allow(clippy::cast_possible_truncation)]
fn set_spring(multibody: &mut Multibody, hinge: Hinge, spring: &HingeSpring) {
    multibody.damping_mut()[hinge.dof] = spring.damping_nms as Real;
    if let Some(link) = multibody.link_mut(hinge.link) {
        link.joint.set_spring(HINGE, spring.stiffness_nm as Real, spring.rest_rad as Real);
    }
}
