//! Wheels on their tyres: the block's forces at the points where a ball touches the ground.
//!
//! The engine's own contact is not used for wheels. It takes a spring only as a frequency of a mass that it
//! works out itself, one for all contacts, and its second pass stops whatever still moves into the
//! ground, so that a soft tyre could not bounce.

use rapier3d::prelude::*;
use xt28_machine::Wheel;
use xt28_terrain::Nearest;

use super::insert::vector;
use super::rolling::Rolling;
use crate::blocks::{PATCHES_MAX, PatchInput, Patches, Tyre};
use crate::parts::Parts;
use crate::{RollingDrag, Terrain};

/// Share of the deflection by which the radius is smaller that the wheel rolls on and that forces along
/// the ground have as lever: between the third of a radial tyre and the whole of a rigid band.
const RADIUS_SHARE: f64 = 0.5;

/// Where a wheel is and how it moves, in the world.
pub(super) struct Rim {
    /// Its centre, m.
    pub(super) centre: Vector,
    /// Its axle, to the left.
    pub(super) axle: Vector,
    /// Velocity of the centre, m/s, and angular velocity, rad/s.
    pub(super) velocities: [Vector; 2],
    /// Its turning about the axle, against the arm, rad/s.
    pub(super) rate_rad_s: f64,
    /// The motor's torque on it in the coming step, Nm.
    pub(super) drive_nm: f64,
}

/// How a wheel's tread met the ground: what the tyre's block was fed and what came of it, in the ground's axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tread {
    /// The axle, to the left. Forward along the ground is the axle crossed with a patch's normal.
    pub axle: [f64; 3],
    /// The wheel's centre, m.
    pub centre_m: [f64; 3],
    /// What the ground then pushed the wheel with, N.
    pub force_n: [f64; 3],
    /// And turned it with about its centre, Nm.
    pub torque_nm: [f64; 3],
    /// What resisted its rolling, in its axle, Nm; forward > 0.
    pub drag_nm: f64,
    inputs: [PatchInput; PATCHES_MAX],
    count: usize,
}

impl Tread {
    /// Each point that touched or was about to.
    #[must_use]
    pub fn patches(&self) -> &[PatchInput] {
        &self.inputs[..self.count]
    }

    fn new(rim: &Rim, met: &[Patch]) -> Self {
        let mut tread = Self {
            axle: wide(rim.axle),
            centre_m: wide(rim.centre),
            count: met.len(),
            ..Self::default()
        };
        for (input, patch) in tread.inputs.iter_mut().zip(met) {
            *input = patch.input;
        }
        tread
    }
}

/// One wheel's tyre and where it touches.
#[derive(Clone, Debug)]
pub(super) struct TyreContact {
    tyre: Tyre,
    radius_m: f64,
    slip: f64,
    /// Where it touched before the last step, and what it remembers of that.
    tread: Tread,
    patches: Patches,
    rolling: Rolling,
}

impl TyreContact {
    /// The tyre of a wheel.
    pub(super) fn new(parts: &Parts, wheel: Wheel) -> Self {
        let (part, rim) = (&parts.tyres[wheel], &parts.wheel);
        let turns_kg = rim.inertia_kg_m2[1] / (parts.radius_m * parts.radius_m);
        Self {
            tyre: Tyre::new(part, [rim.mass_kg, turns_kg]),
            radius_m: parts.radius_m,
            slip: part.slip,
            tread: Tread::default(),
            patches: Patches::default(),
            rolling: Rolling::new(rim.inertia_kg_m2[1]),
        }
    }

    /// How the tread met the ground when it was last pushed.
    pub(super) const fn tread(&self) -> &Tread {
        &self.tread
    }

    /// Steps the tyre from where its wheel is now. Gives the ground's force and torque on the wheel for the engine's
    /// next step of `dt_s` s; what resists the rolling in it is the tread's.
    pub(super) fn push(
        &mut self,
        rim: &Rim,
        terrain: &Terrain,
        drag: &RollingDrag,
        dt_s: f64,
    ) -> [Vector; 2] {
        let minima = terrain.nearest(wide(rim.centre), self.radius_m);
        let met: Vec<Patch> = minima.points().iter().map(|near| self.meet(rim, near)).collect();
        self.tread = Tread::new(rim, &met);
        self.patches = self.tyre.step(self.patches.states(), self.tread.patches(), dt_s);
        let [mut force, mut torque] = [Vector::ZERO; 2];
        for (patch, state) in met.iter().zip(self.patches.states()) {
            let push = patch.normal * narrow(state.load_n)
                + patch.forward * narrow(state.along_n[0])
                + patch.left * narrow(state.along_n[1]);
            force += push;
            torque += patch.lever.cross(push);
        }
        let turning_nm = rim.drive_nm + f64::from(torque.dot(rim.axle));
        let drag_nm = self.rolling.step(drag, rim.rate_rad_s, turning_nm, dt_s);
        self.tread.drag_nm = drag_nm;
        (self.tread.force_n, self.tread.torque_nm) = (wide(force), wide(torque));
        [force, torque]
    }

    fn meet(&self, rim: &Rim, nearest: &Nearest) -> Patch {
        let [velocity, rate] = rim.velocities;
        let away = rim.centre - vector(nearest.point_m);
        let out = if nearest.distance_m < 0.0 { -1.0 } else { 1.0 };
        let normal = (away * out).normalize_or(Vector::Z);
        let forward = rim.axle.cross(normal).normalize_or(Vector::X);
        let left = normal.cross(forward);
        let depth_m = self.radius_m - nearest.distance_m;
        let lever_m = self.radius_m - RADIUS_SHARE * depth_m;
        let lever = normal * -narrow(lever_m);
        let tread = velocity + rate.cross(lever);
        let rolling_m_s = f64::from(rate.dot(rim.axle)) * lever_m;
        let slip_m_s =
            [f64::from(tread.dot(forward)) + self.slip * rolling_m_s, f64::from(tread.dot(left))];
        let input = PatchInput {
            normal: wide(normal),
            depth_m,
            depth_rate_m_s: -f64::from(velocity.dot(normal)),
            slip_m_s,
            rolling_m_s,
        };
        Patch { lever, normal, forward, left, input }
    }
}

/// One point of contact, with the axes along which its forces are.
struct Patch {
    /// From the wheel's centre.
    lever: Vector,
    normal: Vector,
    forward: Vector,
    left: Vector,
    input: PatchInput,
}

fn wide(v: Vector) -> [f64; 3] {
    v.to_array().map(f64::from)
}

#[allow(clippy::cast_possible_truncation)]
const fn narrow(v: f64) -> Real {
    v as Real
}
