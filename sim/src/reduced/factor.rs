//! The tree's mass matrix with whatever stiffens it, factored from the wheels to the front frame.
//!
//! The vehicle's tree is fixed: wheel on arm, arm on frame, frame behind frame. Eliminating each
//! hinge leaves a rank-one change of its parent's spatial matrix (the articulated-body recursion,
//! Featherstone chapter 7), so the whole matrix is never formed. What a contact adds acts on one
//! body alone and joins that body's spatial matrix. Sliding friction follows the normal force but
//! not the reverse, so the matrices are not symmetric and rows and columns are kept apart.

use super::pose::{ARMS, FREEDOMS, Generalized, JOINTS, Pose, ROLL, WHEELS};
use super::spatial::{
    Spatial, Spatial6, ZERO, ZERO6, add, add_scaled, add6, apply, apply_transposed, dot,
    take_rank_one,
};
use super::tree::Tree;

/// A hinge that was eliminated.
#[derive(Clone, Copy, Debug)]
struct Pivot {
    column: Spatial,
    row: Spatial,
    inverse: f64,
}

/// The factors.
#[derive(Clone, Debug)]
pub(super) struct Factors {
    pivot: [Pivot; FREEDOMS - 6],
    /// What each wheel with its arm is to its frame.
    handed: [Spatial6; 6],
    /// What stiffens each wheel's own hinge; nothing where it was not taken yet.
    stiffening: [Option<f64>; 6],
    root: Spatial6,
}

impl Factors {
    /// Nothing factored yet.
    pub(super) const fn new() -> Self {
        let none = Pivot { column: ZERO, row: ZERO, inverse: 0.0 };
        Self { pivot: [none; FREEDOMS - 6], handed: [ZERO6; 6], stiffening: [None; 6], root: ZERO6 }
    }

    /// What stiffens the hinge of wheel `i` in these factors, kg m²; `None` where it was not taken yet.
    pub(super) const fn wheel_stiffening(&self, i: usize) -> Option<f64> {
        self.stiffening[i]
    }

    /// Takes nothing of these factors for the next.
    pub(super) const fn forget(&mut self) {
        self.stiffening = [None; 6];
    }

    /// Eliminates wheel `i` and its arm: the matrix of both on their twist, contacts among it, and those of
    /// the freedoms' own rates (implicit springs, dampers, brakes, times the step, kg m²; the first six
    /// have none). `None` if there is no positive pivot, which friction that jams an arm can do.
    ///
    /// `both` writes that matrix; `arm_column` is the arm's alone times the wheel's twist against it.
    #[inline]
    pub(super) fn take_wheel(
        &mut self,
        pose: &Pose,
        i: usize,
        both: impl FnOnce(&mut Spatial6),
        arm_column: &Spatial,
        hinge: &Generalized,
    ) -> Option<()> {
        self.stiffening[i] = None;
        let (body, at) = (&mut self.handed[i], &pose.arm[i]);
        both(body);
        self.pivot[WHEELS + i - 6] =
            eliminate(body, &at.wheel_axis, hinge[WHEELS + i], arm_column)?;
        self.pivot[ARMS + i - 6] = eliminate(body, &at.arm_axis, hinge[ARMS + i], &ZERO)?;
        self.stiffening[i] = Some(hinge[WHEELS + i]);
        Some(())
    }

    /// Eliminates the frames, given their own matrices, after all wheels.
    pub(super) fn take_frames(
        &mut self,
        pose: &Pose,
        mut frame: [Spatial6; 3],
        hinge: &Generalized,
    ) -> Option<()> {
        for (i, handed) in self.handed.iter().enumerate() {
            add6(&mut frame[Tree::frame_of(i)], handed);
        }
        let pivot = &mut self.pivot;
        for i in (0..2).rev() {
            let k = JOINTS + i;
            let (ahead, behind) = frame.split_at_mut(i + 1);
            pivot[k - 6] = eliminate(&mut behind[0], &pose.joint_axis[i], hinge[k], &ZERO)?;
            if let (0, Some(axis)) = (i, &pose.roll_axis) {
                pivot[ROLL - 6] = eliminate(&mut behind[0], axis, hinge[ROLL], &ZERO)?;
            }
            add6(&mut ahead[i], &behind[0]);
        }
        self.root = frame[0];
        factor_root(&mut self.root)
    }

    /// The velocities `x` with (matrix) x = `right`.
    pub(super) fn solve(&self, pose: &Pose, right: &Generalized) -> Generalized {
        let mut out = *right;
        // Wrenches that the eliminated hinges hand to their parents.
        let mut on_frame = [[0.0; 6]; 3];
        for i in 0..6 {
            let wheel = &self.pivot[WHEELS + i - 6];
            let mut handed = [0.0; 6];
            add_scaled(&mut handed, &wheel.column, out[WHEELS + i] * wheel.inverse);
            let arm = &self.pivot[ARMS + i - 6];
            out[ARMS + i] -= dot(&pose.arm[i].arm_axis, &handed);
            add_scaled(&mut handed, &arm.column, out[ARMS + i] * arm.inverse);
            add(&mut on_frame[Tree::frame_of(i)], &handed);
        }
        for i in (0..2).rev() {
            let joint = &self.pivot[JOINTS + i - 6];
            let mut handed = on_frame[i + 1];
            out[JOINTS + i] -= dot(&pose.joint_axis[i], &handed);
            add_scaled(&mut handed, &joint.column, out[JOINTS + i] * joint.inverse);
            if let (0, Some(axis)) = (i, &pose.roll_axis) {
                let roll = &self.pivot[ROLL - 6];
                out[ROLL] -= dot(axis, &handed);
                add_scaled(&mut handed, &roll.column, out[ROLL] * roll.inverse);
            }
            add(&mut on_frame[i], &handed);
        }
        let mut twist = [[0.0; 6]; 3];
        twist[0].copy_from_slice(&out[..6]);
        for (twist, handed) in twist[0].iter_mut().zip(&on_frame[0]) {
            *twist -= handed;
        }
        solve_root(&self.root, &mut twist[0]);
        out[..6].copy_from_slice(&twist[0]);
        for i in 0..2 {
            let joint = &self.pivot[JOINTS + i - 6];
            twist[i + 1] = twist[i];
            if let (0, Some(axis)) = (i, &pose.roll_axis) {
                let roll = &self.pivot[ROLL - 6];
                out[ROLL] = (out[ROLL] - dot(&roll.row, &twist[0])) * roll.inverse;
                add_scaled(&mut twist[1], axis, out[ROLL]);
            }
            let rate = (out[JOINTS + i] - dot(&joint.row, &twist[i + 1])) * joint.inverse;
            out[JOINTS + i] = rate;
            add_scaled(&mut twist[i + 1], &pose.joint_axis[i], rate);
        }
        for i in 0..6 {
            let (arm, wheel) = (&self.pivot[ARMS + i - 6], &self.pivot[WHEELS + i - 6]);
            let mut twist = twist[Tree::frame_of(i)];
            let rate = (out[ARMS + i] - dot(&arm.row, &twist)) * arm.inverse;
            out[ARMS + i] = rate;
            add_scaled(&mut twist, &pose.arm[i].arm_axis, rate);
            out[WHEELS + i] = (out[WHEELS + i] - dot(&wheel.row, &twist)) * wheel.inverse;
        }
        out
    }
}

/// Takes a hinge out of a body's matrix; what is left is what its parent feels. `apart` is how much of
/// the matrix does not move with the hinge, times its axis.
#[inline]
fn eliminate(
    body: &mut Spatial6,
    axis: &Spatial,
    stiffening: f64,
    apart: &Spatial,
) -> Option<Pivot> {
    let mut column = apply(body, axis);
    let mut row = apply_transposed(body, axis);
    for i in 0..6 {
        column[i] -= apart[i];
        row[i] -= apart[i];
    }
    let pivot = dot(axis, &column) + stiffening;
    if pivot.is_nan() || pivot <= 0.0 {
        return None;
    }
    let inverse = 1.0 / pivot;
    take_rank_one(body, &column, &row, inverse);
    Some(Pivot { column, row, inverse })
}

/// LU factors of the front frame's matrix in place, by columns, with the pivots inverted.
fn factor_root(m: &mut Spatial6) -> Option<()> {
    for k in 0..6 {
        let pivot = m[k][k];
        if pivot.is_nan() || pivot <= 0.0 {
            return None;
        }
        let inverse = 1.0 / pivot;
        m[k][k] = inverse;
        for below in &mut m[k][k + 1..] {
            *below *= inverse;
        }
        let lower = m[k];
        for column in &mut m[k + 1..] {
            let top = column[k];
            for i in k + 1..6 {
                column[i] -= lower[i] * top;
            }
        }
    }
    Some(())
}

fn solve_root(lu: &Spatial6, x: &mut Spatial) {
    for k in 0..6 {
        for i in k + 1..6 {
            x[i] -= lu[k][i] * x[k];
        }
    }
    for k in (0..6).rev() {
        x[k] *= lu[k][k];
        for i in 0..k {
            x[i] -= lu[k][i] * x[k];
        }
    }
}
