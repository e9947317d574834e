//! Wheel against ground, for the engine: the ground as a shape, and a dispatcher that knows the pair.

use rapier3d::geometry::{ContactData, ContactManifoldData};
use rapier3d::math::{Pose, Real, Vector};
use rapier3d::parry::bounding_volume::{Aabb, BoundingSphere};
use rapier3d::parry::mass_properties::MassProperties;
use rapier3d::parry::query::details::{NormalConstraints, ShapeCastOptions};
use rapier3d::parry::query::{
    ClosestPoints, Contact, ContactManifold, ContactManifoldsWorkspace, DefaultQueryDispatcher,
    NonlinearRigidMotion, PersistentQueryDispatcher, PointProjection, PointQuery, QueryDispatcher,
    Ray, RayCast, RayIntersection, ShapeCastHit, ShapeDistance, ShapeIntersection, TrackedContact,
    Unsupported,
};
use rapier3d::parry::shape::{Ball, FeatureId, PackedFeatureId, Shape, ShapeType, TypedShape};

use xt28_terrain::Nearest;

use crate::Terrain;

/// The ground as a shape; only balls meet it.
#[derive(Clone, Debug)]
pub(crate) struct Ground(pub(crate) Terrain);

impl PointQuery for Ground {
    fn project_local_point(&self, pt: Vector, _solid: bool) -> PointProjection {
        #[allow(clippy::cast_possible_truncation)]
        let height = self.0.height_m(f64::from(pt.x), f64::from(pt.y)) as Real;
        PointProjection::new(pt.z < height, Vector::new(pt.x, pt.y, height))
    }

    fn project_local_point_and_get_feature(&self, pt: Vector) -> (PointProjection, FeatureId) {
        (self.project_local_point(pt, true), FeatureId::Unknown)
    }
}

impl RayCast for Ground {
    /// Nothing in the plant casts rays at the ground; sensors read heights instead.
    fn cast_local_ray_and_get_normal(
        &self,
        _ray: &Ray,
        _max_time_of_impact: Real,
        _solid: bool,
    ) -> Option<RayIntersection> {
        None
    }
}

impl Shape for Ground {
    fn compute_local_aabb(&self) -> Aabb {
        // As high as wide: a slope without end rises out of any lower box.
        let half = Vector::splat(1.0e4);
        Aabb::new(-half, half)
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        self.compute_local_aabb().bounding_sphere()
    }

    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(self.clone())
    }

    fn scale_dyn(&self, _scale: Vector, _subdivisions: u32) -> Option<Box<dyn Shape>> {
        None
    }

    fn mass_properties(&self, _density: Real) -> MassProperties {
        MassProperties::default()
    }

    fn shape_type(&self) -> ShapeType {
        ShapeType::Custom
    }

    fn as_typed_shape(&self) -> TypedShape<'_> {
        TypedShape::Custom(self)
    }

    fn ccd_thickness(&self) -> Real {
        0.0
    }

    fn ccd_angular_thickness(&self) -> Real {
        core::f32::consts::PI
    }
}

/// Ball against [`Ground`] by local minima; every other pair by the engine's own dispatcher.
pub(crate) struct GroundDispatcher;

type Manifold = ContactManifold<ContactManifoldData, ContactData>;

/// The ground and the ball of a pair, and whether the ball came first.
fn ground_and_ball<'a>(
    g1: &'a dyn Shape,
    g2: &'a dyn Shape,
) -> Option<(&'a Ground, &'a Ball, bool)> {
    if let (Some(ground), Some(ball)) = (g1.as_shape::<Ground>(), g2.as_ball()) {
        return Some((ground, ball, false));
    }
    Some((g2.as_shape::<Ground>()?, g1.as_ball()?, true))
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
        let Some((ground, ball, flipped)) = ground_and_ball(g1, g2) else {
            return DefaultQueryDispatcher
                .contact_manifolds(pos12, g1, g2, prediction, manifolds, workspace);
        };
        let ball_pose = if flipped { pos12.inverse() } else { *pos12 };
        let reach_m = ball.radius + prediction;
        let centre_m = ball_pose.translation.to_array().map(f64::from);
        let minima = ground.0.nearest(centre_m, f64::from(reach_m));
        manifolds.resize_with(minima.points().len(), Manifold::new);
        for (manifold, nearest) in manifolds.iter_mut().zip(minima.points()) {
            write_contact(manifold, nearest, &ball_pose, ball.radius, flipped);
        }
        Ok(())
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

/// Writes one contact; a point that was there before keeps its warm-start impulses.
fn write_contact(
    manifold: &mut Manifold,
    nearest: &Nearest,
    ball_pose: &Pose,
    radius: Real,
    flipped: bool,
) {
    #[allow(clippy::cast_possible_truncation)]
    let (point, distance) =
        (Vector::from(nearest.point_m.map(|m| m as Real)), nearest.distance_m as Real);
    let away = ball_pose.translation - point;
    let sign = if distance < 0.0 { -1.0 } else { 1.0 };
    let normal = (away * sign).normalize_or(Vector::Z);
    let ball_normal = ball_pose.rotation.inverse() * -normal;
    let contact = TrackedContact::flipped(
        point,
        ball_normal * radius,
        PackedFeatureId::face(0),
        PackedFeatureId::face(0),
        distance - radius,
        flipped,
    );
    if manifold.points.len() == 1 {
        manifold.points[0].copy_geometry_from(contact);
    } else {
        manifold.points.clear();
        manifold.points.push(contact);
    }
    (manifold.local_n1, manifold.local_n2) =
        if flipped { (ball_normal, normal) } else { (normal, ball_normal) };
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
