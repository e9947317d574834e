//! What of the frames can touch the ground: balls along their undersides and about the arms' pivots, and
//! corners for a fall.
//!
//! Contact of anything but a wheel ends an episode (paper 3.3), so the underside has to be felt where
//! a stone meets it; a machine on its side only has to lie there.

use xt28_machine::{Machine, Wheel};

use super::arm;

/// A ball that is part of a frame's outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HullBall {
    /// Its centre in the frames' axes, m.
    pub centre_m: [f64; 3],
    /// Its radius, m.
    pub radius_m: f64,
}

/// Radius of the balls along the undersides, m. Between any of them the hull is higher than the
/// underside by 6 cm at most.
const UNDERSIDE_RADIUS_M: f64 = 0.5;
/// Most room between two of a row, m.
const UNDERSIDE_STEP_M: f64 = 0.35;
/// Half the width between the tyres in which frames have an underside, m (assumed).
const HALF_WIDTH_M: f64 = 0.4;
/// Radius of the corners, m (assumed).
const CORNER_RADIUS_M: f64 = 0.1;
/// Half length and half width of the cab's roof, m; it lies below the antenna (assumed).
const CAB_HALF_M: [f64; 2] = [0.8, 0.9];

/// The outside of the front, the middle and the rear frame.
pub(super) fn hulls(machine: &Machine) -> [Vec<HullBall>; 3] {
    let f = &machine.frames;
    let pivot_z_m = arm(machine, Wheel::Fr).pivot_m[2];
    let bottom_m = pivot_z_m - f.underside_below_pivot_m;
    let joints = [machine.articulation.front_joint_x_m, machine.articulation.rear_joint_x_m];
    // Frames end where they are hinged together.
    let front = [joints[0], f.front_com_m[0] + f.front_box_m[0] / 2.0];
    let middle = [joints[1], joints[0]];
    let rear = [f.rear_com_m[0] - f.rear_box_m[0] / 2.0, joints[1]];
    let mut hulls = [front, middle, rear].map(|along_m| underside(along_m, bottom_m));
    let top = |com_m: [f64; 3], box_m: [f64; 3]| {
        corners(com_m, [box_m[0] / 2.0, box_m[1] / 2.0], com_m[2] + box_m[2] / 2.0)
    };
    hulls[0].extend(top(f.front_com_m, f.front_box_m));
    hulls[1].extend(top(f.middle_com_m, f.middle_box_m));
    hulls[2].extend(top(f.rear_com_m, f.rear_box_m));
    for (i, wheel) in Wheel::ALL.into_iter().enumerate() {
        // Wheels come in pairs, an axle to a frame.
        hulls[i / 2].push(HullBall {
            centre_m: arm(machine, wheel).pivot_m,
            radius_m: f.underside_below_pivot_m,
        });
    }
    let antenna_m = machine.sensors.gnss_antenna_m;
    hulls[0].extend(corners(antenna_m, CAB_HALF_M, antenna_m[2]));
    hulls
}

/// Three rows of balls that rest on a plane at height `bottom_m`: one along each side, and between them
/// one whose balls stand where those have their gaps.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss)]
fn underside([from_m, to_m]: [f64; 2], bottom_m: f64) -> Vec<HullBall> {
    let steps = ((to_m - from_m) / UNDERSIDE_STEP_M).ceil().max(1.0) as usize;
    let ball = |at: f64, y_m: f64| HullBall {
        centre_m: [
            from_m + (to_m - from_m) * at / steps as f64,
            y_m,
            bottom_m + UNDERSIDE_RADIUS_M,
        ],
        radius_m: UNDERSIDE_RADIUS_M,
    };
    let sides =
        (0..=steps).flat_map(|i| [-HALF_WIDTH_M, HALF_WIDTH_M].map(|y_m| ball(i as f64, y_m)));
    sides.chain((0..steps).map(|i| ball(i as f64 + 0.5, 0.0))).collect()
}

/// The four corners of a level face around `centre_m`, its top at `top_m`.
fn corners(centre_m: [f64; 3], half_m: [f64; 2], top_m: f64) -> impl Iterator<Item = HullBall> {
    [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].into_iter().map(move |(x, y)| HullBall {
        centre_m: [
            centre_m[0] + x * (half_m[0] - CORNER_RADIUS_M),
            centre_m[1] + y * (half_m[1] - CORNER_RADIUS_M),
            top_m - CORNER_RADIUS_M,
        ],
        radius_m: CORNER_RADIUS_M,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_underside_is_where_the_machine_file_has_it() {
        let machine = Machine::xt28();
        let hulls = hulls(&machine);
        let lowest = hulls.iter().flatten().map(|b| b.centre_m[2] - b.radius_m);
        let lowest_m = lowest.fold(f64::MAX, f64::min);
        let pivot_m = machine.wheels.radius_m + machine.linkage().at_stroke(0.25).drop_m;
        assert!((lowest_m - (pivot_m - 0.15)).abs() < 1e-9, "{lowest_m}");
    }

    #[test]
    fn a_stone_between_balls_lifts_the_underside_by_six_centimetres_at_most() {
        for hull in hulls(&Machine::xt28()) {
            let low: Vec<&HullBall> = hull.iter().filter(|b| b.radius_m > 0.2).collect();
            let along = low.iter().map(|b| b.centre_m[0]);
            let (first, last) =
                (along.clone().fold(f64::MAX, f64::min), along.fold(f64::MIN, f64::max));
            let bottom_m = low[0].centre_m[2] - low[0].radius_m;
            for (i, j) in (0..=100).flat_map(|i| (0..=40).map(move |j| (i, j))) {
                let x = first + (last - first) * f64::from(i) / 100.0;
                let y = HALF_WIDTH_M * (f64::from(j) / 20.0 - 1.0);
                let above = low.iter().map(|b| {
                    let (dx, dy) = (b.centre_m[0] - x, b.centre_m[1] - y);
                    let under2 = b.radius_m.powi(2) - dx * dx - dy * dy;
                    b.centre_m[2] - under2.max(0.0).sqrt() - bottom_m
                });
                let gap_m = above.fold(f64::MAX, f64::min);
                assert!((-1e-9..0.061).contains(&gap_m), "{x}, {y}: {gap_m}");
            }
        }
    }
}
