//! Wheels on their tyres: the block's forces at the points where a ball touches the ground.
//!
//! The engine's own contact is not used for wheels. It takes a spring only as a frequency of a mass that it
//! works out itself, one for all contacts, and its second pass stops whatever still moves into the
//! ground, so that a soft tyre could not bounce.

use rapier3d::prelude::*;
use xt28_machine::Wheel;
use xt28_terrain::Nearest;

use super::insert::vector;
use crate::Terrain;
use crate::blocks::{PATCHES_MAX, PatchInput, PatchState, Tyre};
use crate::parts::Parts;

/// Share of the deflection by which the radius is smaller that the wheel rolls on and that forces along
/// the ground have as lever: between the third of a radial tyre and the whole of a rigid band.
const RADIUS_SHARE: f64 = 0.5;
/// Two patches of successive steps are one if their normals are this parallel.
const SAME_PATCH: f64 = 0.95;

/// Where a wheel is and how it moves, in the world.
pub(super) struct Rim {
    /// Its centre, m.
    pub(super) centre: Vector,
    /// Its axle, to the left.
    pub(super) axle: Vector,
    /// Velocity of the centre, m/s, and angular velocity, rad/s.
    pub(super) velocities: [Vector; 2],
}

/// One wheel's tyre and where it touches.
#[derive(Clone, Debug)]
pub(super) struct TyreContact {
    tyre: Tyre,
    radius_m: f64,
    slip: f64,
    patches: [([f64; 3], PatchState); PATCHES_MAX],
    count: usize,
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
            patches: [([0.0; 3], PatchState::default()); PATCHES_MAX],
            count: 0,
        }
    }

    /// Steps the tyre from where its wheel is now. Gives force and torque on the wheel for the
    /// engine's next step of `dt_s` s.
    pub(super) fn push(&mut self, rim: &Rim, terrain: &Terrain, dt_s: f64) -> [Vector; 2] {
        let minima = terrain.nearest(rim.centre.to_array().map(f64::from), self.radius_m);
        let met: Vec<Patch> = minima.points().iter().map(|near| self.meet(rim, near)).collect();
        let before: Vec<PatchState> = met.iter().map(|patch| self.known(patch)).collect();
        let inputs: Vec<PatchInput> = met.iter().map(|patch| patch.input).collect();
        let after = self.tyre.step(&before, &inputs, dt_s);
        self.count = met.len();
        let [mut force, mut torque] = [Vector::ZERO; 2];
        for (i, (patch, state)) in met.iter().zip(after.states()).enumerate() {
            self.patches[i] = (patch.input.normal, *state);
            let push = patch.normal * narrow(state.load_n)
                + patch.forward * narrow(state.along_n[0])
                + patch.left * narrow(state.along_n[1]);
            force += push;
            torque += patch.lever.cross(push);
        }
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
            normal: normal.to_array().map(f64::from),
            depth_m,
            depth_rate_m_s: -f64::from(velocity.dot(normal)),
            slip_m_s,
            rolling_m_s,
        };
        Patch { lever, normal, forward, left, input }
    }

    /// What a patch remembers from the last step, if it was there.
    fn known(&self, patch: &Patch) -> PatchState {
        let along = |(normal, _): &&([f64; 3], PatchState)| {
            normal.iter().zip(patch.input.normal).map(|(a, b)| a * b).sum::<f64>()
        };
        let nearest = self.patches[..self.count].iter().map(|known| (along(&known), known.1));
        let best = nearest.max_by(|a, b| a.0.total_cmp(&b.0));
        best.filter(|(along, _)| *along > SAME_PATCH).map(|(_, state)| state).unwrap_or_default()
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

#[allow(clippy::cast_possible_truncation)]
const fn narrow(v: f64) -> Real {
    v as Real
}
