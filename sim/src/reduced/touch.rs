//! Which parts of the vehicle are at the ground: wheels every step, the hull when it can be.

use glam::DVec3;

use super::contact::{Body, Contact, ContactLaw, Grip};
use super::ground::Touches;
use super::patch::{Patch, RollingWheel};
use super::pose::{Pose, State};
use super::spatial::{Spatial, angular, velocity_at};
use super::tree::Tree;
use crate::{HullBall, Terrain};

/// Most contacts of the whole machine: on its belly, whose balls all touch level ground. A contact beyond the
/// last is lost.
pub(super) const CONTACTS_MAX: usize = 96;
/// Sheet steel on ground (assumed): stiff enough to be seen at once, soft enough for any step.
const HULL: ContactLaw = ContactLaw { stiffness_n_m: 4.0e6, damping_n_s_m: 6.0e4, friction: 0.5 };
/// How fast a part may get faster within a step, m/s2 (assumed).
const GAINED_M_S2: f64 = 20.0;
/// How far from the ground a part of the hull is told to be at most, m.
const CLEARANCE_MAX_M: f64 = 0.4;

/// Search for contacts: what it needs of the vehicle, and how far the hull is from needing it.
#[derive(Clone, Debug)]
pub(super) struct Search {
    terrain: Terrain,
    /// Those of the last ball; here so that they need not be made anew.
    touches: Touches,
    /// Path that each frame's hull may yet travel before any of it can touch, m. Only saves time:
    /// nothing that is found depends on it.
    clear_m: [f64; 3],
    /// Wheels that stuck wherever they touched at the end of the last step: a first guess.
    pub(super) stuck: [bool; 6],
}

/// A ball of the vehicle's outside, from the front frame's origin.
struct Ball {
    body: Body,
    centre: DVec3,
    radius_m: f64,
    speed_m_s: f64,
}

impl Search {
    pub(super) fn new(terrain: Terrain) -> Self {
        Self { terrain, touches: Touches::default(), clear_m: [0.0; 3], stuck: [false; 6] }
    }

    /// Forgets how far the hull was from the ground: the machine has been put elsewhere.
    pub(super) const fn look_again(&mut self) {
        self.clear_m = [0.0; 3];
    }

    /// Fills `found` with the contacts that may make a force within this step.
    pub(super) fn contacts(
        &mut self,
        (tree, pose, state): (&Tree, &Pose, &State),
        patches: &[Patch; 6],
        dt_s: f64,
        found: &mut Vec<Contact>,
    ) {
        found.clear();
        let frames = pose.frame_twists(&state.rate);
        for (i, patch) in patches.iter().enumerate() {
            let centre = pose.arm[i].wheel;
            let arm = pose.arm_twist(i, &frames[Tree::frame_of(i)], &state.rate);
            let speed_m_s = velocity_at(&arm, centre).length();
            let ball = Ball { body: Body::Wheel(i), centre, radius_m: tree.radius_m, speed_m_s };
            self.add(&ball, state.position, &tree.laws[i], Some(patch), dt_s, found);
        }
        for (i, hull) in tree.hulls.iter().enumerate() {
            let speed_m_s = velocity_at(&frames[i], pose.frame[i].com).length()
                + angular(&frames[i]).length() * tree.hull_reach_m[i];
            self.clear_m[i] -= speed_m_s * dt_s;
            if self.clear_m[i] < ahead_m(speed_m_s, dt_s) {
                self.clear_m[i] =
                    self.hull((i, hull), &frames[i], (pose, state), dt_s, found).max(0.0);
            }
        }
    }

    /// Contacts of one frame's hull; returns how far the rest of it is from the ground, m.
    fn hull(
        &mut self,
        (frame, hull): (usize, &[HullBall]),
        twist: &Spatial,
        (pose, state): (&Pose, &State),
        dt_s: f64,
        found: &mut Vec<Contact>,
    ) -> f64 {
        let mut clear_m = CLEARANCE_MAX_M;
        for part in hull {
            let centre = pose.frame[frame].point(part.centre_m.into());
            let world = (state.position + centre).to_array();
            let speed_m_s = velocity_at(twist, centre).length();
            let ahead_m = ahead_m(speed_m_s, dt_s);
            let mut gap_m = CLEARANCE_MAX_M;
            // However deep another part is in the ground, this one may touch it too.
            self.terrain.each_minimum(world, part.radius_m + clear_m.max(ahead_m), |nearest| {
                gap_m = gap_m.min(nearest.distance_m - part.radius_m);
            });
            clear_m = clear_m.min(gap_m);
            if gap_m <= ahead_m {
                let ball =
                    Ball { body: Body::Frame(frame), centre, radius_m: part.radius_m, speed_m_s };
                self.add(&ball, state.position, &HULL, None, dt_s, found);
            }
        }
        clear_m
    }

    /// Adds the contacts of one ball.
    fn add(
        &mut self,
        ball: &Ball,
        origin: DVec3,
        law: &ContactLaw,
        patch: Option<&Patch>,
        dt_s: f64,
        found: &mut Vec<Contact>,
    ) {
        let reach_m = ball.radius_m + ahead_m(ball.speed_m_s, dt_s);
        self.touches.find(&self.terrain, origin + ball.centre, reach_m);
        for touch in self.touches.iter() {
            let depth_m = ball.radius_m - touch.distance_m;
            // Half way between the undeformed surfaces, as other engines have it: a tyre rolls on a
            // radius between the free and the loaded one.
            let at = touch.point - origin - touch.normal * (0.5 * depth_m);
            if found.len() < CONTACTS_MAX {
                let place = (ball.body, at, touch.normal);
                let grip = patch.map_or_else(
                    || Grip::rigid(touch.normal.any_orthonormal_pair().into(), 0.0, dt_s),
                    |patch| patch.grip(touch.normal),
                );
                let mut contact = Contact::new(law, place, &grip, depth_m, touch.weight, dt_s);
                contact.held = matches!(ball.body, Body::Wheel(i) if self.stuck[i]);
                found.push(contact);
            }
        }
    }
}

/// The patches of all wheels at the start of a step.
pub(super) fn patches(tree: &Tree, (pose, state): (&Pose, &State), dt_s: f64) -> [Patch; 6] {
    let rolling_rad_s = pose.rolling_rad_s(&state.rate);
    core::array::from_fn(|i| {
        let wheel = RollingWheel {
            bristle_m: state.bristle_m[i],
            axle: pose.arm[i].axle,
            rim_m_s: rolling_rad_s[i] * tree.radius_m,
            wheel_kg: tree.arms[i].wheel_kg,
        };
        Patch::new(&tree.tyres[i], &wheel, dt_s)
    })
}

/// How far from a ball ground can be and still make a force within the step, m: what it may travel, and half as
/// much again for what it may gain.
fn ahead_m(speed_m_s: f64, dt_s: f64) -> f64 {
    1.5 * dt_s * speed_m_s + GAINED_M_S2 * dt_s * dt_s
}
