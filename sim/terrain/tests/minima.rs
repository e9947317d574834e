//! The points where a ball touches rough ground, against a look at every triangle.

use proptest::prelude::*;
use xt28_terrain::{Extent, Grid, Nearest, Plane, Terrain};

type Vector = [f64; 3];

const EXTENT: Extent = Extent { x_m: [-1.5, 1.5], y_m: [-1.2, 1.2] };
const RADIUS_M: f64 = 0.74;

fn sub(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn dot(a: Vector, b: Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// Nearest point of a triangle, by clamping to its inside and each of its edges: slow and plain.
fn nearest_on_triangle(p: Vector, corners: [Vector; 3]) -> Vector {
    let [a, b, c] = corners;
    let (ab, ac, ap) = (sub(b, a), sub(c, a), sub(p, a));
    let (d, e, f) = (dot(ab, ab), dot(ab, ac), dot(ac, ac));
    let (g, h) = (dot(ap, ab), dot(ap, ac));
    let determinant = d * f - e * e;
    let (s, t) = ((g * f - h * e) / determinant, (h * d - g * e) / determinant);
    let inside = s >= 0.0 && t >= 0.0 && s + t <= 1.0;
    let foot = std::array::from_fn(|axis| a[axis] + s * ab[axis] + t * ac[axis]);
    let on_edge = |i: usize| {
        let (from, along) = (corners[i], sub(corners[(i + 1) % 3], corners[i]));
        let share = (dot(sub(p, from), along) / dot(along, along)).clamp(0.0, 1.0);
        std::array::from_fn(|axis| from[axis] + share * along[axis])
    };
    let edges = [on_edge(0), on_edge(1), on_edge(2)];
    let candidates = edges.into_iter().chain(inside.then_some(foot));
    candidates.min_by(|a, b| length(sub(p, *a)).total_cmp(&length(sub(p, *b)))).unwrap()
}

/// All triangles of the ground, some cells beyond the edge of the grid included.
fn triangles(terrain: &Terrain) -> Vec<[Vector; 3]> {
    let vertex = |c: i32, r: i32| {
        let (x, y) = (f64::from(c) / 10.0, f64::from(r) / 10.0);
        [x, y, terrain.height_m(x, y)]
    };
    let cells = (-30..30).flat_map(|c| (-30..30).map(move |r| (c, r)));
    cells
        .flat_map(|(c, r)| {
            let (low, high) = (vertex(c, r), vertex(c + 1, r + 1));
            [[low, vertex(c + 1, r), high], [low, high, vertex(c, r + 1)]]
        })
        .collect()
}

/// Every local minimum of the distance within reach: nearest points of triangles than which no
/// triangle that touches them has a nearer one.
fn by_brute_force(terrain: &Terrain, centre: Vector, reach_m: f64) -> Vec<Nearest> {
    let feet: Vec<(Vector, f64, [Vector; 3])> = triangles(terrain)
        .into_iter()
        .map(|corners| (nearest_on_triangle(centre, corners), corners))
        .map(|(foot, corners)| (foot, length(sub(centre, foot)), corners))
        .filter(|(_, distance, _)| *distance < reach_m + 0.1)
        .collect();
    let is_minimum = |foot: Vector, distance: f64| {
        feet.iter()
            .filter(|(_, _, corners)| length(sub(nearest_on_triangle(foot, *corners), foot)) < 1e-9)
            .all(|(_, other, _)| *other > distance - 1e-9)
    };
    feet.iter()
        .filter(|(foot, distance, _)| *distance <= reach_m && is_minimum(*foot, *distance))
        .map(|&(point_m, distance_m, _)| Nearest { point_m, distance_m })
        .collect()
}

/// Heights from a list, one a grid point, on ground that rises.
fn rough(heights: &[f64], rise: [f64; 2]) -> Terrain {
    let plane = Plane { height_m: 0.0, rise };
    Terrain::Grid(std::sync::Arc::new(Grid::on_slope(EXTENT, rise, |x, y| {
        let index = ((x + 1.5) * 10.0).round() as usize * 25 + ((y + 1.2) * 10.0).round() as usize;
        plane.at_m(x, y) + heights[index % heights.len()]
    })))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn the_minima_are_those_of_all_triangles(
        heights in prop::collection::vec(0.0..0.25_f64, 31 * 25),
        rise in [-0.3..0.3_f64, -0.3..0.3_f64],
        // Some centres lie near the edge of the grid, some beyond it.
        x in -1.8..1.8_f64, y in -1.6..1.6_f64,
        sink_m in 0.0..0.05_f64,
    ) {
        let terrain = rough(&heights, rise);
        let centre = [x, y, terrain.rest_m(x, y, RADIUS_M) - sink_m];
        let reach_m = RADIUS_M + 0.02;
        let minima = terrain.nearest(centre, reach_m);
        let brute = by_brute_force(&terrain, centre, reach_m);
        prop_assert!(!brute.is_empty() && !minima.points().is_empty());
        // Each one found is one of them, and the nearest is among them.
        for found in minima.points() {
            let same = |b: &Nearest| length(sub(b.point_m, found.point_m)) < 1e-6;
            prop_assert!(brute.iter().any(same), "{found:?} of {brute:?}");
        }
        let nearest = |points: &[Nearest]| {
            points.iter().map(|p| p.distance_m).fold(f64::MAX, f64::min)
        };
        prop_assert!((nearest(&brute) - nearest(minima.points())).abs() < 1e-7);
        // Each one of them was found, or stands for another within 5 cm, or gave way to four.
        for one in &brute {
            let near = |f: &Nearest| length(sub(f.point_m, one.point_m)) < 0.05 + 1e-6;
            prop_assert!(
                minima.points().len() == 4 || minima.points().iter().any(near),
                "{one:?} is not among {:?}", minima.points()
            );
        }
    }

    #[test]
    fn a_plane_is_the_same_with_and_without_a_grid(
        rise in [-0.4..0.4_f64, -0.4..0.4_f64],
        x in -3.0..3.0_f64, y in -3.0..3.0_f64, above in 0.3..0.74_f64,
    ) {
        let plane = Plane { height_m: 0.2, rise };
        let grid = Grid::on_slope(EXTENT, rise, |x, y| plane.at_m(x, y));
        let centre = [x, y, plane.at_m(x, y) + above];
        let on_grid = Terrain::Grid(grid.into()).nearest(centre, RADIUS_M);
        let on_plane = Terrain::Plane(plane).nearest(centre, RADIUS_M);
        // Heights are single numbers of 1e-7 m: a foot on a border may be found from both sides.
        prop_assert_eq!(on_grid.points().len(), 1);
        let (a, b) = (on_grid.points()[0], on_plane.points()[0]);
        prop_assert!((a.distance_m - b.distance_m).abs() < 1e-6);
        prop_assert!(length(sub(a.point_m, b.point_m)) < 1e-4, "{a:?} {b:?}");
    }

    #[test]
    fn no_number_breaks_it(
        x in any::<f64>(), y in any::<f64>(), z in any::<f64>(), reach_m in -1.0..2.0_f64,
        near in [-3.0..3.0_f64, -3.0..3.0_f64, -1.0..1.0_f64],
    ) {
        for terrain in [rough(&[0.0, 0.2], [0.1, 0.0]), Terrain::Flat] {
            for centre in [[x, y, z], [x, near[1], near[2]], [near[0], near[1], z], near] {
                for point in terrain.nearest(centre, reach_m).points() {
                    prop_assert!(point.distance_m <= reach_m);
                    prop_assert!(point.point_m.iter().all(|m| m.is_finite()));
                }
                let _ = terrain.height_m(centre[0], centre[1]);
                let _ = terrain.rest_m(centre[0], centre[1], reach_m.abs());
            }
        }
    }

    #[test]
    fn a_resting_ball_touches_and_cuts_nothing(
        heights in prop::collection::vec(0.0..0.2_f64, 31 * 25),
        x in -1.8..1.8_f64, y in -1.6..1.6_f64,
    ) {
        let terrain = rough(&heights, [0.1, -0.1]);
        let centre = [x, y, terrain.rest_m(x, y, RADIUS_M)];
        let distance = terrain.nearest(centre, 1.0).points().iter()
            .map(|p| p.distance_m).fold(f64::MAX, f64::min);
        prop_assert!((distance - RADIUS_M).abs() < 1e-6, "{distance}");
    }
}

#[test]
fn under_ground_the_way_out_is_up() {
    let terrain = rough(&[0.1], [0.0; 2]);
    let minima = terrain.nearest([0.2, 0.3, -0.4], 0.8);
    assert_eq!(minima.points().len(), 1);
    let out = minima.points()[0];
    assert!((out.distance_m + 0.5).abs() < 1e-6 && (out.point_m[2] - 0.1).abs() < 1e-6);
    assert!(terrain.nearest([0.0, 0.0, 9.0], 0.8).points().is_empty());
    assert!(Terrain::Flat.nearest([0.0, 0.0, 9.0], 0.8).points().is_empty());
}

#[test]
fn a_wheel_at_a_kerb_touches_floor_and_edge() {
    let kerb = Grid::from_fn(EXTENT, |x, _| if x >= 0.5 { 0.15 } else { 0.0 });
    let edge_m = (RADIUS_M * RADIUS_M - (RADIUS_M - 0.15) * (RADIUS_M - 0.15)).sqrt();
    let centre = [0.5 - edge_m, 0.0, RADIUS_M];
    let minima = Terrain::Grid(kerb.into()).nearest(centre, RADIUS_M + 1e-3);
    let mut heights: Vec<f64> = minima.points().iter().map(|p| p.point_m[2]).collect();
    heights.sort_by(f64::total_cmp);
    assert_eq!(heights.len(), 2);
    assert!(heights[0].abs() < 1e-6 && (heights[1] - 0.15).abs() < 1e-6, "{heights:?}");
}
