//! The fast core: a solver of exactly this vehicle in its 20 freedoms, behind the same trait.
//!
//! One step is: where everything is ([`pose`]), what its motion and weight ask ([`bias`]), where it
//! touches ([`ground`]), then the velocities at the step's end at which all impulses balance
//! ([`newton`]), with springs, tyres, friction and brakes taken implicitly. Positions follow from
//! those velocities (semi-implicit Euler, first order). `f64`, nothing allocated in a step, and
//! solved to rounding: what comes out is as smooth in every parameter as the laws that go in.

mod bias;
mod contact;
mod factor;
mod ground;
mod newton;
mod pose;
mod spatial;
mod tree;

use glam::{DQuat, DVec3};
use xt28_machine::{PerWheel, Wheel};

use self::contact::{Body, Contact, ContactLaw};
use self::ground::{BAND_M, Touches};
use self::newton::{Balance, Convergence};
use self::pose::{ARMS, FREEDOMS, Inertias, JOINTS, Pose, State, WHEELS};
use self::spatial::{angular, linear};
use self::tree::Tree;
use crate::bodies::{Bodies, HingeMotion, HingeSpring, Loads, Motion};
use crate::{Parts, Terrain};

/// Most contacts of the whole machine: hollows under all wheels at once, or it lies on its side.
const CONTACTS_MAX: usize = 64;
/// Sheet steel on ground (assumed): stiff enough to be seen at once, soft enough for any step.
const HULL: ContactLaw = ContactLaw { stiffness_n_m: 4.0e6, damping_n_s_m: 6.0e4, friction: 0.5 };
/// A wheel's speed toward the ground counts this long ahead when contacts are looked for, beside
/// the step: c/k of the softest tyre worth having, s.
const LOOK_AHEAD_S: f64 = 0.03;

/// The vehicle's bodies in reduced coordinates. A clone is a snapshot.
#[derive(Clone, Debug)]
pub struct ReducedBodies {
    tree: Tree,
    terrain: Terrain,
    state: State,
    ground_force_n: PerWheel<f64>,
    chassis_force_n: f64,
    convergence: Convergence,
}

impl Bodies for ReducedBodies {
    fn new(parts: &Parts, terrain: &Terrain, stroke_m: PerWheel<f64>) -> Self {
        let tree = Tree::new(parts);
        let reference_z = |arm: &tree::Arm| (arm.pivot + arm.to_wheel).z;
        let mut state = State {
            position: DVec3::ZERO,
            turn: DQuat::IDENTITY,
            joint_rad: [0.0; 2],
            arm_rad: stroke_m.map(|stroke_m| parts.arm_angle_rad(stroke_m)).0,
            rate: [0.0; FREEDOMS],
        };
        let pose = Pose::new(&tree, &state);
        let lift = |i: usize| reference_z(&tree.arms[i]) - pose.arm[i].wheel.z;
        state.position.z = (0..6).map(lift).fold(f64::MIN, f64::max);
        Self {
            tree,
            terrain: terrain.clone(),
            state,
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
            wheel_rate_rad_s: PerWheel(core::array::from_fn(|i| s.rate[WHEELS + i])),
            position_m: s.position.to_array(),
            axes: DVec3::AXES.map(|axis| (s.turn * axis).to_array()),
            velocity_m_s: spatial::velocity_at(&twist, com).to_array(),
            rate_rad_s: angular(&twist).to_array(),
            ground_force_n: self.ground_force_n,
            chassis_force_n: self.chassis_force_n,
        }
    }

    fn advance(&mut self, loads: &Loads, dt_s: f64) {
        let pose = Pose::new(&self.tree, &self.state);
        let inertias = Inertias::new(&self.tree, &pose);
        let mut contacts = Contacts::find(&self.tree, &self.terrain, &pose, &self.state, dt_s);
        let balance = self.balance(&pose, &inertias, loads, dt_s);
        let contacts = contacts.touching();
        self.convergence = balance.solve(&mut self.state.rate, contacts);
        self.state.advance(dt_s);
        self.note_forces(contacts, dt_s);
    }
}

impl ReducedBodies {
    /// What the step's velocities have to balance, but for contacts and brakes.
    fn balance<'a>(
        &self,
        pose: &'a Pose,
        inertias: &'a Inertias,
        loads: &Loads,
        dt_s: f64,
    ) -> Balance<'a> {
        let s = &self.state;
        let about_com = &inertias.about_com;
        let mut lack = bias::bias(&self.tree, pose, about_com, &s.rate, self.tree.gravity);
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
        let mut on_wheel = [spatial::ZERO; 6];
        for i in 0..6 {
            lack[WHEELS + i] -= loads.drive_nm.0[i];
            on_wheel[i] = spatial::join(pose.arm[i].axle * loads.drag_nm.0[i], DVec3::ZERO);
        }
        let from_ground = newton::generalised(pose, &on_wheel, [spatial::ZERO; 3]);
        for (lack, from_ground) in lack.iter_mut().zip(&from_ground) {
            *lack = (*lack - from_ground) * dt_s;
        }
        let brake = loads.hold_nm.0.map(|hold_nm| hold_nm * dt_s);
        let inertias = &inertias.spatial;
        Balance { pose, inertias, lack, hinge, brake, dt_s, mass_kg: self.tree.mass_kg }
    }

    fn note_forces(&mut self, contacts: &[Contact], dt_s: f64) {
        self.ground_force_n = PerWheel::splat(0.0);
        self.chassis_force_n = 0.0;
        for contact in contacts {
            let force = contact.impulse(contact.velocity) / dt_s;
            match contact.body {
                Body::Wheel(i) => self.ground_force_n[Wheel::ALL[i]] += force.z,
                Body::Frame(_) => self.chassis_force_n += force.length(),
            }
        }
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
        for i in 0..6 {
            self.arm_rad[i] += dt_s * self.rate[ARMS + i];
        }
    }
}

/// The contacts of one step.
struct Contacts {
    all: [Contact; CONTACTS_MAX],
    count: usize,
}

impl Contacts {
    fn find(tree: &Tree, terrain: &Terrain, pose: &Pose, state: &State, dt_s: f64) -> Self {
        let mut found = Self { all: [Contact::NONE; CONTACTS_MAX], count: 0 };
        let frames = pose.frame_twists(&state.rate);
        let search = Search { terrain, origin: state.position, dt_s };
        for i in 0..6 {
            let arm = pose.arm_twist(i, &frames[Tree::frame_of(i)], &state.rate);
            let ball =
                Ball { body: Body::Wheel(i), centre: pose.arm[i].wheel, radius_m: tree.radius_m };
            search.touches(&ball, &arm, &tree.tyres[i], &mut found);
        }
        for (i, hull) in tree.hulls.iter().enumerate() {
            for part in hull {
                let centre = pose.frame[i].point(part.centre_m.into());
                let ball = Ball { body: Body::Frame(i), centre, radius_m: part.radius_m };
                search.touches(&ball, &frames[i], &HULL, &mut found);
            }
        }
        found
    }

    /// A contact beyond the last is lost: the machine then lies on 64 points already.
    fn push(&mut self, contact: Contact) {
        if let Some(free) = self.all.get_mut(self.count) {
            *free = contact;
            self.count += 1;
        }
    }

    fn touching(&mut self) -> &mut [Contact] {
        &mut self.all[..self.count]
    }
}

/// A ball of the vehicle's outside, from the front frame's origin.
struct Ball {
    body: Body,
    centre: DVec3,
    radius_m: f64,
}

/// What a search for contacts needs beside the balls.
struct Search<'a> {
    terrain: &'a Terrain,
    origin: DVec3,
    dt_s: f64,
}

impl Search<'_> {
    fn touches(
        &self,
        ball: &Ball,
        twist: &spatial::Spatial,
        law: &ContactLaw,
        found: &mut Contacts,
    ) {
        let speed_m_s = spatial::velocity_at(twist, ball.centre).length();
        let reach_m = ball.radius_m + (LOOK_AHEAD_S + self.dt_s) * speed_m_s + BAND_M;
        for touch in Touches::find(self.terrain, self.origin + ball.centre, reach_m).iter() {
            let depth_m = ball.radius_m - touch.distance_m;
            // Half way between the undeformed surfaces, as other engines have it: a tyre rolls on a
            // radius between the free and the loaded one.
            let at = touch.point - self.origin - touch.normal * (0.5 * depth_m);
            let place = (ball.body, at, touch.normal);
            found.push(Contact::new(law, place, depth_m, touch.weight, self.dt_s));
        }
    }
}
