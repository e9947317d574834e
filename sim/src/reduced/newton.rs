//! The velocities at a step's end: Newton's method on the balance of impulses.
//!
//! Unknown are the 20 velocities; contacts, brakes and springs are functions of them, so the matrix
//! keeps the tree's sparsity however many contacts there are (as in Castro et al., An Unconstrained
//! Convex Formulation of Compliant Contact, 2023, but with Coulomb's cone itself instead of their
//! convex one, which lifts a sliding contact by dt mu v). While no contact changes between open,
//! sticking and sliding the balance is linear and one iteration solves it. It is solved to rounding,
//! so that what comes out is as smooth in every parameter as the laws are.

use super::contact::{Body, Contact};
use super::factor::{Factors, Matrix};
use super::pose::{ARMS, BodyInertias, FREEDOMS, Generalized, Pose, WHEELS, gather};
use super::spatial::{Spatial, Spatial6, ZERO6, add, add_at_point, dot, velocity_at, wrench_at};
use super::tree::Tree;
use crate::bodies::RollingDrag;

/// Residual at which the balance holds, as a velocity of the whole machine, m/s. Convergence is
/// quadratic, so the last iteration mostly ends orders below.
const TOLERANCE_M_S: f64 = 1.0e-9;
/// More iterations than any step of the tests takes.
const ITERATIONS_MAX: usize = 60;
/// From here on the matrix leaves out that sliding friction follows the normal force: slower, surer.
const CAUTIOUS_FROM: usize = 20;
/// Torque per creep of a holding brake, Nm s (assumed): as stiff as the contacts' friction.
const BRAKE_CREEP_NMS: f64 = 1.0e8;
/// Radius at which a front-frame torque counts as much as a force, m.
const MACHINE_RADIUS_M: f64 = 2.0;
/// What a hinge's torque moves at least, kg m²: half a wheel.
const HINGE_INERTIA_KG_M2: f64 = 100.0;

/// The dynamics of one step but for contacts and brakes.
pub(super) struct Balance<'a> {
    pub(super) pose: &'a Pose,
    pub(super) inertias: &'a BodyInertias<Spatial6>,
    /// Impulse that the velocities at the step's start lack, N s and Nm s.
    pub(super) lack: Generalized,
    /// Implicit springs and dampers of the hinges, times the step, kg m².
    pub(super) hinge: Generalized,
    /// Largest impulse of each wheel's brake, Nm s.
    pub(super) brake: [f64; 6],
    /// Rolling resistance of each wheel; [`Self::lack`] has what it was at the step's start.
    pub(super) drag: [Drag; 6],
    pub(super) dt_s: f64,
    pub(super) mass_kg: f64,
}

/// Rolling resistance over a step: its torque as of the step's start, and what becomes of it as the wheel
/// turns slower or faster. Steeper than a sliding wheel's own inertia, it is taken at the step's end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drag {
    /// Impulse that it comes to as the wheel turns faster, Nm s.
    most: f64,
    fade_rad_s: f64,
    /// Share of `most` in force at the step's start.
    start: f64,
}

impl Drag {
    /// That of `law` on a wheel that turns at `rate_rad_s` when the step begins.
    pub(super) fn new(law: &RollingDrag, rate_rad_s: f64, dt_s: f64) -> Self {
        if law.most_nm <= 0.0 {
            return Self { most: 0.0, fade_rad_s: 1.0, start: 0.0 };
        }
        let start = (rate_rad_s / law.fade_rad_s).tanh();
        Self { most: law.most_nm * dt_s, fade_rad_s: law.fade_rad_s, start }
    }

    /// Impulse beside that of the step's start on a wheel that turns at `rate_rad_s` at its end, Nm s.
    fn impulse(&self, rate_rad_s: f64) -> f64 {
        self.most * (self.start - (rate_rad_s / self.fade_rad_s).tanh())
    }

    /// Minus its derivative, kg m².
    fn slope(&self, rate_rad_s: f64) -> f64 {
        let share = (rate_rad_s / self.fade_rad_s).tanh();
        self.most / self.fade_rad_s * (1.0 - share * share)
    }
}

/// How the iteration ended.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Convergence {
    pub(super) iterations: usize,
    pub(super) residual_m_s: f64,
}

/// What an iteration writes over that of the last.
struct Work<'a> {
    matrix: Matrix<'a>,
    factors: Factors,
}

impl Balance<'_> {
    /// Moves `rate` from the step's start to its end. Contacts keep their final velocities.
    ///
    /// Contacts that are `held` are let go after the first iteration. Those that stuck in the last
    /// step should be: on uneven ground they start this one with a creep that reads as sliding.
    pub(super) fn solve(&self, rate: &mut Generalized, contacts: &mut [Contact]) -> Convergence {
        let mut smooth = self.lack;
        let mut work = Work {
            matrix: Matrix {
                hinge: self.hinge,
                frame: [ZERO6; 3],
                wheel: [ZERO6; 6],
                arm: &self.inertias.arm,
            },
            factors: Factors::new(),
        };
        self.set_velocities(rate, contacts);
        let mut report = Convergence::default();
        for iteration in 0..ITERATIONS_MAX {
            let residual = self.residual(&smooth, rate, contacts);
            report.residual_m_s = self.size_m_s(&residual);
            report.iterations = iteration;
            let held = contacts.iter().any(|contact| contact.held);
            if report.residual_m_s < TOLERANCE_M_S && !held {
                break;
            }
            let coupled = iteration < CAUTIOUS_FROM;
            let Some(step) = self.direction(&residual, rate, contacts, coupled, &mut work) else {
                break;
            };
            let change = self.smooth_change(&residual, &step, &work.matrix.hinge, contacts);
            let share = if held {
                1.0
            } else {
                self.search((&residual, &smooth), &change, &step, rate, contacts)
            };
            for k in 0..FREEDOMS {
                rate[k] += share * step[k];
                smooth[k] += share * change[k];
            }
            for contact in contacts.iter_mut() {
                contact.velocity += contact.step * share;
                contact.held = false;
            }
        }
        report
    }

    /// The Newton step. Leaves the contacts' share of it in them.
    fn direction(
        &self,
        residual: &Generalized,
        rate: &Generalized,
        contacts: &mut [Contact],
        coupled: bool,
        work: &mut Work<'_>,
    ) -> Option<Generalized> {
        self.fill(&mut work.matrix, rate, contacts, coupled);
        if work.factors.factor(self.pose, &mut work.matrix).is_some() {
            let step = work.factors.solve(self.pose, &residual.map(|r| -r));
            if !coupled || dot20(&step, residual) < 0.0 {
                self.set_steps(&step, contacts);
                return Some(step);
            }
        }
        // Friction that jams an arm has no descent with it; without it there always is one.
        if coupled { self.direction(residual, rate, contacts, false, work) } else { None }
    }

    /// Writes the derivative of the residual; the contacts keep their part of it.
    fn fill(
        &self,
        out: &mut Matrix<'_>,
        rate: &Generalized,
        contacts: &mut [Contact],
        coupled: bool,
    ) {
        out.hinge = self.hinge;
        out.frame = self.inertias.frame;
        out.wheel = self.inertias.wheel;
        for i in 0..6 {
            out.hinge[WHEELS + i] += self.brake_slope(i, rate);
        }
        for contact in contacts {
            contact.matrix = contact.slope(contact.velocity, coupled);
            let body = match contact.body {
                Body::Wheel(i) => &mut out.wheel[i],
                Body::Frame(i) => &mut out.frame[i],
            };
            add_at_point(body, &contact.matrix, contact.at);
        }
    }

    /// What the step changes of the residual without contacts and brakes: the matrix times the step
    /// is minus the residual, so only the contacts' part need be taken off again.
    fn smooth_change(
        &self,
        residual: &Generalized,
        step: &Generalized,
        hinge: &Generalized,
        contacts: &[Contact],
    ) -> Generalized {
        let mut change =
            self.generalised(contacts.iter().map(|c| (c.body, wrench_at(c.matrix * c.step, c.at))));
        for k in 0..FREEDOMS {
            let brake = hinge[k] - self.hinge[k];
            change[k] = -residual[k] - change[k] - brake * step[k];
        }
        change
    }

    fn residual(
        &self,
        smooth: &Generalized,
        rate: &Generalized,
        contacts: &[Contact],
    ) -> Generalized {
        let made = self
            .generalised(contacts.iter().map(|c| (c.body, wrench_at(c.impulse(c.velocity), c.at))));
        let mut out = *smooth;
        for k in 0..FREEDOMS {
            out[k] -= made[k];
        }
        for i in 0..6 {
            out[WHEELS + i] -= self.brake_impulse(i, rate[WHEELS + i]);
        }
        out
    }

    /// How far along `step` to go: all the way, or to where the residual no longer points onward.
    /// In a convex problem that is the exact minimum along the line, and makes Newton's method safe.
    fn search(
        &self,
        (residual, smooth): (&Generalized, &Generalized),
        change: &Generalized,
        step: &Generalized,
        rate: &Generalized,
        contacts: &[Contact],
    ) -> f64 {
        let (constant, slope) = (dot20(step, smooth), dot20(step, change));
        let onward = |share: f64| {
            let contacts: f64 =
                contacts.iter().map(|c| c.step.dot(c.impulse(c.velocity + c.step * share))).sum();
            let brake = |i: usize| {
                let k = WHEELS + i;
                step[k] * self.brake_impulse(i, rate[k] + share * step[k])
            };
            let brakes: f64 = (0..6).map(brake).sum();
            constant + share * slope - contacts - brakes
        };
        let start = dot20(step, residual);
        let enough = 0.1 * start.abs();
        let (mut low, mut at_low, mut high, mut at_high) = (0.0, start, 1.0, onward(1.0));
        if at_high <= enough.max(f64::MIN_POSITIVE) || start >= 0.0 {
            return 1.0;
        }
        // False position, Illinois variant.
        for _ in 0..20 {
            let share = (low * at_high - high * at_low) / (at_high - at_low);
            let at = onward(share);
            if at.abs() <= enough {
                return share;
            }
            if at < 0.0 {
                (low, at_low, at_high) = (share, at, at_high * 0.5);
            } else {
                (high, at_high, at_low) = (share, at, at_low * 0.5);
            }
        }
        low.max(f64::EPSILON)
    }

    /// Wrenches on bodies as forces on the freedoms.
    fn generalised(&self, wrenches: impl Iterator<Item = (Body, Spatial)>) -> Generalized {
        let (mut on_wheel, mut on_frame) = ([[0.0; 6]; 6], [[0.0; 6]; 3]);
        for (body, wrench) in wrenches {
            match body {
                Body::Wheel(i) => add(&mut on_wheel[i], &wrench),
                Body::Frame(i) => add(&mut on_frame[i], &wrench),
            }
        }
        generalised(self.pose, &on_wheel, on_frame)
    }

    fn set_velocities(&self, rate: &Generalized, contacts: &mut [Contact]) {
        let twists = Twists::new(self.pose, rate);
        for contact in contacts {
            contact.velocity = velocity_at(twists.of(contact.body), contact.at);
        }
    }

    fn set_steps(&self, step: &Generalized, contacts: &mut [Contact]) {
        let twists = Twists::new(self.pose, step);
        for contact in contacts {
            contact.step = velocity_at(twists.of(contact.body), contact.at);
        }
    }

    /// Impulse of brake and rolling resistance about the axle of wheel `i`, Nm s.
    fn brake_impulse(&self, i: usize, rate_rad_s: f64) -> f64 {
        let brake = (BRAKE_CREEP_NMS * self.dt_s * rate_rad_s).clamp(-self.brake[i], self.brake[i]);
        self.drag[i].impulse(rate_rad_s) - brake
    }

    fn brake_slope(&self, i: usize, rate: &Generalized) -> f64 {
        let rate_rad_s = rate[WHEELS + i];
        let slope = BRAKE_CREEP_NMS * self.dt_s;
        let brake = if slope * rate_rad_s.abs() < self.brake[i] { slope } else { 0.0 };
        brake + self.drag[i].slope(rate_rad_s)
    }

    fn size_m_s(&self, residual: &Generalized) -> f64 {
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
