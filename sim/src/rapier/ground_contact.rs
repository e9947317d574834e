//! Frames against the ground, for the engine: a dispatcher that knows [`Hull`] against [`Ground`].

use rapier3d::geometry::{ContactData, ContactManifoldData};
use rapier3d::math::{Pose, Real, Vector};
use rapier3d::parry::query::details::{NormalConstraints, ShapeCastOptions};
use rapier3d::parry::query::{
    ClosestPoints, Contact, ContactManifold, ContactManifoldsWorkspace, DefaultQueryDispatcher,
    NonlinearRigidMotion, PersistentQueryDispatcher, QueryDispatcher, ShapeCastHit, ShapeDistance,
    ShapeIntersection, TrackedContact, Unsupported,
};
use rapier3d::parry::shape::{PackedFeatureId, Shape};

use xt28_terrain::Nearest;

use super::shapes::{Ground, Hull};

/// Hulls against [`Ground`] by local minima; every other pair by the engine's own dispatcher.
pub(crate) struct GroundDispatcher;

type Manifold = ContactManifold<ContactManifoldData, ContactData>;

/// The ground and what meets it, and whether that came first.
fn ground_and_other<'a>(
    g1: &'a dyn Shape,
    g2: &'a dyn Shape,
) -> Option<(&'a Ground, &'a dyn Shape, bool)> {
    if let Some(ground) = g1.as_shape::<Ground>() {
        return Some((ground, g2, false));
    }
    Some((g2.as_shape::<Ground>()?, g1, true))
}

impl PersistentQueryDispatcher<ContactManifoldData, ContactData> for GroundDispatcher {
    fn contact_manifolds(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
        manifolds: &mut Vec<Manifold>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        let met = ground_and_other(g1, g2);
        if let Some((ground, other, flipped)) = met {
            let pose = if flipped { pos12.inverse() } else { *pos12 };
            if let Some(hull) = other.as_shape::<Hull>() {
                hull_contacts(ground, hull, &pose, flipped, prediction, manifolds);
                return Ok(());
            }
        }
        DefaultQueryDispatcher.contact_manifolds(pos12, g1, g2, prediction, manifolds, workspace)
    }

    fn contact_manifold_convex_convex(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        normal_constraints1: Option<&dyn NormalConstraints>,
        normal_constraints2: Option<&dyn NormalConstraints>,
        prediction: Real,
        manifold: &mut Manifold,
    ) -> Result<(), Unsupported> {
        DefaultQueryDispatcher.contact_manifold_convex_convex(
            pos12,
            g1,
            g2,
            normal_constraints1,
            normal_constraints2,
            prediction,
            manifold,
        )
    }
}

/// Where each ball of a hull touches deepest. A ball that touched before keeps its manifold, and
/// with it the impulses that the solver starts from.
fn hull_contacts(
    ground: &Ground,
    hull: &Hull,
    pose: &Pose,
    flipped: bool,
    prediction: Real,
    manifolds: &mut Vec<Manifold>,
) {
    let mut before = core::mem::take(manifolds);
    for (i, &(centre, radius)) in (0..).zip(hull.balls()) {
        let ball = BallOf { pose: *pose, centre, radius, flipped };
        let minima = ball.minima(ground, prediction);
        let by_distance = |a: &&Nearest, b: &&Nearest| a.distance_m.total_cmp(&b.distance_m);
        if let Some(nearest) = minima.points().iter().min_by(by_distance) {
            let mut manifold = match before.iter().position(|m| m.subshape2 == i) {
                Some(at) => before.swap_remove(at),
                None => Manifold { subshape2: i, ..Manifold::new() },
            };
            ball.write_contact(&mut manifold, nearest);
            manifolds.push(manifold);
        }
    }
}

/// A ball that belongs to a shape at `pose`.
struct BallOf {
    pose: Pose,
    /// In the shape's axes.
    centre: Vector,
    radius: Real,
    /// Whether the engine names this shape before the ground.
    flipped: bool,
}

impl BallOf {
    fn minima(&self, ground: &Ground, prediction: Real) -> xt28_terrain::Minima {
        let centre_m = (self.pose * self.centre).to_array().map(f64::from);
        ground.0.nearest(centre_m, f64::from(self.radius + prediction))
    }

    /// Writes one contact; a point that was there before keeps its warm-start impulses.
    fn write_contact(&self, manifold: &mut Manifold, nearest: &Nearest) {
        #[allow(clippy::cast_possible_truncation)]
        let (point, distance) =
            (Vector::from(nearest.point_m.map(|m| m as Real)), nearest.distance_m as Real);
        let away = self.pose * self.centre - point;
        let sign = if distance < 0.0 { -1.0 } else { 1.0 };
        let normal = (away * sign).normalize_or(Vector::Z);
        let own_normal = self.pose.rotation.inverse() * -normal;
        let contact = TrackedContact::flipped(
            point,
            self.centre + own_normal * self.radius,
            PackedFeatureId::face(0),
            PackedFeatureId::face(0),
            distance - self.radius,
            self.flipped,
        );
        if manifold.points.len() == 1 {
            manifold.points[0].copy_geometry_from(contact);
        } else {
            manifold.points.clear();
            manifold.points.push(contact);
        }
        (manifold.local_n1, manifold.local_n2) =
            if self.flipped { (own_normal, normal) } else { (normal, own_normal) };
    }
}

impl QueryDispatcher for GroundDispatcher {
    fn intersection_test(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeIntersection, Unsupported> {
        DefaultQueryDispatcher.intersection_test(pos12, g1, g2)
    }

    fn distance(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeDistance, Unsupported> {
        DefaultQueryDispatcher.distance(pos12, g1, g2)
    }

    fn contact(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
    ) -> Result<Option<Contact>, Unsupported> {
        DefaultQueryDispatcher.contact(pos12, g1, g2, prediction)
    }

    fn closest_points(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        max_dist: Real,
    ) -> Result<ClosestPoints, Unsupported> {
        DefaultQueryDispatcher.closest_points(pos12, g1, g2, max_dist)
    }

    fn cast_shapes(
        &self,
        pos12: &Pose,
        local_vel12: Vector,
        g1: &dyn Shape,
        g2: &dyn Shape,
        options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        DefaultQueryDispatcher.cast_shapes(pos12, local_vel12, g1, g2, options)
    }

    fn cast_shapes_nonlinear(
        &self,
        motion1: &NonlinearRigidMotion,
        g1: &dyn Shape,
        motion2: &NonlinearRigidMotion,
        g2: &dyn Shape,
        start_time: Real,
        end_time: Real,
        stop_at_penetration: bool,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        DefaultQueryDispatcher.cast_shapes_nonlinear(
            motion1,
            g1,
            motion2,
            g2,
            start_time,
            end_time,
            stop_at_penetration,
        )
    }
}
