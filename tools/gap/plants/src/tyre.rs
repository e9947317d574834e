//! A foreign machine's tyre: a damper that grows with the load, and a patch that shears, creeps, slides.
//!
//! Across the ground N = k d (1 + c/W d'), with depth d and c the damping under the nominal load W
//! (Hunt and Crossley 1975): it begins at nothing and never pulls. Along it the carcass is a spring and
//! a damper between rim and foot, and the foot itself moves: in proportion to its force wherever it
//! stands (rubber and regolith creep), in proportion to the way rolled where soil shears
//! (Janosi and Hanamoto 1961: F = mu N (1 - exp(-slip/shear))), freely beyond mu N. What it gives is that
//! of the motion at the step's start; at 2 ms and 8 MN/m that is stable by a factor of five.

use glam::DVec3;
use xt28_sim::{Terrain, Wrench};

use crate::rims::Rim;
use crate::truth::Tyre;

/// The carcass along the ground, N/m and N s/m (assumed).
const CARCASS_N_M: f64 = 4.8e6;
const CARCASS_N_S_M: f64 = 4.0e4;
/// Share of its depth by which a tyre rolls on a smaller radius (radial tyres, textbook).
const RADIUS_SHARE: f64 = 1.0 / 3.0;
/// Load at which the damping is what the truth says, N: a sixth of the empty machine.
const NOMINAL_N: f64 = 21_000.0;
/// Share of mu N up to which Janosi's slip is told; beyond, the patch slides as a whole.
const SHEARED_MOST: f64 = 0.98;
/// What a tyre remembers.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Carcass {
    /// Deflection, forward and to the left, m.
    give_m: [f64; 2],
    /// Force on the foot, the same way, N.
    foot_n: [f64; 2],
}

/// Where a wheel touches: all its points as one.
#[derive(Clone, Copy, Debug)]
struct Footprint {
    load: DVec3,
    /// The deepest point's, m.
    depth_m: f64,
}

impl Carcass {
    /// What the ground does to the wheel at `rim` for the next `dt_s` s.
    pub(crate) fn step(
        &mut self,
        tyre: &Tyre,
        radius_m: f64,
        rim: &Rim,
        ground: &Terrain,
        dt_s: f64,
    ) -> Wrench {
        let print = footprint(tyre, radius_m, rim, ground);
        let load_n = print.load.length();
        if load_n <= 0.0 {
            *self = Self::default();
            return Wrench::default();
        }
        let normal = print.load / load_n;
        let forward = rim.axle.cross(normal).normalize();
        let directions = [forward, normal.cross(forward)];
        let lever_m = radius_m - RADIUS_SHARE * print.depth_m;
        let lever = normal * -lever_m;
        let rolled_m_s = rim.rate_rad_s.dot(rim.axle) * lever_m;
        let tread = rim.velocity_m_s + rim.rate_rad_s.cross(lever);
        // What of the rolling the ground's top layer takes with it is no slip of the tread on it.
        let loose_m_s = [tyre.slip * rolled_m_s, 0.0];
        let slip_m_s: [f64; 2] = core::array::from_fn(|i| tread.dot(directions[i]) + loose_m_s[i]);
        self.shear(tyre, load_n, slip_m_s, rolled_m_s.abs(), dt_s);
        let force = print.load - directions[0] * self.foot_n[0] - directions[1] * self.foot_n[1];
        Wrench { force_n: force.to_array(), torque_nm: lever.cross(force).to_array() }
    }

    /// Carries the carcass along under `load_n`.
    fn shear(&mut self, tyre: &Tyre, load_n: f64, slip_m_s: [f64; 2], rolled_m_s: f64, dt_s: f64) {
        let most_n = tyre.friction * load_n;
        let foot_n = self.foot_n[0].hypot(self.foot_n[1]);
        let share = (foot_n / most_n).min(SHEARED_MOST);
        // Janosi's slip over the force that goes with it, which for small ones is shear / mu N.
        let shears = tyre.shear * rolled_m_s / most_n;
        let sheared = if share > 1e-6 { -shears * (-share).ln_1p() / share } else { shears };
        let follows = tyre.creep_m_s_n + sheared;
        for (i, slip_m_s) in slip_m_s.into_iter().enumerate() {
            // The foot follows the force at the step's end: it may be quicker than the step.
            let rigid_n =
                CARCASS_N_M * (self.give_m[i] + dt_s * slip_m_s) + CARCASS_N_S_M * slip_m_s;
            let end_n = rigid_n / (1.0 + follows * (CARCASS_N_M * dt_s + CARCASS_N_S_M));
            self.give_m[i] += dt_s * (slip_m_s - follows * end_n);
            self.foot_n[i] = end_n;
        }
        let asked_n = self.foot_n[0].hypot(self.foot_n[1]);
        if asked_n > most_n {
            self.foot_n = self.foot_n.map(|n| n * most_n / asked_n);
        }
        let held_n = CARCASS_N_M * self.give_m[0].hypot(self.give_m[1]);
        if held_n > most_n {
            self.give_m = self.give_m.map(|m| m * most_n / held_n);
        }
    }
}

fn footprint(tyre: &Tyre, radius_m: f64, rim: &Rim, ground: &Terrain) -> Footprint {
    let mut print = Footprint { load: DVec3::ZERO, depth_m: 0.0 };
    for near in ground.nearest(rim.centre_m.to_array(), radius_m).points() {
        let normal = (rim.centre_m - DVec3::from(near.point_m)).normalize_or(DVec3::Z);
        let depth_m = radius_m - near.distance_m;
        let coming_m_s = -rim.velocity_m_s.dot(normal);
        let damped = 1.0 + tyre.damping_n_s_m / NOMINAL_N * coming_m_s;
        print.load += normal * (tyre.stiffness_n_m * depth_m * damped).max(0.0);
        print.depth_m = print.depth_m.max(depth_m);
    }
    print
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::Truth;

    const DT_S: f64 = 0.002;

    fn tyre() -> Tyre {
        Truth::nominal().body.tyres.0[0]
    }

    fn rim(z_m: f64, velocity_m_s: [f64; 3], turns_rad_s: f64) -> Rim {
        Rim {
            centre_m: DVec3::new(0.0, 0.0, z_m),
            velocity_m_s: velocity_m_s.into(),
            axle: DVec3::Y,
            rate_rad_s: DVec3::Y * turns_rad_s,
        }
    }

    fn after(tyre: &Tyre, rim: &Rim, seconds: f64) -> [f64; 3] {
        let mut carcass = Carcass::default();
        let mut wrench = Wrench::default();
        for _ in 0..(seconds / DT_S) as u32 {
            wrench = carcass.step(tyre, 0.67, rim, &Terrain::Flat, DT_S);
        }
        wrench.force_n
    }

    #[test]
    fn it_carries_by_its_depth_and_more_while_it_is_pressed_in() {
        let still = after(&tyre(), &rim(0.667, [0.0; 3], 0.0), 0.1);
        assert!((still[2] - 8.0e6 * 0.003).abs() < 1.0 && still[0].abs() < 1.0, "{still:?}");
        let sinking = after(&tyre(), &rim(0.667, [0.0, 0.0, -0.1], 0.0), 0.1);
        let damper_n = 6.0e4 * 0.1 * 24.0 / 21.0;
        assert!((sinking[2] - still[2] - damper_n).abs() < 1.0, "{sinking:?}");
        assert_eq!(after(&tyre(), &rim(0.68, [0.0; 3], 3.0), 0.1), [0.0; 3]);
    }

    #[test]
    fn below_friction_it_creeps_in_proportion_and_beyond_it_slides() {
        let mut tyre = tyre();
        tyre.creep_m_s_n = 1e-5;
        let slow = after(&tyre, &rim(0.667, [0.05, 0.0, 0.0], 0.0), 1.0);
        assert!((slow[0] + 5.0e3).abs() < 10.0, "{slow:?}");
        let fast = after(&tyre, &rim(0.667, [0.0, 1.0, 0.0], 0.0), 1.0);
        assert!((fast[1] / (tyre.friction * fast[2]) + 1.0).abs() < 1e-6, "{fast:?}");
    }

    #[test]
    fn soil_that_shears_pulls_as_janosi_and_hanamoto_say() {
        let mut tyre = tyre();
        (tyre.friction, tyre.shear) = (0.3, 0.1);
        let slip = 0.05;
        // Rolls at 1 m/s on a radius of a third of 3 mm less, and travels by a twentieth less.
        let pulled = after(&tyre, &rim(0.667, [1.0 - slip, 0.0, 0.0], 1.0 / 0.669), 3.0);
        let want = 0.3 * pulled[2] * (1.0 - (-slip / 0.1_f64).exp());
        assert!((pulled[0] / want - 1.0).abs() < 0.01, "{pulled:?} {want}");
    }

    #[test]
    fn a_loose_top_layer_rolls_freely_at_its_slip() {
        let mut tyre = tyre();
        tyre.slip = 0.1;
        let free = after(&tyre, &rim(0.667, [0.9, 0.0, 0.0], 1.0 / 0.669), 1.0);
        assert!(free[0].abs() < 1.0, "{free:?}");
    }
}
