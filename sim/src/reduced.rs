//! The fast core: a solver of exactly this vehicle in its 20 freedoms, behind the same trait.
//!
//! One step is: where everything is ([`pose`]), what its motion and weight ask ([`bias`]), where it
//! touches ([`ground`]), then the velocities at the step's end at which all impulses balance
//! ([`newton`]), with springs, tyres, friction and brakes taken implicitly. Positions follow from
//! those velocities (semi-implicit Euler, first order). `f64`, nothing allocated in a step, and
//! solved to rounding: what comes out is as smooth in every parameter as the laws that go in.

#[cfg(test)]
mod alone;
mod axle;
mod bias;
mod contact;
mod factor;
mod ground;
#[cfg(test)]
mod left_over;
mod newton;
mod patch;
mod pose;
mod spatial;
#[cfg(test)]
mod tests;
mod touch;
mod tree;

use glam::{DMat3, DQuat, DVec3};
use xt28_machine::{PerWheel, Wheel};

use self::axle::Axle;
use self::contact::{Body, Contact, Hold};
use self::factor::Factors;
use self::newton::{Balance, Convergence};
use self::pose::{ARMS, FREEDOMS, Inertias, JOINTS, Pose, ROLL, State, WHEELS};
use self::spatial::{angular, linear};
use self::touch::{CONTACTS_MAX, Search, patches};
use self::tree::Tree;
use crate::bodies::{Bodies, HELD_SHARE, HingeMotion, HingeSpring, Loads, Motion, Placed};
use crate::{Parts, Terrain};

/// The vehicle's bodies in reduced coordinates. A clone is a snapshot.
#[derive(Debug)]
pub struct ReducedBodies {
    tree: Tree,
    search: Search,
    state: State,
    /// These three are of the last step and only here so that none is made anew.
    contacts: Vec<Contact>,
    inertias: Inertias,
    factors: Factors,
    ground_force_n: PerWheel<f64>,
    chassis_force_n: f64,
    convergence: Convergence,
}

impl Bodies for ReducedBodies {
    fn new(parts: &Parts, terrain: &Terrain, stroke_m: PerWheel<f64>) -> Self {
        let tree = Tree::new(parts);
        let stance = parts.stance(terrain, stroke_m);
        let [x, y, z] = stance.axes.map(DVec3::from);
        let state = State {
            position: stance.position_m.into(),
            turn: DQuat::from_mat3(&DMat3::from_cols(x, y, z)).normalize(),
            joint_rad: [0.0; 2],
            roll_rad: 0.0,
            bristle_m: [[0.0; 2]; 6],
            arm_rad: stroke_m.map(|stroke_m| parts.arm_angle_rad(stroke_m)).0,
            rate: [0.0; FREEDOMS],
        };
        Self {
            tree,
            search: Search::new(terrain.clone()),
            state,
            contacts: Vec::with_capacity(CONTACTS_MAX),
            inertias: Inertias::default(),
            factors: Factors::new(),
            ground_force_n: PerWheel::splat(0.0),
            chassis_force_n: 0.0,
            convergence: Convergence::default(),
        }
    }

    fn motion(&self) -> Motion {
        let s = &self.state;
        let hinge = |angle_rad: f64, k: usize| HingeMotion { angle_rad, rate_rad_s: s.rate[k] };
        let twist = s.twist();
        let com = s.turn * self.tree.frames[0].com;
        Motion {
            arm: PerWheel(core::array::from_fn(|i| hinge(s.arm_rad[i], ARMS + i))),
            joint: core::array::from_fn(|i| hinge(s.joint_rad[i], JOINTS + i)),
            roll_hinge: HingeMotion { angle_rad: -s.roll_rad, rate_rad_s: -s.rate[ROLL] },
            wheel_rate_rad_s: PerWheel(core::array::from_fn(|i| s.rate[WHEELS + i])),
            position_m: s.position.to_array(),
            axes: DVec3::AXES.map(|axis| (s.turn * axis).to_array()),
            velocity_m_s: spatial::velocity_at(&twist, com).to_array(),
            rate_rad_s: angular(&twist).to_array(),
            ground_force_n: self.ground_force_n,
            chassis_force_n: self.chassis_force_n,
        }
    }

    fn held_at_most_s(inertia_kg_m2: f64, slope_nms: f64) -> f64 {
        HELD_SHARE * inertia_kg_m2 / slope_nms
    }

    fn advance(&mut self, loads: &Loads, dt_s: f64) {
        let pose = Pose::new(&self.tree, &self.state);
        self.inertias.renew(&self.tree, &pose);
        let mut contacts = core::mem::take(&mut self.contacts);
        let patches = patches(&self.tree, (&pose, &self.state), dt_s);
        self.search.contacts((&self.tree, &pose, &self.state), &patches, dt_s, &mut contacts);
        let mut balance = balance((&self.tree, &self.state), (&pose, &self.inertias), loads, dt_s);
        let mut rate = self.state.rate;
        self.convergence = balance.solve(&mut rate, &mut contacts, &mut self.factors);
        self.state.rate = rate;
        for (i, patch) in patches.iter().enumerate() {
            let own = contacts.iter().filter(|contact| contact.body == Body::Wheel(i));
            self.state.bristle_m[i] = patch.end_m(own);
        }
        self.state.advance(dt_s);
        self.note_forces(&contacts, dt_s);
        self.contacts = contacts;
    }
}

impl Placed for ReducedBodies {
    fn place(&mut self, motion: &Motion) {
        let [x, y, z] = motion.axes.map(DVec3::from);
        let s = &mut self.state;
        s.position = motion.position_m.into();
        s.turn = DQuat::from_mat3(&DMat3::from_cols(x, y, z)).normalize();
        s.joint_rad = motion.joint.map(|joint| joint.angle_rad);
        // Of a machine without the hinge, whatever is said of it: the tree has no freedom there.
        let roll =
            if self.tree.roll.is_some() { motion.roll_hinge } else { HingeMotion::default() };
        s.roll_rad = -roll.angle_rad;
        s.arm_rad = motion.arm.map(|arm| arm.angle_rad).0;
        let turning = DVec3::from(motion.rate_rad_s);
        let com = s.turn * self.tree.frames[0].com;
        // The twist is about the origin, the motion's velocity that of the centre of mass.
        let moving = DVec3::from(motion.velocity_m_s) - turning.cross(com);
        s.rate = [0.0; FREEDOMS];
        s.rate[..6].copy_from_slice(&spatial::join(turning, moving));
        s.rate[ROLL] = -roll.rate_rad_s;
        for i in 0..2 {
            s.rate[JOINTS + i] = motion.joint[i].rate_rad_s;
        }
        for i in 0..6 {
            s.rate[ARMS + i] = motion.arm.0[i].rate_rad_s;
            s.rate[WHEELS + i] = motion.wheel_rate_rad_s.0[i];
        }
        self.search.look_again();
    }
}

/// Keeps the room for contacts, which a derived clone would cut to their number.
impl Clone for ReducedBodies {
    fn clone(&self) -> Self {
        let mut contacts = Vec::with_capacity(CONTACTS_MAX);
        contacts.extend_from_slice(&self.contacts);
        Self {
            tree: self.tree.clone(),
            search: self.search.clone(),
            state: self.state.clone(),
            contacts,
            inertias: self.inertias.clone(),
            factors: self.factors.clone(),
            ..*self
        }
    }
}

impl ReducedBodies {
    fn note_forces(&mut self, contacts: &[Contact], dt_s: f64) {
        self.ground_force_n = PerWheel::splat(0.0);
        self.chassis_force_n = 0.0;
        let mut slid = [false; 6];
        self.search.stuck = [false; 6];
        for contact in contacts {
            match contact.body {
                Body::Wheel(i) => {
                    self.ground_force_n[Wheel::ALL[i]] += contact.impulse().z / dt_s;
                    match contact.now.hold {
                        Hold::Open => (),
                        Hold::Sticks => self.search.stuck[i] = true,
                        Hold::Slides => slid[i] = true,
                    }
                }
                Body::Frame(_) => self.chassis_force_n += contact.now.impulse[0] / dt_s,
            }
        }
        for (stuck, slid) in self.search.stuck.iter_mut().zip(slid) {
            *stuck &= !slid;
        }
    }
}

/// What the step's velocities have to balance, but for contacts and brakes.
fn balance<'a>(
    (tree, s): (&Tree, &State),
    (pose, inertias): (&'a Pose, &'a Inertias),
    loads: &Loads,
    dt_s: f64,
) -> Balance<'a> {
    let about_com = &inertias.about_com;
    let mut lack = bias::bias(tree, pose, about_com, &s.rate, tree.gravity);
    let mut hinge = [0.0; FREEDOMS];
    let mut spring = |k: usize, spring: &HingeSpring, angle_rad: f64| {
        let HingeSpring { stiffness_nm, damping_nms, rest_rad } = *spring;
        let ahead_rad = angle_rad + dt_s * s.rate[k];
        lack[k] += stiffness_nm * (ahead_rad - rest_rad) + damping_nms * s.rate[k];
        hinge[k] = dt_s * (damping_nms + dt_s * stiffness_nm);
    };
    for i in 0..2 {
        spring(JOINTS + i, &loads.joint[i], s.joint_rad[i]);
    }
    for i in 0..6 {
        spring(ARMS + i, &loads.arm.0[i], s.arm_rad[i]);
    }
    if let Some(roll) = &tree.roll {
        let motion = HingeMotion { angle_rad: s.roll_rad, rate_rad_s: s.rate[ROLL] };
        spring(ROLL, &HingeSpring::of_roll(roll, motion), s.roll_rad);
    }
    let mut on_wheel = [spatial::ZERO; 6];
    for i in 0..6 {
        lack[WHEELS + i] -= loads.drive_nm.0[i] + loads.drag.0[i].torque_nm;
        let (arm, outside) = (&pose.arm[i], &loads.on_wheel.0[i]);
        let force = DVec3::from(outside.force_n);
        let torque = DVec3::from(outside.torque_nm) + arm.wheel.cross(force);
        on_wheel[i] = spatial::join(torque, force);
    }
    let from_ground = newton::generalised(pose, &on_wheel, [spatial::ZERO; 3]);
    for (lack, from_ground) in lack.iter_mut().zip(&from_ground) {
        *lack = (*lack - from_ground) * dt_s;
    }
    let axle = |i: usize| Axle::new(&loads.drag.0[i], loads.hold_nm.0[i], s.rate[WHEELS + i], dt_s);
    Balance {
        pose,
        inertias: &inertias.spatial,
        lack,
        hinge,
        axles: core::array::from_fn(axle),
        mass_kg: tree.mass_kg,
    }
}

impl State {
    /// The front frame's twist about its origin.
    fn twist(&self) -> spatial::Spatial {
        core::array::from_fn(|k| self.rate[k])
    }

    /// Moves every coordinate by its velocity over `dt_s` s.
    ///
    /// The front frame keeps its twist in its own axes meanwhile, so its velocity turns with it.
    fn advance(&mut self, dt_s: f64) {
        let twist = self.twist();
        let (turning, moving) = (angular(&twist), linear(&twist));
        // Cayley's map: the turn of a step to third order in its angle, without trigonometry.
        let half = turning * (0.5 * dt_s);
        let turn = DQuat::from_xyzw(half.x, half.y, half.z, 1.0).normalize();
        self.position += (moving + half.cross(moving)) * dt_s;
        self.turn = (turn * self.turn).normalize();
        self.rate[3..6].copy_from_slice(&(turn * moving).to_array());
        for i in 0..2 {
            self.joint_rad[i] += dt_s * self.rate[JOINTS + i];
        }
        self.roll_rad += dt_s * self.rate[ROLL];
        for i in 0..6 {
            self.arm_rad[i] += dt_s * self.rate[ARMS + i];
        }
    }
}
