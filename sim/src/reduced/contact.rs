//! The law of a contact within one step: a spring and damper that only pushes, and Coulomb friction.
//!
//! Implicit: the impulse is a function of the velocity at the step's end. A tyre's force is
//! max(0, k d - c s d') with the depth d where the step ends: none in the air. The share s of the damper rises from
//! none where the ground is touched to all of it at [`DAMPED_AT_M`], which makes the force continuous
//! when a wheel comes down, and it falls with the velocity at any depth, so that there is one solution.
//! Friction is isotropic, at most mu times the normal force. What it is below that is the
//! contact's [`Grip`]: springs of a tyre's patch, or a creep in proportion to the force, as every
//! solver of rigid friction must let it or not know its force.

use glam::DVec3;

use super::spatial::{Spatial, Spatial6, ZERO, add_scaled, dot, wrench_at};

/// Sideways force per creep while a rigid contact sticks, N s/m (assumed): 10 kN creep 0.1 mm/s.
const CREEP_N_S_M: f64 = 1.0e8;

/// Depth from which on a contact's damping is in full, m (assumed): half of what a nominal tyre gives at rest.
const DAMPED_AT_M: f64 = 2.0e-3;

/// A spring and damper normal to the ground, and its friction.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactLaw {
    pub(super) stiffness_n_m: f64,
    pub(super) damping_n_s_m: f64,
    pub(super) friction: f64,
}

/// A vector along a contact's axes: out of the ground first, then two directions along it.
pub(super) type Local = [f64; 3];

/// Sideways impulse against a velocity of the point, as far as friction carries it:
/// hold + stick velocity, along two directions that are square to the normal and to one another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grip {
    pub(super) along: [DVec3; 2],
    /// Impulse on the ground at no velocity, N s.
    pub(super) hold: [f64; 2],
    /// Its growth with the velocity, kg.
    pub(super) stick: [f64; 2],
}

impl Grip {
    /// A rigid contact's, on ground that shears by `creep_m_s_n` for every newton.
    pub(super) const fn rigid(along: [DVec3; 2], creep_m_s_n: f64, dt_s: f64) -> Self {
        let stick_n_s_m = CREEP_N_S_M / (1.0 + CREEP_N_S_M * creep_m_s_n);
        Self { along, hold: [0.0; 2], stick: [stick_n_s_m * dt_s; 2] }
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

/// What a contact makes at one velocity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Made {
    pub(super) velocity_m_s: Local,
    /// On the body, N s.
    pub(super) impulse: Local,
    /// Normal impulse that a normal velocity takes away, kg.
    slope: f64,
    pub(super) hold: Hold,
}

/// A point of a body at the ground, ready for the step's solver.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    pub(super) body: Body,
    /// Out of the ground, and the two directions of the grip.
    pub(super) axes: [DVec3; 3],
    /// Wrenches of unit forces along the axes about the front frame's origin.
    wrench: [Spatial; 3],
    /// Depth when the step begins, m.
    depth_m: f64,
    dt_s: f64,
    /// Normal impulse per depth where the step ends, N s/m.
    spring: f64,
    /// Normal impulse per velocity of one that is damped in full, kg.
    damper: f64,
    hold: [f64; 2],
    stick: [f64; 2],
    friction: f64,
    /// Share of the law that this contact is of.
    pub(super) weight: f64,
    /// Taken to stick however much force that needs: a first guess.
    pub(super) held: bool,
    /// At the solver's present guess.
    pub(super) now: Made,
    /// At the guess that is tried.
    next: Made,
    /// What the solver's present step would add to the velocity, m/s.
    step: Local,
    /// What it would take from the impulse if the law were linear, N s.
    taken: Local,
    /// Minus the derivative of the impulse at a guess by columns, kg, and what it did there.
    matrix: [Local; 3],
    derived: Hold,
    /// By how much the impulse tried is not the one foreseen, N s.
    pub(super) missed: Local,
}

impl Contact {
    /// `weight`, 0 to 1, is the share of the law that this contact is of; `at` is from the front frame's
    /// origin.
    pub(super) fn new(
        law: &ContactLaw,
        (body, at, normal): (Body, DVec3, DVec3),
        grip: &Grip,
        depth_m: f64,
        weight: f64,
        dt_s: f64,
    ) -> Self {
        let axes = [normal, grip.along[0], grip.along[1]];
        let none = Made { velocity_m_s: [0.0; 3], impulse: [0.0; 3], slope: 0.0, hold: Hold::Open };
        Self {
            body,
            axes,
            wrench: axes.map(|axis| wrench_at(axis, at)),
            depth_m,
            dt_s,
            spring: law.stiffness_n_m * dt_s * weight,
            damper: law.damping_n_s_m * dt_s * weight,
            hold: grip.hold.map(|hold| hold * weight),
            stick: grip.stick.map(|stick| stick * weight),
            friction: law.friction,
            weight,
            held: false,
            now: none,
            next: none,
            step: [0.0; 3],
            taken: [0.0; 3],
            matrix: [[0.0; 3]; 3],
            derived: Hold::Open,
            missed: [0.0; 3],
        }
    }

    /// What it makes at a velocity of its point.
    #[inline]
    fn made(&self, velocity_m_s: Local) -> Made {
        let [out, v1, v2] = velocity_m_s;
        let end_m = self.depth_m - self.dt_s * out;
        let (share, deepens) = if end_m < DAMPED_AT_M {
            (end_m / DAMPED_AT_M, self.dt_s / DAMPED_AT_M)
        } else {
            (1.0, 0.0)
        };
        let normal = self.spring * end_m - self.damper * share * out;
        if end_m <= 0.0 || normal <= 0.0 {
            return Made { velocity_m_s, impulse: [0.0; 3], slope: 0.0, hold: Hold::Open };
        }
        let slope = self.spring * self.dt_s + self.damper * (share - deepens * out);
        let grip = [self.hold[0] + self.stick[0] * v1, self.hold[1] + self.stick[1] * v2];
        let (size2, most) = (grip[0] * grip[0] + grip[1] * grip[1], self.friction * normal);
        if size2 <= most * most || self.held {
            return Made {
                velocity_m_s,
                impulse: [normal, -grip[0], -grip[1]],
                slope,
                hold: Hold::Sticks,
            };
        }
        let share = most / size2.sqrt();
        let impulse = [normal, -grip[0] * share, -grip[1] * share];
        Made { velocity_m_s, impulse, slope, hold: Hold::Slides }
    }

    /// Minus the derivative of its impulse at the present guess by columns, kg. With `coupled` false,
    /// sliding friction is taken as if it did not follow the normal force.
    #[inline]
    fn derivative(&self, coupled: bool) -> [Local; 3] {
        let [k1, k2] = self.stick;
        match self.now.hold {
            Hold::Open => [[0.0; 3]; 3],
            Hold::Sticks => [[self.now.slope, 0.0, 0.0], [0.0, k1, 0.0], [0.0, 0.0, k2]],
            Hold::Slides => {
                let [_, v1, v2] = self.now.velocity_m_s;
                let (g1, g2) = (self.hold[0] + k1 * v1, self.hold[1] + k2 * v2);
                let per_size = 1.0 / (g1 * g1 + g2 * g2).sqrt();
                let (e1, e2) = (g1 * per_size, g2 * per_size);
                let share = self.friction * self.now.impulse[0] * per_size;
                let follows = if coupled { -self.friction * self.now.slope } else { 0.0 };
                [
                    [self.now.slope, follows * e1, follows * e2],
                    [0.0, share * e2 * e2 * k1, -share * e1 * e2 * k1],
                    [0.0, -share * e1 * e2 * k2, share * e1 * e1 * k2],
                ]
            }
        }
    }

    /// Velocity of its point on a body with this twist.
    #[inline]
    fn velocity_on(&self, twist: &Spatial) -> Local {
        let [out, one, two] = &self.wrench;
        [dot(out, twist), dot(one, twist), dot(two, twist)]
    }

    /// Takes the body's twist as the present guess.
    #[inline]
    pub(super) fn guess(&mut self, twist: &Spatial) {
        self.now = self.made(self.velocity_on(twist));
    }

    /// Takes the derivative at the present guess; false if it is what it was.
    #[inline]
    pub(super) fn derive(&mut self, coupled: bool) -> bool {
        let before = self.matrix;
        self.matrix = self.derivative(coupled);
        self.derived = self.now.hold;
        self.matrix != before
    }

    /// Whether it does what it did where the derivative was taken.
    pub(super) fn holds_as_derived(&self) -> bool {
        self.derived == self.now.hold
    }

    /// Takes what the solver would add to the body's twist.
    #[inline]
    pub(super) fn set_step(&mut self, twist: &Spatial) {
        self.step = self.velocity_on(twist);
        let ([a, b, c], [x, y, z]) = (&self.matrix, self.step);
        self.taken = core::array::from_fn(|i| a[i] * x + b[i] * y + c[i] * z);
    }

    /// Looks at `share` of the step; how much what was missed there works along it.
    #[inline]
    pub(super) fn try_share(&mut self, share: f64) -> f64 {
        self.next =
            self.made(core::array::from_fn(|i| self.now.velocity_m_s[i] + share * self.step[i]));
        let mut work = 0.0;
        for i in 0..3 {
            self.missed[i] = self.now.impulse[i] - share * self.taken[i] - self.next.impulse[i];
            work += self.step[i] * self.missed[i];
        }
        work
    }

    /// Makes what was tried the present guess.
    #[inline]
    pub(super) const fn take(&mut self) {
        self.now = self.next;
    }

    /// The wrench of an impulse along its axes.
    #[inline]
    pub(super) fn wrench_of(&self, impulse: &Local) -> Spatial {
        let mut wrench = ZERO;
        for (axis, along) in self.wrench.iter().zip(impulse) {
            add_scaled(&mut wrench, axis, *along);
        }
        wrench
    }

    /// Adds the derivative to the matrix of the body.
    #[inline]
    pub(super) fn add_to(&self, body: &mut Spatial6) {
        if self.now.hold == Hold::Open {
            return;
        }
        let [[out, one, two], [_, b1, b2], [_, c1, c2]] = self.matrix;
        let [normal, first, second] = &self.wrench;
        // Only the normal velocity changes the normal impulse.
        let along =
            |a: f64, b: f64| -> Spatial { core::array::from_fn(|i| a * first[i] + b * second[i]) };
        let mut columns = [along(one, two), along(b1, b2), along(c1, c2)];
        add_scaled(&mut columns[0], normal, out);
        for (j, out) in body.iter_mut().enumerate() {
            for (column, wrench) in columns.iter().zip(&self.wrench) {
                add_scaled(out, column, wrench[j]);
            }
        }
    }

    /// The impulse on the body at the present guess, N s.
    pub(super) fn impulse(&self) -> DVec3 {
        let ([out, one, two], [n, a, b]) = (self.axes, self.now.impulse);
        out * n + one * a + two * b
    }

    /// Its moment about the front frame's origin, N m s.
    #[cfg(test)]
    pub(super) fn moment(&self) -> DVec3 {
        let each = self.wrench.iter().zip(self.now.impulse);
        each.map(|(wrench, impulse)| super::spatial::angular(wrench) * impulse).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::spatial::{ZERO6, apply, velocity_at};
    use super::*;

    const LAW: ContactLaw =
        ContactLaw { stiffness_n_m: 8.0e6, damping_n_s_m: 6.0e4, friction: 0.7 };
    const DT_S: f64 = 1.0 / 120.0;

    fn contact(depth_m: f64) -> Contact {
        let normal = DVec3::new(0.1, -0.2, 1.0).normalize();
        let (one, two) = normal.any_orthonormal_pair();
        let grip = Grip { stick: [8e5, 5e5], ..Grip::rigid([one, two], 0.0, DT_S) };
        Contact::new(&LAW, (Body::Wheel(0), DVec3::ZERO, normal), &grip, depth_m, 1.0, DT_S)
    }

    #[test]
    fn a_still_point_feels_its_spring() {
        let made = contact(0.004).made([0.0; 3]);
        assert!((made.impulse[0] - 8.0e6 * 0.004 * DT_S).abs() < 1e-9);
        assert_eq!(contact(-0.004).made([0.0; 3]).impulse, [0.0; 3]);
    }

    #[test]
    fn friction_opposes_the_slip_and_stays_in_its_cone() {
        let c = contact(0.004);
        for slip in [1e-7, 1e-4, 1e-2, 1.0] {
            let [normal, sideways, _] = c.made([0.0, slip, 0.0]).impulse;
            assert!(sideways < 0.0);
            assert!(-sideways <= LAW.friction * normal * (1.0 + 1e-12));
        }
    }

    #[test]
    fn the_derivative_is_that_of_the_impulse() {
        let mut c = contact(0.004);
        for velocity in [[1e-5, -2e-6, 3e-6], [0.03, 0.1, -0.2], [5.0, 0.0, 0.0]] {
            c.now = c.made(velocity);
            let columns = c.derivative(true);
            for (axis, column) in columns.iter().enumerate() {
                let d = 1e-9;
                let impulse = |d: f64| {
                    let mut at = velocity;
                    at[axis] += d;
                    c.made(at).impulse
                };
                let (up, down) = (impulse(d), impulse(-d));
                for i in 0..3 {
                    let want = (down[i] - up[i]) / (2.0 * d);
                    assert!((column[i] - want).abs() < 1e-4 * (1.0 + want.abs()), "{velocity:?}");
                }
            }
        }
    }

    #[test]
    fn the_matrix_of_a_body_acts_on_the_velocity_of_its_point() {
        let at = DVec3::new(0.3, -1.2, 0.8);
        let twist = [0.4, -0.2, 0.9, 1.0, 2.0, -0.5];
        let place = |c: Contact| (c.body, at, c.axes[0]);
        let held = contact(0.004);
        let grip =
            Grip { stick: [8e5, 5e5], ..Grip::rigid([held.axes[1], held.axes[2]], 0.0, DT_S) };
        let mut c = Contact::new(&LAW, place(held), &grip, 0.4, 1.0, DT_S);
        c.guess(&twist);
        assert_eq!(c.now.hold, Hold::Slides);
        assert!(c.derive(true) && !c.derive(true));
        let velocity = velocity_at(&twist, at);
        for (axis, along) in c.axes.iter().zip(c.now.velocity_m_s) {
            assert!((axis.dot(velocity) - along).abs() < 1e-12);
        }
        c.set_step(&twist);
        let mut m = ZERO6;
        c.add_to(&mut m);
        let [n, a, b] = [0, 1, 2].map(|i| c.axes[i] * c.taken[i]);
        let want = wrench_at(n + a + b, at);
        for (got, want) in apply(&m, &twist).iter().zip(want) {
            assert!((got - want).abs() < 1e-9 * want.abs().max(1.0), "{got}, not {want}");
        }
    }
}
