//! The vehicle as rigid bodies: three frames and six arms with their wheels in one multibody of 14
//! freedoms, beside it the turning of each wheel.
//!
//! Reduced coordinates (multibody joints) because the soft locks carry the whole weight: impulse
//! joints give way where a lock should hold. Stiff springs are integrated implicitly by the engine.

use rapier3d::prelude::*;
use xt28_machine::{PerWheel, Wheel};

use super::hinge::{HINGE, Hinge, set_spring, signed};
use super::hull_watch::HullWatch;
use super::insert::{hub, insert_arm, insert_frames, new_world, origin_m, vector};
use super::shapes::Ground;
use super::spin::Spin;
use super::tyre_contact::{Rim, Tread, TyreContact};
use crate::bodies::{Bodies, HELD_SHARE, HingeMotion, HingeSpring, Loads, Motion, Placed};
use crate::{Parts, RollHinge, Terrain};

/// Longest step of the engine, s; longer ones are made of several (tyres were 8 cm off at 120 Hz).
const LONGEST_S: f64 = 0.005;
/// A tyre foresees how its wheel spins as if it alone turned it. What else brakes the spin, up to this share of J/dt over
/// a step of the engine (measured: from 0.55 on wheels shake at 5 ms, from 1 on at 1 ms), it bears.
const FORESEEN_SHARE: f64 = 0.5;

/// The engine's world with handles to every part of the vehicle.
pub struct RapierBodies {
    world: PhysicsWorld,
    frames: [RigidBodyHandle; 3],
    arms: PerWheel<RigidBodyHandle>,
    /// Each wheel's centre from its arm's pivot and from the arm's centre of mass, among the arm's axes.
    hubs: PerWheel<[Vector; 2]>,
    spins: PerWheel<Spin>,
    hulls: [HullWatch; 3],
    terrain: Terrain,
    /// The front frame's centre of mass, which is its body's origin, among the machine's axes.
    front_com: Vector,
    tyres: PerWheel<TyreContact>,
    ground: ColliderHandle,
    joints: [Hinge; 2],
    roll: Option<(Hinge, RollHinge)>,
    arm_hinges: PerWheel<Hinge>,
    /// Sense in which each arm extends about +y.
    extends: PerWheel<f64>,
    ground_force_n: PerWheel<f64>,
    chassis_force_n: f64,
}

impl Bodies for RapierBodies {
    fn new(parts: &Parts, terrain: &Terrain, stroke_m: PerWheel<f64>) -> Self {
        let mut world = new_world(parts);
        let ground = world.colliders.insert(
            ColliderBuilder::new(SharedShape::new(Ground(terrain.clone())))
                // The lower coefficient of a pair counts, and that is the frame's: only frames collide with
                // it, wheels have tyres of their own.
                .friction(Real::MAX)
                .collision_groups(InteractionGroups::new(
                    Group::GROUP_1,
                    Group::GROUP_2,
                    InteractionTestMode::And,
                )),
        );
        let (frames, rolled) = insert_frames(parts, &mut world);
        let arms = PerWheel::from_fn(|wheel| insert_arm(parts, &mut world, &frames, wheel));
        let hulls = core::array::from_fn(|i| HullWatch::new(&mut world, frames[i], parts, i));
        let mut bodies = Self {
            world,
            frames,
            arms,
            hubs: PerWheel::from_fn(|wheel| hub(parts, wheel)),
            spins: PerWheel::splat(Spin::new(parts.wheel.inertia_kg_m2[1])),
            hulls,
            terrain: terrain.clone(),
            front_com: vector(origin_m(parts, 0)),
            tyres: PerWheel::from_fn(|wheel| TyreContact::new(parts, wheel)),
            ground,
            joints: Default::default(),
            roll: None,
            arm_hinges: PerWheel::splat(Hinge::default()),
            extends: PerWheel::from_fn(|wheel| parts.arms[wheel].extends),
            ground_force_n: PerWheel::splat(0.0),
            chassis_force_n: 0.0,
        };
        bodies.free_root();
        bodies.index_hinges(rolled.zip(parts.roll_hinge));
        bodies.set_down(parts, terrain, stroke_m);
        bodies
    }

    fn motion(&self) -> Motion {
        let body = &self.world.bodies[self.frames[0]];
        let [velocity, rate] = self.velocities(0);
        let wide = |v: Vector| v.to_array().map(f64::from);
        Motion {
            arm: PerWheel::from_fn(|w| {
                signed(self.hinge_motion(self.arm_hinges[w]), self.extends[w])
            }),
            // The engine counts the turn of the frame behind, which goes right when the machine
            // bends left.
            joint: self.joints.map(|hinge| signed(self.hinge_motion(hinge), -1.0)),
            roll_hinge: self.roll.map_or_else(HingeMotion::default, |(hinge, _)| {
                signed(self.hinge_motion(hinge), -1.0)
            }),
            wheel_rate_rad_s: PerWheel::from_fn(|w| self.spins[w].against(self.arm_rad_s(w))),
            position_m: wide(*body.position() * -self.front_com),
            axes: [Vector::X, Vector::Y, Vector::Z].map(|axis| wide(*body.rotation() * axis)),
            velocity_m_s: wide(velocity),
            rate_rad_s: wide(rate),
            ground_force_n: self.ground_force_n,
            chassis_force_n: self.chassis_force_n,
        }
    }

    fn held_at_most_s(inertia_kg_m2: f64, slope_nms: f64) -> f64 {
        let spins_s = inertia_kg_m2 / slope_nms;
        let foreseen_s = FORESEEN_SHARE * spins_s;
        if foreseen_s < LONGEST_S { foreseen_s } else { HELD_SHARE * spins_s }
    }

    #[allow(clippy::cast_possible_truncation)]
    fn advance(&mut self, loads: &Loads, dt_s: f64) {
        let parts = (dt_s / LONGEST_S).ceil().max(1.0);
        let (mut ground_force_n, mut chassis_force_n) = (PerWheel::splat(0.0), 0.0);
        for _ in 0..parts as u32 {
            self.sub_step(loads, dt_s / parts);
            ground_force_n =
                PerWheel::from_fn(|w| ground_force_n[w] + self.ground_force_n[w] / parts);
            chassis_force_n += self.chassis_force_n / parts;
        }
        (self.ground_force_n, self.chassis_force_n) = (ground_force_n, chassis_force_n);
    }
}

impl Placed for RapierBodies {
    #[allow(clippy::cast_possible_truncation)]
    fn place(&mut self, motion: &Motion) {
        let [forward, left, up] = motion.axes.map(vector);
        let turn = Rotation::from_mat3(&Matrix::from_cols(forward, left, up)).normalize();
        let com = vector(motion.position_m) + turn * self.front_com;
        let mut velocity = vec![0.0; self.multibody().ndofs()];
        let mut move_by = velocity.clone();
        velocity[..3].copy_from_slice(&motion.velocity_m_s.map(|v| v as Real));
        velocity[3..6].copy_from_slice(&motion.rate_rad_s.map(|v| v as Real));
        let mut hinge = |hinge: Hinge, now: HingeMotion, sign: f64| {
            let to = signed(now, sign);
            move_by[hinge.dof] = to.angle_rad as Real;
            velocity[hinge.dof] = to.rate_rad_s as Real;
        };
        for (i, joint) in self.joints.into_iter().enumerate() {
            hinge(joint, motion.joint[i], -1.0);
        }
        if let Some((roll, _)) = self.roll {
            hinge(roll, motion.roll_hinge, -1.0);
        }
        for wheel in Wheel::ALL {
            hinge(self.arm_hinges[wheel], motion.arm[wheel], self.extends[wheel]);
        }
        for link in self.multibody().links().skip(1) {
            move_by[link.assembly_id()] -= link.joint().coords()[HINGE];
        }
        self.world.bodies[self.frames[0]].set_position(Pose::from_parts(com, turn), false);
        self.hulls.iter_mut().for_each(HullWatch::look_again);
        let PhysicsWorld { multibody_joints, bodies, .. } = &mut self.world;
        let multibody = multibody_of(multibody_joints, self.frames[0]);
        multibody.apply_displacements(&move_by);
        multibody.generalized_velocity_mut().copy_from_slice(&velocity);
        multibody.forward_kinematics(bodies, true);
        multibody.update_rigid_bodies(bodies, true);
        for wheel in Wheel::ALL {
            let arm_rad_s = self.arm_rad_s(wheel);
            self.spins[wheel].set_against(motion.wheel_rate_rad_s[wheel], arm_rad_s);
        }
    }
}

/// A clone goes on bit for bit like the original: what it leaves behind is the engine's scratch
/// space only.
impl Clone for RapierBodies {
    fn clone(&self) -> Self {
        let world = PhysicsWorld {
            gravity: self.world.gravity,
            integration_parameters: self.world.integration_parameters,
            islands: self.world.islands.clone(),
            broad_phase: self.world.broad_phase.clone(),
            narrow_phase: self.world.narrow_phase.clone(),
            bodies: self.world.bodies.clone(),
            colliders: self.world.colliders.clone(),
            multibody_joints: self.world.multibody_joints.clone(),
            ..PhysicsWorld::new()
        };
        Self {
            world,
            hulls: self.hulls.clone(),
            tyres: self.tyres.clone(),
            terrain: self.terrain.clone(),
            ..*self
        }
    }
}

impl RapierBodies {
    /// One step of the engine.
    #[allow(clippy::cast_possible_truncation)]
    fn sub_step(&mut self, loads: &Loads, dt_s: f64) {
        self.set_springs(loads);
        for hull in &mut self.hulls {
            hull.look(&mut self.world, &self.terrain, dt_s);
        }
        self.push_wheels(loads, dt_s);
        self.world.integration_parameters.dt = dt_s as Real;
        self.world.step();
        let pressed_n = |hull: &HullWatch| self.pressed_n(hull.collider(), dt_s);
        self.chassis_force_n = self.hulls.iter().map(pressed_n).sum();
    }

    /// How a wheel met the ground at the start of the last step, where its force comes from.
    #[must_use]
    pub fn tread(&self, wheel: Wheel) -> &Tread {
        self.tyres[wheel].tread()
    }

    fn set_springs(&mut self, loads: &Loads) {
        if let Some((hinge, law)) = self.roll {
            let spring = HingeSpring::of_roll(&law, self.hinge_motion(hinge));
            set_spring(self.multibody_mut(), hinge, &spring, 1.0);
        }
        let (joints, arms, extends) = (self.joints, self.arm_hinges, self.extends);
        let multibody = self.multibody_mut();
        for (hinge, spring) in joints.iter().zip(&loads.joint) {
            set_spring(multibody, *hinge, spring, -1.0);
        }
        for wheel in Wheel::ALL {
            set_spring(multibody, arms[wheel], &loads.arm[wheel], extends[wheel]);
        }
    }

    /// How fast an arm turns about its wheel's axle, against the world, rad/s.
    fn arm_rad_s(&self, wheel: Wheel) -> f64 {
        let [_, rate] = self.velocities(self.arm_hinges[wheel].link);
        f64::from(rate.dot(self.axle(wheel)))
    }

    /// The axle of a wheel, to the left.
    fn axle(&self, wheel: Wheel) -> Vector {
        self.world.bodies[self.arms[wheel]].rotation() * Vector::Y
    }

    /// Steps the tyres and turns the wheels; hands the arms what they have to bear of it.
    #[allow(clippy::cast_possible_truncation)]
    fn push_wheels(&mut self, loads: &Loads, dt_s: f64) {
        for wheel in Wheel::ALL {
            let axle = self.axle(wheel);
            let pose = *self.world.bodies[self.arms[wheel]].position();
            let lever = pose.rotation * self.hubs[wheel][1];
            let [com_velocity, arm_rate] = self.velocities(self.arm_hinges[wheel].link);
            let arm_rad_s = f64::from(arm_rate.dot(axle));
            let rate_rad_s = self.spins[wheel].against(arm_rad_s);
            let rim = Rim {
                centre: pose * self.hubs[wheel][0],
                axle,
                velocities: [
                    com_velocity + arm_rate.cross(lever),
                    arm_rate + axle * rate_rad_s as Real,
                ],
                rate_rad_s,
                drive_nm: loads.drive_nm[wheel],
            };
            let [on_tread, torque] =
                self.tyres[wheel].push(&rim, &self.terrain, &loads.drag[wheel], dt_s);
            self.ground_force_n[wheel] = f64::from(on_tread.z);
            let outside = &loads.on_wheel[wheel];
            let force = on_tread + vector(outside.force_n);
            let torque = torque + vector(outside.torque_nm);
            let gyroscopic = self.spins[wheel].gyroscopic_nm(axle, arm_rate);
            let turning = torque.dot(axle);
            let in_axle_nm = loads.drive_nm[wheel] + self.tyres[wheel].tread().drag_nm;
            let turning_nm = f64::from(turning) + in_axle_nm;
            let held_nm = self.spins[wheel].step(turning_nm, loads.hold_nm[wheel], arm_rad_s, dt_s);
            let from_axle = turning + (in_axle_nm + held_nm) as Real;
            let arm = &mut self.world.bodies[self.arms[wheel]];
            arm.reset_forces(false);
            arm.reset_torques(false);
            arm.add_force(force, false);
            arm.add_torque(lever.cross(force) + torque - axle * from_axle - gyroscopic, false);
        }
    }

    /// What the ground pressed on a part with over the last step of `dt_s` s, N.
    fn pressed_n(&self, collider: ColliderHandle, dt_s: f64) -> f64 {
        let Some(pair) = self.world.narrow_phase.contact_pair(self.ground, collider) else {
            return 0.0;
        };
        let points = pair.manifolds().iter().flat_map(|manifold| &manifold.points);
        points.map(|point| f64::from(point.data.impulse) / dt_s).sum()
    }

    fn hinge_motion(&self, hinge: Hinge) -> HingeMotion {
        let multibody = self.multibody();
        let angle = multibody.link(hinge.link).map_or(0.0, |link| link.joint().coords()[HINGE]);
        HingeMotion {
            angle_rad: f64::from(angle),
            rate_rad_s: f64::from(multibody.generalized_velocity()[hinge.dof]),
        }
    }

    /// Velocity of a link's centre of mass and its angular velocity, in the world.
    ///
    /// The engine brings its bodies' own velocities up to date only when the next step begins.
    fn velocities(&self, link: usize) -> [Vector; 2] {
        let multibody = self.multibody();
        let freedoms = multibody.body_jacobian(link).column_iter();
        let mut twist = [Vector::ZERO; 2];
        for (column, rate) in freedoms.zip(multibody.generalized_velocity().iter()) {
            let at = |i: usize| Vector::new(column[i], column[i + 1], column[i + 2]);
            twist = [twist[0] + at(0) * *rate, twist[1] + at(3) * *rate];
        }
        twist
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
    fn index_hinges(&mut self, rolled: Option<(RigidBodyHandle, RollHinge)>) {
        let find = |body: RigidBodyHandle| {
            let id =
                self.world.multibody_joints.rigid_body_link(body).expect("every part is linked");
            let link = self.multibody().link(id.id).expect("the link is there");
            Hinge { link: id.id, dof: link.assembly_id() }
        };
        let joints = [self.frames[1], self.frames[2]].map(find);
        let roll = rolled.map(|(body, law)| (find(body), law));
        (self.joints, self.arm_hinges, self.roll) = (joints, self.arms.map(find), roll);
    }

    /// Takes the root's freedoms from its body; clears the engine's default joint damping.
    fn free_root(&mut self) {
        let world = &mut self.world;
        let multibody = multibody_of(&mut world.multibody_joints, self.frames[0]);
        multibody.forward_kinematics(&world.bodies, true);
        multibody.damping_mut().fill(0.0);
    }

    /// Swings the arms to their strokes and sets the machine down on the ground under its wheels.
    #[allow(clippy::cast_possible_truncation)]
    fn set_down(&mut self, parts: &Parts, terrain: &Terrain, stroke_m: PerWheel<f64>) {
        let mut move_by = vec![0.0; self.multibody().ndofs()];
        for wheel in Wheel::ALL {
            let angle = self.extends[wheel] * parts.arm_angle_rad(stroke_m[wheel]);
            move_by[self.arm_hinges[wheel].dof] = angle as Real;
        }
        let stance = parts.stance(terrain, stroke_m);
        let [forward, left, up] = stance.axes.map(vector);
        let turn = Rotation::from_mat3(&Matrix::from_cols(forward, left, up)).to_scaled_axis();
        // The root's coordinates are those of its centre of mass.
        let com = origin_m(parts, 0);
        let moved = stance.world(com);
        for axis in 0..3 {
            move_by[axis] = (moved[axis] - com[axis]) as Real;
            move_by[3 + axis] = turn[axis];
        }
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
