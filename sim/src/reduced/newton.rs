//! The velocities at a step's end: Newton's method on the balance of impulses.
//!
//! Unknown are the 20 velocities; contacts, brakes and springs are functions of them, so the matrix
//! keeps the tree's sparsity however many contacts there are (as in Castro et al., An Unconstrained
//! Convex Formulation of Compliant Contact, 2023, but with Coulomb's cone itself instead of their
//! convex one, which lifts a sliding contact by dt mu v). While no contact changes between open,
//! sticking and sliding the balance is linear and one iteration solves it. It is solved to rounding,
//! so that what comes out is as smooth in every parameter as the laws are.
//!
//! All but contacts and axles is linear. So after a step of the iteration nothing is out of balance but
//! what they made otherwise than their derivatives had foreseen, and that alone is summed up.

use super::axle::Axle;
use super::contact::{Body, Contact};
use super::factor::Factors;
use super::pose::{ARMS, BodyInertias, FREEDOMS, Generalized, Pose, WHEELS, gather};
use super::spatial::{Spatial, Spatial6, ZERO, add, dot};
use super::tree::Tree;

/// Residual at which the balance holds, as a velocity of the whole machine, m/s. Convergence is
/// quadratic, so the last iteration mostly ends orders below.
const TOLERANCE_M_S: f64 = 1.0e-9;
/// More iterations than any step of the tests takes.
const ITERATIONS_MAX: usize = 60;
/// From here on the matrix leaves out that sliding friction follows the normal force: slower, surer.
const CAUTIOUS_FROM: usize = 20;
/// Below this residual factors of an iteration ago are near enough, m/s: a step with them costs a third, and
/// leaves about this share of the residual.
const NEAR_M_S: f64 = 1.0e-4;
/// Radius at which a front-frame torque counts as much as a force, m.
const MACHINE_RADIUS_M: f64 = 2.0;
/// What a hinge's torque moves at least, kg m²: half a wheel.
const HINGE_INERTIA_KG_M2: f64 = 100.0;

/// The dynamics of one step but for contacts.
pub(super) struct Balance<'a> {
    pub(super) pose: &'a Pose,
    pub(super) inertias: &'a BodyInertias,
    /// Impulse that the velocities at the step's start lack, N s and Nm s.
    pub(super) lack: Generalized,
    /// Implicit springs and dampers of the hinges, times the step, kg m².
    pub(super) hinge: Generalized,
    /// Brakes and rolling resistance; [`Self::lack`] has what that was at the step's start.
    pub(super) axles: [Axle; 6],
    pub(super) mass_kg: f64,
}

/// How the iteration ended.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Convergence {
    pub(super) iterations: usize,
    pub(super) residual_m_s: f64,
}

impl Balance<'_> {
    /// Moves `rate` from the step's start to its end. Contacts keep what they make there.
    ///
    /// Contacts that are `held` are let go after the first iteration. Those that stuck in the last
    /// step should be: on uneven ground they start this one with a creep that reads as sliding.
    pub(super) fn solve(
        &mut self,
        rate: &mut Generalized,
        contacts: &mut [Contact],
        factors: &mut Factors,
    ) -> Convergence {
        factors.forget();
        let twists = Twists::new(self.pose, rate);
        for contact in contacts.iter_mut() {
            contact.guess(twists.of(contact.body));
        }
        let made = self.generalised(contacts, |c| &c.now.impulse, Axle::impulse);
        let mut residual: Generalized = core::array::from_fn(|k| self.lack[k] - made[k]);
        let mut report = Convergence::default();
        let mut last_m_s = f64::INFINITY;
        for iteration in 0..ITERATIONS_MAX {
            report.residual_m_s = self.size_m_s(&residual);
            report.iterations = iteration;
            let held = contacts.iter().any(|contact| contact.held);
            if report.residual_m_s < TOLERANCE_M_S && !held {
                break;
            }
            let coupled = iteration < CAUTIOUS_FROM;
            let near = report.residual_m_s < NEAR_M_S.min(0.1 * last_m_s)
                && contacts.iter().all(Contact::holds_as_derived);
            last_m_s = report.residual_m_s;
            let step = if near { self.step(&residual, contacts, factors) } else { None };
            let step = step.or_else(|| self.direction(&residual, contacts, coupled, factors));
            let Some(step) = step else {
                break;
            };
            let share = if held {
                contacts.iter_mut().for_each(|contact| contact.held = false);
                self.try_share(1.0, contacts);
                1.0
            } else {
                self.search(dot20(&step, &residual), contacts)
            };
            contacts.iter_mut().for_each(Contact::take);
            self.axles.iter_mut().for_each(Axle::take);
            let missed = self.generalised(contacts, |c| &c.missed, |axle| axle.missed);
            for k in 0..FREEDOMS {
                rate[k] += share * step[k];
                residual[k] = (1.0 - share) * residual[k] + missed[k];
            }
        }
        report
    }

    /// The Newton step. Leaves their share of it in contacts and axles.
    fn direction(
        &mut self,
        residual: &Generalized,
        contacts: &mut [Contact],
        coupled: bool,
        factors: &mut Factors,
    ) -> Option<Generalized> {
        if self.factor(contacts, coupled, factors).is_some() {
            let step = self.step(residual, contacts, factors);
            if step.is_some() {
                return step;
            }
        }
        factors.forget();
        // Friction that jams an arm has no descent with it; without it there always is one.
        if coupled { self.direction(residual, contacts, false, factors) } else { None }
    }

    /// The step with these factors, if it leads down.
    fn step(
        &mut self,
        residual: &Generalized,
        contacts: &mut [Contact],
        factors: &Factors,
    ) -> Option<Generalized> {
        let step = factors.solve(self.pose, &residual.map(|r| -r));
        let onward = dot20(&step, residual);
        if onward.is_nan() || onward > 0.0 {
            return None;
        }
        let twists = Twists::new(self.pose, &step);
        for contact in contacts.iter_mut() {
            contact.set_step(twists.of(contact.body));
        }
        for (axle, step_rad_s) in self.axles.iter_mut().zip(&step[WHEELS..]) {
            axle.set_step(*step_rad_s);
        }
        Some(step)
    }

    /// Factors the derivative of the residual. Of wheels on which nothing changed since the last time the
    /// factors are left as they are.
    fn factor(
        &mut self,
        contacts: &mut [Contact],
        coupled: bool,
        factors: &mut Factors,
    ) -> Option<()> {
        let mut changed = [false; 6];
        for contact in contacts.iter_mut() {
            if contact.derive(coupled)
                && let Body::Wheel(i) = contact.body
            {
                changed[i] = true;
            }
        }
        let mut hinge = self.hinge;
        for (i, changed) in changed.into_iter().enumerate() {
            hinge[WHEELS + i] += self.axles[i].derive();
            if changed || factors.wheel_stiffening(i) != Some(hinge[WHEELS + i]) {
                let both = |out: &mut Spatial6| {
                    *out = self.inertias.arm[i];
                    for contact in contacts.iter().filter(|c| c.body == Body::Wheel(i)) {
                        contact.add_to(out);
                    }
                };
                factors.take_wheel(self.pose, i, both, &self.inertias.arm_column[i], &hinge)?;
            }
        }
        let mut frame = self.inertias.frame;
        for contact in contacts.iter() {
            if let Body::Frame(i) = contact.body {
                contact.add_to(&mut frame[i]);
            }
        }
        factors.take_frames(self.pose, frame, &hinge)
    }

    /// Looks at `share` of the step; how much what was missed there works along it.
    fn try_share(&mut self, share: f64, contacts: &mut [Contact]) -> f64 {
        let by_contacts: f64 = contacts.iter_mut().map(|contact| contact.try_share(share)).sum();
        let by_axles: f64 = self.axles.iter_mut().map(|axle| axle.try_share(share)).sum();
        by_contacts + by_axles
    }

    /// How far along the step to go: all the way, or to where the residual no longer points onward.
    /// In a convex problem that is the exact minimum along the line, and makes Newton's method safe.
    /// `start` is the residual along the step where it begins.
    fn search(&mut self, start: f64, contacts: &mut [Contact]) -> f64 {
        let enough = 0.1 * start.abs();
        let (mut low, mut at_low, mut high) = (0.0, start, 1.0);
        let mut at_high = self.try_share(1.0, contacts);
        if at_high <= enough.max(f64::MIN_POSITIVE) || start >= 0.0 {
            return 1.0;
        }
        // False position, Illinois variant.
        for _ in 0..20 {
            let share = (low * at_high - high * at_low) / (at_high - at_low);
            let at = (1.0 - share) * start + self.try_share(share, contacts);
            if at.abs() <= enough {
                return share;
            }
            if at < 0.0 {
                (low, at_low, at_high) = (share, at, at_high * 0.5);
            } else {
                (high, at_high, at_low) = (share, at, at_low * 0.5);
            }
        }
        let share = low.max(f64::EPSILON);
        self.try_share(share, contacts);
        share
    }

    /// Impulses of contacts and axles as impulses on the freedoms.
    fn generalised(
        &self,
        contacts: &[Contact],
        of_contact: impl Fn(&Contact) -> &[f64; 3],
        of_axle: impl Fn(&Axle) -> f64,
    ) -> Generalized {
        let (mut on_wheel, mut on_frame) = ([ZERO; 6], [ZERO; 3]);
        for contact in contacts {
            let wrench = contact.wrench_of(of_contact(contact));
            match contact.body {
                Body::Wheel(i) => add(&mut on_wheel[i], &wrench),
                Body::Frame(i) => add(&mut on_frame[i], &wrench),
            }
        }
        let mut out = generalised(self.pose, &on_wheel, on_frame);
        for (out, axle) in out[WHEELS..].iter_mut().zip(&self.axles) {
            *out += of_axle(axle);
        }
        out
    }

    /// What is out of balance, as a velocity of the whole machine, m/s.
    pub(super) fn size_m_s(&self, residual: &Generalized) -> f64 {
        let torque: f64 = residual[..3].iter().map(|r| r * r).sum();
        let force: f64 = residual[3..6].iter().map(|r| r * r).sum();
        let hinges: f64 = residual[6..].iter().map(|r| r * r).sum();
        let radius = MACHINE_RADIUS_M * MACHINE_RADIUS_M;
        let energy = (force + torque / radius) / self.mass_kg + hinges / HINGE_INERTIA_KG_M2;
        (energy / self.mass_kg).sqrt()
    }
}

/// Wrenches on wheels and frames as forces on the freedoms.
pub(super) fn generalised(
    pose: &Pose,
    on_wheel: &[Spatial; 6],
    mut on_frame: [Spatial; 3],
) -> Generalized {
    let mut out = [0.0; FREEDOMS];
    for (i, wrench) in on_wheel.iter().enumerate() {
        out[WHEELS + i] = dot(&pose.arm[i].wheel_axis, wrench);
        out[ARMS + i] = dot(&pose.arm[i].arm_axis, wrench);
        add(&mut on_frame[Tree::frame_of(i)], wrench);
    }
    gather(pose, &mut on_frame, &mut out);
    out
}

struct Twists {
    frame: [Spatial; 3],
    wheel: [Spatial; 6],
}

impl Twists {
    fn new(pose: &Pose, rate: &Generalized) -> Self {
        let frame = pose.frame_twists(rate);
        let wheel = core::array::from_fn(|i| {
            let arm = pose.arm_twist(i, &frame[Tree::frame_of(i)], rate);
            pose.wheel_twist(i, &arm, rate)
        });
        Self { frame, wheel }
    }

    const fn of(&self, body: Body) -> &Spatial {
        match body {
            Body::Wheel(i) => &self.wheel[i],
            Body::Frame(i) => &self.frame[i],
        }
    }
}

fn dot20(a: &Generalized, b: &Generalized) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
