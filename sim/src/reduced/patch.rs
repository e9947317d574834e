//! How a wheel's contact patch takes force along the ground: the brush.
//!
//! Bristles deflect by what their points slip and are renewed as the wheel rolls, so a steady slip
//! angle ends in a steady deflection; their springs and dampers make the force, as far as friction
//! carries it. The law is [`crate::Tyre`]'s; here the deflection and its rate at the step's end are
//! functions of the velocity that the solver looks for. A rigid wheel has no bristles and sticks.

use glam::DVec3;

use super::contact::{Contact, Grip};
use crate::{Brush, TyrePart};

/// Damping of the bristles as a share of critical with a wheel's mass (assumed).
const BRISTLE_DAMPING: f64 = 0.5;

/// A wheel's patch over a step: directions, and what it makes of the bristles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    bristles: Option<Bristles>,
    friction: f64,
    creep_m_s_n: f64,
    /// Slip of the ground itself along the rolling, m/s: what of the rolling is no travel.
    loose_m_s: f64,
    axle: DVec3,
    dt_s: f64,
}

/// The brush of a patch, along the rolling and along the axle.
#[derive(Clone, Copy, Debug)]
struct Bristles {
    stiffness_n_m: [f64; 2],
    damping_n_s_m: [f64; 2],
    /// Share of the deflection that rolling and shearing ground leave over the step.
    kept: [f64; 2],
    /// Deflection at the step's start, m.
    start_m: [f64; 2],
}

impl Bristles {
    fn new(brush: &Brush, creep_m_s_n: f64, wheel: &RollingWheel, dt_s: f64) -> Self {
        let stiffness_n_m = [brush.longitudinal_n_m, brush.lateral_n_m];
        let damping = |k: f64| 2.0 * BRISTLE_DAMPING * (k * wheel.wheel_kg).sqrt();
        let rolled = wheel.rim_m_s.abs() * dt_s / brush.relaxation_m;
        Self {
            stiffness_n_m,
            damping_n_s_m: stiffness_n_m.map(damping),
            kept: stiffness_n_m.map(|k| 1.0 / (1.0 + rolled + dt_s * creep_m_s_n * k)),
            start_m: wheel.bristle_m,
        }
    }
}

/// A wheel as its patch sees it at the start of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct RollingWheel {
    pub(super) bristle_m: [f64; 2],
    pub(super) axle: DVec3,
    /// Speed of the rim as the wheel turns against the world, m/s.
    pub(super) rim_m_s: f64,
    pub(super) wheel_kg: f64,
}

impl Patch {
    pub(super) fn new(tyre: &TyrePart, wheel: &RollingWheel, dt_s: f64) -> Self {
        Self {
            bristles: tyre.brush.map(|brush| Bristles::new(&brush, tyre.creep_m_s_n, wheel, dt_s)),
            friction: tyre.friction,
            creep_m_s_n: tyre.creep_m_s_n,
            loose_m_s: tyre.slip * wheel.rim_m_s,
            axle: wheel.axle,
            dt_s,
        }
    }

    /// Directions of the rolling and of the axle in the plane of a contact.
    fn directions(&self, normal: DVec3) -> [DVec3; 2] {
        let rolling = self.axle.cross(normal).try_normalize();
        let rolling = rolling.unwrap_or_else(|| normal.any_orthonormal_vector());
        [rolling, normal.cross(rolling)]
    }

    /// The grip of a contact with this normal: k z + c z' with z = kept (z0 + dt v).
    pub(super) fn grip(&self, normal: DVec3) -> Grip {
        let mut grip = Grip::rigid(self.directions(normal), self.creep_m_s_n, self.dt_s);
        if let Some(bristles) = &self.bristles {
            for i in 0..2 {
                // Impulses per deflection and per velocity of it.
                let spring = bristles.stiffness_n_m[i] * self.dt_s;
                let damper = bristles.damping_n_s_m[i];
                let end = (spring + damper) * bristles.kept[i];
                grip.hold[i] = (end - damper) * bristles.start_m[i];
                grip.stick[i] = end * self.dt_s;
            }
        }
        grip.hold[0] += grip.stick[0] * self.loose_m_s;
        grip
    }

    /// The deflection at the step's end, m: bristles slide where friction cannot hold them. Several
    /// points touched share one brush, each by its load.
    pub(super) fn end_m<'a>(&self, contacts: impl Iterator<Item = &'a Contact>) -> [f64; 2] {
        let Some(bristles) = &self.bristles else { return [0.0; 2] };
        let (mut sum_m, mut load_n, mut weight) = ([0.0; 2], 0.0, 0.0);
        for contact in contacts {
            let own_n = contact.now.impulse[0] / self.dt_s;
            if own_n > 0.0 {
                let [_, rolling_m_s, axle_m_s] = contact.now.velocity_m_s;
                let slip_m_s = [rolling_m_s + self.loose_m_s, axle_m_s];
                for i in 0..2 {
                    let slipped_m = bristles.start_m[i] + self.dt_s * slip_m_s[i];
                    let carried_m = bristles.kept[i] * slipped_m;
                    sum_m[i] += own_n * carried_m;
                }
                load_n += own_n;
                weight += contact.weight;
            }
        }
        if load_n <= 0.0 {
            return [0.0; 2];
        }
        let end_m = sum_m.map(|m| m / load_n);
        let k = bristles.stiffness_n_m;
        let held_n = (end_m[0] * k[0]).hypot(end_m[1] * k[1]);
        // Each point has a share of the springs; together they carry what the brush does.
        let limit_n = self.friction * load_n / weight;
        let share = if held_n > limit_n { limit_n / held_n } else { 1.0 };
        end_m.map(|m| m * share)
    }
}

#[cfg(test)]
mod tests {
    use super::super::contact::{Body, ContactLaw};
    use super::super::spatial::join;
    use super::*;

    const LAW: ContactLaw =
        ContactLaw { stiffness_n_m: 1.0e6, damping_n_s_m: 1.0e4, friction: 0.7 };
    const DT_S: f64 = 0.005;

    fn tyre(relaxation_m: f64) -> TyrePart {
        TyrePart {
            stiffness_n_m: LAW.stiffness_n_m,
            damping_n_s_m: LAW.damping_n_s_m,
            friction: LAW.friction,
            slip: 0.0,
            creep_m_s_n: 0.0,
            brush: Some(Brush { longitudinal_n_m: 8.0e5, lateral_n_m: 4.0e5, relaxation_m }),
        }
    }

    /// Deflection after a second at a velocity of the patch's point, the wheel rolling at 1 m/s.
    fn after_a_second(tyre: &TyrePart, velocity: DVec3, depth_m: f64) -> [f64; 2] {
        let mut deflection_m = [0.0; 2];
        for _ in 0..200 {
            let wheel = RollingWheel {
                bristle_m: deflection_m,
                axle: DVec3::Y,
                rim_m_s: 1.0,
                wheel_kg: 550.0,
            };
            let patch = Patch::new(tyre, &wheel, DT_S);
            let place = (Body::Wheel(0), DVec3::ZERO, DVec3::Z);
            // Two minima that share one contact are as one.
            let contacts = [0.3, 0.7].map(|weight| {
                let grip = patch.grip(DVec3::Z);
                let mut contact = Contact::new(&LAW, place, &grip, depth_m, weight, DT_S);
                contact.guess(&join(DVec3::ZERO, velocity));
                contact
            });
            deflection_m = patch.end_m(contacts.iter());
        }
        deflection_m
    }

    #[test]
    fn a_patch_that_never_renews_deflects_by_what_it_slipped() {
        let [along, across] =
            after_a_second(&tyre(f64::INFINITY), DVec3::new(0.002, -0.003, 0.0), 0.01);
        assert!((along - 0.002).abs() < 1e-12 && (across + 0.003).abs() < 1e-12);
    }

    #[test]
    fn rolling_ends_in_slip_times_relaxation() {
        let [_, across] = after_a_second(&tyre(0.1), DVec3::new(0.0, 0.02, 0.0), 0.01);
        assert!((across - 0.02 * 0.1).abs() < 1e-6, "{across}");
    }

    #[test]
    fn friction_bounds_the_deflection_and_the_air_clears_it() {
        let [_, across] = after_a_second(&tyre(f64::INFINITY), DVec3::new(0.0, 0.5, 0.0), 0.01);
        let most = LAW.friction * LAW.stiffness_n_m * 0.01 / 4.0e5;
        assert!((across - most).abs() < 1e-12, "{across}");
        assert_eq!(after_a_second(&tyre(0.1), DVec3::Y, -0.1), [0.0; 2]);
    }
}
