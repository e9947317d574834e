//! How a wheel's contact patch takes force along the ground: at once, or by its give.
//!
//! The brush: the patch deflects by what its points slip, and its springs make the force; rolling
//! renews it over the relaxation length, so a steady slip angle ends in a steady deflection. The
//! step is implicit, with the deflection at its end. What friction cannot carry slides off.

use glam::{DMat3, DVec3};

use super::contact::{Contact, Grip, outer};
use crate::{Brush, TyrePart};

/// A wheel's patch over a step: directions, and what it makes of the patch's give.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    brush: Option<Brush>,
    /// Share of the deflection that rolling leaves over the step.
    kept: f64,
    /// Deflection at the step's start along the rolling and along the axle, m.
    deflection_m: [f64; 2],
    /// Slip of the ground itself along the rolling, m/s: what of the rolling is no travel.
    loose_m_s: f64,
    axle: DVec3,
    dt_s: f64,
}

impl Patch {
    /// The patch of a tyre whose wheel turns at `rolling_m_s` at its rim.
    pub(super) fn new(
        tyre: &TyrePart,
        deflection_m: [f64; 2],
        axle: DVec3,
        rolling_m_s: f64,
        dt_s: f64,
    ) -> Self {
        let renewed = tyre.brush.map_or(0.0, |b| rolling_m_s.abs() * dt_s / b.relaxation_m);
        Self {
            brush: tyre.brush,
            kept: 1.0 / (1.0 + renewed),
            deflection_m,
            loose_m_s: tyre.slip * rolling_m_s,
            axle,
            dt_s,
        }
    }

    /// Directions of the rolling and of the axle in the plane of a contact.
    fn directions(&self, normal: DVec3) -> [DVec3; 2] {
        let rolling = self.axle.cross(normal).try_normalize();
        let rolling = rolling.unwrap_or_else(|| normal.any_orthonormal_vector());
        [rolling, normal.cross(rolling)]
    }

    /// The grip of a contact with this normal.
    pub(super) fn grip(&self, normal: DVec3) -> Grip {
        let directions = self.directions(normal);
        let mut grip = match &self.brush {
            None => Grip::rigid(normal, self.dt_s),
            Some(brush) => {
                let mut grip = Grip { hold: DVec3::ZERO, stick: DMat3::ZERO };
                let springs = [brush.longitudinal_n_m, brush.lateral_n_m];
                for ((along, spring), deflection_m) in
                    directions.into_iter().zip(springs).zip(self.deflection_m)
                {
                    let impulse_n_s_m = spring * self.kept * self.dt_s;
                    grip.hold += along * (impulse_n_s_m * deflection_m);
                    grip.stick += outer(along, along * (impulse_n_s_m * self.dt_s));
                }
                grip
            }
        };
        if self.loose_m_s != 0.0 {
            grip.hold += grip.stick * directions[0] * self.loose_m_s;
        }
        grip
    }

    /// The deflection at the step's end: what the force says, which friction may have cut; m.
    pub(super) fn deflection_m<'a>(&self, contacts: impl Iterator<Item = &'a Contact>) -> [f64; 2] {
        let Some(brush) = &self.brush else { return [0.0; 2] };
        let (mut sum, mut weight) = ([0.0; 2], 0.0);
        for contact in contacts {
            let impulse = contact.impulse(contact.velocity);
            if impulse != DVec3::ZERO {
                let directions = self.directions(contact.normal);
                for (sum, along) in sum.iter_mut().zip(directions) {
                    *sum -= along.dot(impulse) / self.dt_s;
                }
                weight += contact.weight;
            }
        }
        if weight == 0.0 {
            return [0.0; 2];
        }
        [sum[0] / (brush.longitudinal_n_m * weight), sum[1] / (brush.lateral_n_m * weight)]
    }
}

#[cfg(test)]
mod tests {
    use super::super::contact::{Body, ContactLaw};
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
            brush: Some(Brush { longitudinal_n_m: 8.0e5, lateral_n_m: 4.0e5, relaxation_m }),
        }
    }

    /// Deflection after a second at a velocity of the patch's point, the wheel rolling at 1 m/s.
    fn after_a_second(tyre: &TyrePart, velocity: DVec3, depth_m: f64) -> [f64; 2] {
        let mut deflection_m = [0.0; 2];
        for _ in 0..200 {
            let patch = Patch::new(tyre, deflection_m, DVec3::Y, 1.0, DT_S);
            let place = (Body::Wheel(0), DVec3::ZERO, DVec3::Z);
            // Two minima that share one contact are as one.
            let contacts = [0.3, 0.7].map(|weight| {
                let grip = patch.grip(DVec3::Z);
                let mut contact = Contact::new(&LAW, place, &grip, depth_m, weight, DT_S);
                contact.velocity = velocity;
                contact
            });
            deflection_m = patch.deflection_m(contacts.iter());
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
