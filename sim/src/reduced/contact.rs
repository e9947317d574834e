//! The law of a contact within one step: a spring and damper that only pushes, and Coulomb friction.
//!
//! Implicit: the impulse is a function of the velocity at the step's end. A tyre's force is
//! max(0, k d - c d') with the depth d where the step ends, so the damper acts from the moment at
//! which the point is c/k ahead of touching. That makes the force continuous when a wheel comes
//! down. Friction is isotropic, at most mu times the normal force. What it is below that is the
//! contact's [`Grip`]: springs of a tyre's patch, or a creep in proportion to the force, as every
//! solver of rigid friction must let it or not know its force.

use glam::{DMat3, DVec3};

/// Sideways force per creep while a rigid contact sticks, N s/m (assumed): 10 kN creep 0.1 mm/s.
const CREEP_N_S_M: f64 = 1.0e8;

/// A spring and damper normal to the ground, and its friction.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactLaw {
    pub(super) stiffness_n_m: f64,
    pub(super) damping_n_s_m: f64,
    pub(super) friction: f64,
}

/// Sideways impulse against a velocity of the point, as far as friction carries it:
/// hold + stick velocity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grip {
    /// Impulse on the ground at no velocity, N s.
    pub(super) hold: DVec3,
    /// Its growth with the velocity, kg; nothing along the normal.
    pub(super) stick: DMat3,
}

impl Grip {
    /// A rigid contact's.
    pub(super) fn rigid(normal: DVec3, dt_s: f64) -> Self {
        let across = DMat3::IDENTITY - outer(normal, normal);
        Self { hold: DVec3::ZERO, stick: across * (CREEP_N_S_M * dt_s) }
    }
}

/// Whose contact it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Body {
    Wheel(usize),
    Frame(usize),
}

/// What a contact does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Hold {
    /// Makes no force.
    Open,
    /// Stays within its friction.
    Sticks,
    /// Has all its friction against it.
    Slides,
}

/// A point of a body at the ground, ready for the step's solver.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    pub(super) body: Body,
    /// From the front frame's origin.
    pub(super) at: DVec3,
    /// Out of the ground.
    pub(super) normal: DVec3,
    /// Impulse if the point stood still, N s.
    push: f64,
    /// Impulse that a normal velocity takes away, kg.
    slope: f64,
    grip: Grip,
    friction: f64,
    /// Share of the law that this contact is of.
    pub(super) weight: f64,
    /// Taken to stick however much force that needs: a first guess.
    pub(super) held: bool,
    /// Velocity of the point at the solver's present guess, m/s.
    pub(super) velocity: DVec3,
    /// What the solver's present step would add to it, m/s.
    pub(super) step: DVec3,
    /// [`Self::slope`] at the present guess, kg.
    pub(super) matrix: DMat3,
}

impl Contact {
    /// Touches nothing.
    pub(super) const NONE: Self = Self {
        body: Body::Frame(0),
        at: DVec3::ZERO,
        normal: DVec3::Z,
        push: 0.0,
        slope: 0.0,
        grip: Grip { hold: DVec3::ZERO, stick: DMat3::ZERO },
        friction: 0.0,
        weight: 1.0,
        held: false,
        velocity: DVec3::ZERO,
        step: DVec3::ZERO,
        matrix: DMat3::ZERO,
    };

    /// `weight`, 0 to 1, is the share of the law that this contact is of.
    pub(super) fn new(
        law: &ContactLaw,
        (body, at, normal): (Body, DVec3, DVec3),
        grip: &Grip,
        depth_m: f64,
        weight: f64,
        dt_s: f64,
    ) -> Self {
        let stiffness = law.stiffness_n_m * dt_s * weight;
        Self {
            body,
            at,
            normal,
            push: stiffness * depth_m,
            slope: stiffness * dt_s + law.damping_n_s_m * dt_s * weight,
            grip: Grip { hold: grip.hold * weight, stick: grip.stick * weight },
            friction: law.friction,
            weight,
            ..Self::NONE
        }
    }

    /// Normal impulse at a velocity of the point, N s; none where negative.
    #[inline]
    fn normal_impulse(&self, velocity: DVec3) -> f64 {
        self.push - self.slope * self.normal.dot(velocity)
    }

    /// Sideways impulse that the grip would make, and the largest that friction carries, N s.
    #[inline]
    fn sideways(&self, velocity: DVec3, normal: f64) -> (DVec3, f64) {
        (self.grip.hold + self.grip.stick * velocity, self.friction * normal)
    }

    /// The impulse on the body at a velocity of its point, N s.
    #[inline]
    pub(super) fn impulse(&self, velocity: DVec3) -> DVec3 {
        let normal = self.normal_impulse(velocity);
        if normal <= 0.0 {
            return DVec3::ZERO;
        }
        let (grip, most) = self.sideways(velocity, normal);
        let size = grip.length();
        let share = if size > most && !self.held { most / size } else { 1.0 };
        self.normal * normal - grip * share
    }

    /// What it does at the solver's present guess.
    pub(super) fn hold(&self) -> Hold {
        let normal = self.normal_impulse(self.velocity);
        let (grip, most) = self.sideways(self.velocity, normal);
        if normal <= 0.0 {
            Hold::Open
        } else if grip.length() <= most {
            Hold::Sticks
        } else {
            Hold::Slides
        }
    }

    /// Minus the derivative of [`Self::impulse`], kg. With `coupled` false, sliding friction is
    /// taken as if it did not follow the normal force.
    #[inline]
    pub(super) fn slope(&self, velocity: DVec3, coupled: bool) -> DMat3 {
        let normal = self.normal_impulse(velocity);
        if normal <= 0.0 {
            return DMat3::ZERO;
        }
        let along_normal = outer(self.normal, self.normal * self.slope);
        let (grip, most) = self.sideways(velocity, normal);
        let size = grip.length();
        if size <= most || self.held {
            return along_normal + self.grip.stick;
        }
        let direction = grip / size;
        let along = self.grip.stick.transpose() * direction;
        let turning = (self.grip.stick - outer(direction, along)) * (most / size);
        if !coupled {
            return along_normal + turning;
        }
        along_normal + turning - outer(direction, self.normal * (self.friction * self.slope))
    }
}

#[inline]
pub(super) fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: ContactLaw =
        ContactLaw { stiffness_n_m: 8.0e6, damping_n_s_m: 6.0e4, friction: 0.7 };
    const DT_S: f64 = 1.0 / 120.0;

    fn contact(depth_m: f64) -> Contact {
        let normal = DVec3::new(0.1, -0.2, 1.0).normalize();
        let place = (Body::Wheel(0), DVec3::ZERO, normal);
        Contact::new(&LAW, place, &Grip::rigid(normal, DT_S), depth_m, 1.0, DT_S)
    }

    #[test]
    fn a_still_point_feels_its_spring() {
        let c = contact(0.004);
        let impulse = c.impulse(DVec3::ZERO);
        assert!((impulse.length() - 8.0e6 * 0.004 * DT_S).abs() < 1e-9);
        assert_eq!(contact(-0.004).impulse(DVec3::ZERO), DVec3::ZERO);
    }

    #[test]
    fn friction_opposes_the_slip_and_stays_in_its_cone() {
        let c = contact(0.004);
        for slip in [1e-7, 1e-4, 1e-2, 1.0] {
            let along = c.normal.any_orthonormal_vector();
            let impulse = c.impulse(along * slip);
            let (normal, sideways) = (impulse.dot(c.normal), impulse.dot(along));
            assert!(sideways < 0.0);
            assert!(-sideways <= LAW.friction * normal * (1.0 + 1e-12));
        }
    }

    #[test]
    fn the_slope_is_the_derivative() {
        let c = contact(0.004);
        for velocity in
            [DVec3::new(1e-5, -2e-6, 0.01), DVec3::new(0.3, 0.1, -0.1), DVec3::new(0.0, 0.0, 5.0)]
        {
            let slope = c.slope(velocity, true);
            for axis in DVec3::AXES {
                let d = 1e-9;
                let change = c.impulse(velocity + axis * d) - c.impulse(velocity - axis * d);
                let want = -change / (2.0 * d);
                assert!((slope * axis - want).length() < 1e-4 * (1.0 + want.length()));
            }
        }
    }
}
