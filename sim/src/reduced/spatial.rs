//! Spatial vectors and matrices: six numbers a motion or a force, angular part first.
//!
//! All are taken about one point fixed in the world and in world axes (Featherstone, Rigid Body
//! Dynamics Algorithms, chapter 2), so that a tree is walked without turning or shifting any.

use glam::{DMat3, DVec3};

/// A twist (rad/s, m/s) or a wrench (Nm, N), angular part first.
pub(super) type Spatial = [f64; 6];
/// A spatial inertia or stiffness, by columns.
pub(super) type Spatial6 = [Spatial; 6];

pub(super) const ZERO: Spatial = [0.0; 6];
pub(super) const ZERO6: Spatial6 = [ZERO; 6];

#[inline]
pub(super) const fn join(angular: DVec3, linear: DVec3) -> Spatial {
    [angular.x, angular.y, angular.z, linear.x, linear.y, linear.z]
}

#[inline]
pub(super) const fn angular(v: &Spatial) -> DVec3 {
    DVec3::new(v[0], v[1], v[2])
}

#[inline]
pub(super) const fn linear(v: &Spatial) -> DVec3 {
    DVec3::new(v[3], v[4], v[5])
}

/// The twist of a turn at 1 rad/s about `axis` through `at`.
#[inline]
pub(super) fn turn_about(axis: DVec3, at: DVec3) -> Spatial {
    join(axis, at.cross(axis))
}

/// The wrench of `force` that acts at `at`.
#[inline]
pub(super) fn wrench_at(force: DVec3, at: DVec3) -> Spatial {
    join(at.cross(force), force)
}

/// Velocity of the body's point at `at`.
#[inline]
pub(super) fn velocity_at(twist: &Spatial, at: DVec3) -> DVec3 {
    linear(twist) + angular(twist).cross(at)
}

#[inline]
pub(super) fn dot(a: &Spatial, b: &Spatial) -> f64 {
    // Even and odd apart: two sums that a processor makes at once.
    let products: Spatial = core::array::from_fn(|i| a[i] * b[i]);
    let [p, q, r, s, t, u] = products;
    let [even, odd] = [(p + r) + t, (q + s) + u];
    even + odd
}

/// `a += b * by`.
#[inline]
pub(super) fn add_scaled(a: &mut Spatial, b: &Spatial, by: f64) {
    for (a, b) in a.iter_mut().zip(b) {
        *a += b * by;
    }
}

#[inline]
pub(super) fn add(a: &mut Spatial, b: &Spatial) {
    for (a, b) in a.iter_mut().zip(b) {
        *a += b;
    }
}

#[inline]
pub(super) fn add6(a: &mut Spatial6, b: &Spatial6) {
    for (a, b) in a.iter_mut().zip(b) {
        add(a, b);
    }
}

/// `m v`.
#[inline]
pub(super) fn apply(m: &Spatial6, v: &Spatial) -> Spatial {
    let mut out = ZERO;
    for (column, v) in m.iter().zip(v) {
        add_scaled(&mut out, column, *v);
    }
    out
}

/// `m^T v`.
#[inline]
pub(super) fn apply_transposed(m: &Spatial6, v: &Spatial) -> Spatial {
    let mut out = ZERO;
    for (out, column) in out.iter_mut().zip(m) {
        *out = dot(column, v);
    }
    out
}

/// `m -= u w^T / d`.
#[inline]
pub(super) fn take_rank_one(m: &mut Spatial6, u: &Spatial, w: &Spatial, d_inverse: f64) {
    for (column, w) in m.iter_mut().zip(w) {
        add_scaled(column, u, -w * d_inverse);
    }
}

/// The rate of change of a twist that moves with `v`: v x s.
#[inline]
pub(super) fn cross_motion(v: &Spatial, s: &Spatial) -> Spatial {
    let (w, u) = (angular(v), linear(v));
    let (a, b) = (angular(s), linear(s));
    join(w.cross(a), w.cross(b) + u.cross(a))
}

/// Writes the inertia about the common point of `mass_kg` at `com`, with `about_com` in world axes.
#[inline]
pub(super) fn write_rigid(out: &mut Spatial6, mass_kg: f64, com: DVec3, about_com: &DMat3) {
    *out = rigid(mass_kg, com, about_com);
}

/// Adds that inertia.
#[inline]
pub(super) fn add_rigid(out: &mut Spatial6, mass_kg: f64, com: DVec3, about_com: &DMat3) {
    add6(out, &rigid(mass_kg, com, about_com));
}

#[inline(always)]
fn rigid(mass_kg: f64, com: DVec3, about_com: &DMat3) -> Spatial6 {
    let moment = com * mass_kg;
    let square = moment.dot(com);
    let [a, b, c] = [0, 1, 2].map(|j| {
        let mut column = about_com.col(j) - com * moment[j];
        column[j] += square;
        column
    });
    let (m, DVec3 { x, y, z }) = (mass_kg, moment);
    [
        [a.x, a.y, a.z, 0.0, -z, y],
        [b.x, b.y, b.z, z, 0.0, -x],
        [c.x, c.y, c.z, -y, x, 0.0],
        [0.0, z, -y, m, 0.0, 0.0],
        [-z, 0.0, x, 0.0, m, 0.0],
        [y, -x, 0.0, 0.0, 0.0, m],
    ]
}

/// `x.tanh()` in half the time but near zero; to the last bit one from some 19 on.
#[inline]
pub(super) fn saturating_tanh(x: f64) -> f64 {
    let size = x.abs();
    if size < 1.0 {
        return x.tanh();
    }
    let fallen = if size < 19.5 { (-2.0 * size).exp() } else { 0.0 };
    ((1.0 - fallen) / (1.0 + fallen)).copysign(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rigid_inertia_gives_momentum_and_energy() {
        let com = DVec3::new(0.3, -1.2, 0.8);
        let about = DMat3::from_diagonal(DVec3::new(2.0, 3.0, 5.0));
        let twist = [0.4, -0.2, 0.9, 1.0, 2.0, -0.5];
        let mut inertia = ZERO6;
        write_rigid(&mut inertia, 7.0, com, &about);
        let momentum = apply(&inertia, &twist);
        let p = velocity_at(&twist, com) * 7.0;
        let l = about * angular(&twist) + com.cross(p);
        for (got, want) in momentum.iter().zip(join(l, p)) {
            assert!((got - want).abs() < 1e-12);
        }
    }
}
