//! Shapes that the engine does not have: the ground, and a frame's outside.

use std::sync::Arc;

use rapier3d::math::{Real, Vector};
use rapier3d::parry::bounding_volume::{Aabb, BoundingSphere};
use rapier3d::parry::mass_properties::MassProperties;
use rapier3d::parry::query::{PointProjection, PointQuery, Ray, RayCast, RayIntersection};
use rapier3d::parry::shape::{FeatureId, Shape, ShapeType, TypedShape};

use crate::Terrain;
use crate::parts::HullBall;

/// The ground as a shape; only hulls meet it.
#[derive(Clone, Debug)]
pub(super) struct Ground(pub(super) Terrain);

/// A frame's outside: balls, each with its centre in the frame's axes.
#[derive(Clone, Debug)]
pub(super) struct Hull {
    balls: Arc<[(Vector, Real)]>,
    bounds: Aabb,
}

impl Hull {
    /// The hull of these balls.
    #[allow(clippy::cast_possible_truncation)]
    pub(super) fn new(balls: &[HullBall]) -> Self {
        let narrow =
            |b: &HullBall| (Vector::from(b.centre_m.map(|m| m as Real)), b.radius_m as Real);
        let balls: Arc<[_]> = balls.iter().map(narrow).collect();
        let mut bounds = Aabb::new_invalid();
        for &(centre, radius) in &*balls {
            bounds.take_point(centre - Vector::splat(radius));
            bounds.take_point(centre + Vector::splat(radius));
        }
        Self { balls, bounds }
    }

    /// Centres and radii, m.
    pub(super) fn balls(&self) -> &[(Vector, Real)] {
        &self.balls
    }
}

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

impl PointQuery for Hull {
    /// Nothing in the plant asks how far a point is from a frame; its box answers for it.
    fn project_local_point(&self, pt: Vector, solid: bool) -> PointProjection {
        self.bounds.project_local_point(pt, solid)
    }

    fn project_local_point_and_get_feature(&self, pt: Vector) -> (PointProjection, FeatureId) {
        (self.project_local_point(pt, true), FeatureId::Unknown)
    }
}

/// What both shapes have in common: bounds, no mass, and no answer to rays, which nothing in the
/// plant casts.
macro_rules! custom_shape {
    ($shape:ty, $bounds:expr) => {
        impl RayCast for $shape {
            fn cast_local_ray_and_get_normal(
                &self,
                _ray: &Ray,
                _max_time_of_impact: Real,
                _solid: bool,
            ) -> Option<RayIntersection> {
                None
            }
        }

        impl Shape for $shape {
            fn compute_local_aabb(&self) -> Aabb {
                $bounds(self)
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
    };
}

// As high as wide: a slope without end rises out of any lower box.
custom_shape!(Ground, |_: &Ground| Aabb::new(-Vector::splat(1.0e4), Vector::splat(1.0e4)));
custom_shape!(Hull, |hull: &Hull| hull.bounds);
