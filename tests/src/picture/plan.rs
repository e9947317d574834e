//! The run from above: the path of the front axle, and the machine's footprint at a few instants.

use xt28_machine::{Axle, Machine, Wheel};

use super::Picture;
use super::ground;
use super::palette;
use super::scale::{Scale, round_step};
use super::svg::{Anchor, Svg, simplified};
use crate::Expectation;
use crate::finding::significant;
use crate::trace::Pose;

/// Footprints are at least this far apart along the way, m: a little more than the machine is
/// long. On a shorter way the first one is drawn faintly under the last.
const FOOTPRINTS_APART_M: f64 = 10.0;
/// Steps in which the way is measured, m.
const STEP_M: f64 = 0.3;
/// The largest scale: a machine that stands does not fill the page.
const PIXELS_PER_M_MAX: f64 = 42.0;

/// Everything of the plan view in metres, with the scale that fits it to the page.
pub(super) struct Plan<'a> {
    picture: &'a Picture<'a>,
    path_m: Vec<[f64; 2]>,
    footprints: Vec<Footprint>,
    low_m: [f64; 2],
    high_m: [f64; 2],
    pixels_per_m: f64,
    width: f64,
}

/// Where the three frames are at one instant.
struct Footprint {
    at_s: f64,
    /// Drawn faintly, for another one is drawn over it.
    ghost: bool,
    /// Front, middle, rear: the frame's origin (front axle of the straight machine) and heading.
    frames: [Pose; 3],
}

const LEFT: f64 = 54.0;
const BOTTOM: f64 = 30.0;
const HEIGHT_MAX: f64 = 430.0;
const AIR_M: f64 = 0.8;
/// Drawn width of a tyre, m.
const TYRE_M: f64 = 0.6;
/// Where the time is written, m to the right of the machine's centre line.
const LABEL_M: f64 = 2.15;
/// Room that a target's arrow and name take, m.
const TARGET_M: f64 = 3.2;
/// Ends and half width of the drawn frames, m from the front axle of the straight machine.
const HULLS: [([f64; 2], f64); 3] =
    [([-1.75, 1.8], 0.8), ([-4.77, -1.95], 0.62), ([-7.3, -4.98], 0.8)];

impl<'a> Plan<'a> {
    pub(super) fn new(picture: &'a Picture<'a>, width: f64) -> Self {
        let footprints = footprints(picture);
        let path_m = path(picture);
        let corners = footprints.iter().flat_map(Footprint::outline);
        let target = target(picture).map(|(pose, _)| placed(&pose, [TARGET_M, 0.0]));
        let (mut low_m, mut high_m) = ([-8.0, -2.2], [3.0, 2.2]);
        for point in path_m.iter().copied().chain(corners).chain(target) {
            for axis in 0..2 {
                low_m[axis] = f64::min(low_m[axis], point[axis]);
                high_m[axis] = f64::max(high_m[axis], point[axis]);
            }
        }
        for axis in 0..2 {
            low_m[axis] -= AIR_M;
            high_m[axis] += AIR_M;
        }
        let room = (width - LEFT - 8.0) / (high_m[0] - low_m[0]);
        let pixels_per_m = room.min(HEIGHT_MAX / (high_m[1] - low_m[1])).min(PIXELS_PER_M_MAX);
        // What the height limit leaves over goes to both sides.
        let spare_m = (width - LEFT - 8.0) / pixels_per_m - (high_m[0] - low_m[0]);
        low_m[0] -= spare_m / 2.0;
        high_m[0] += spare_m / 2.0;
        Self { picture, path_m, footprints, low_m, high_m, pixels_per_m, width }
    }

    pub(super) fn height(&self) -> f64 {
        (self.high_m[1] - self.low_m[1]) * self.pixels_per_m + BOTTOM
    }

    pub(super) fn draw(&self, svg: &mut Svg, x: f64, y: f64) {
        let east = Scale {
            from: self.low_m[0],
            to: self.high_m[0],
            pixel_from: x + LEFT,
            pixel_to: x + self.width - 8.0,
        };
        let north = Scale {
            from: self.low_m[1],
            to: self.high_m[1],
            pixel_from: y + self.height() - BOTTOM,
            pixel_to: y,
        };
        let at = |[x_m, y_m]: [f64; 2]| [east.pixel(x_m), north.pixel(y_m)];
        self.grid(svg, x, &east, &north);
        ground::draw(&self.picture.scenario.terrain.spec, [self.low_m, self.high_m], svg, &at);
        let path: Vec<_> = self.path_m.iter().map(|p| at(*p)).collect();
        for footprint in &self.footprints {
            footprint.draw(svg, self.picture.machine, &at);
        }
        let style =
            format!("class=\"curve\" stroke=\"{}\" style=\"stroke-width:2.6\"", palette::PATH);
        svg.polyline(&simplified(&path, 0.3), &style);
        for footprint in &self.footprints {
            footprint.mark(svg, &at);
        }
        self.target(svg, &at);
    }

    fn grid(&self, svg: &mut Svg, x: f64, east: &Scale, north: &Scale) {
        let step = round_step(90.0 / self.pixels_per_m);
        for tick in east.ticks((east.to - east.from) / step) {
            let at = east.pixel(tick);
            svg.line([at, north.pixel_from], [at, north.pixel_to], "grid");
            let label = significant(tick) + if tick == 0.0 { " m" } else { "" };
            svg.text([at, north.pixel_from + 20.0], "tick", Anchor::Middle, &label);
        }
        let step = step.min(round_step((north.to - north.from) / 4.0));
        for tick in north.ticks((north.to - north.from) / step) {
            let at = north.pixel(tick);
            svg.line([east.pixel_from, at], [east.pixel_to, at], "grid");
            svg.text([x + LEFT - 8.0, at + 5.0], "tick", Anchor::End, &significant(tick));
        }
        svg.line([east.pixel_from, north.pixel_from], [east.pixel_to, north.pixel_from], "axis");
        svg.line([east.pixel_from, north.pixel_from], [east.pixel_from, north.pixel_to], "axis");
    }

    fn target(&self, svg: &mut Svg, at: &impl Fn([f64; 2]) -> [f64; 2]) {
        let Some((pose, within_m)) = target(self.picture) else {
            return;
        };
        let colour = palette::TARGET;
        let centre = at([pose.x_m, pose.y_m]);
        let ring = format!(
            "fill=\"{colour}\" fill-opacity=\"0.15\" stroke=\"{colour}\" stroke-width=\"2\""
        );
        svg.circle(centre, within_m * self.pixels_per_m, &ring);
        let (sin, cos) = pose.heading_rad.sin_cos();
        let tip = |along: f64, left: f64| {
            at([pose.x_m + cos * along - sin * left, pose.y_m + sin * along + cos * left])
        };
        let arrow = format!("class=\"curve\" stroke=\"{colour}\"");
        svg.polyline(&[centre, tip(1.3, 0.0)], &arrow);
        svg.polyline(&[tip(1.0, 0.22), tip(1.3, 0.0), tip(1.0, -0.22)], &arrow);
        let [x, y] = tip(1.6, 0.0);
        svg.text([x, y + 5.0], "key", Anchor::Start, "target");
    }
}

impl Footprint {
    /// Corners of the room that the three frames and the time beside them take, m.
    fn outline(&self) -> impl Iterator<Item = [f64; 2]> {
        let half_m = LABEL_M + 0.35;
        let hulls = self.frames.into_iter().zip(HULLS);
        hulls.flat_map(move |(frame, ([back, front], _))| {
            [[back, -half_m], [front, -half_m], [front, half_m], [back, half_m]]
                .map(|corner| placed(&frame, corner))
        })
    }

    fn draw(&self, svg: &mut Svg, machine: &Machine, at: &impl Fn([f64; 2]) -> [f64; 2]) {
        svg.open(if self.ghost { "opacity=\"0.25\"" } else { "opacity=\"0.85\"" });
        let joints = [machine.articulation.front_joint_x_m, machine.articulation.rear_joint_x_m];
        for (frame, ([back, front], half)) in self.frames.iter().zip(HULLS) {
            // A hull tapers towards the joints, as the frames do.
            let taper = half * 0.45;
            let hull = [[back, -taper], [back + 0.5, -half], [front - 0.5, -half], [front, -taper]];
            let mirrored = hull.map(|[x, y]| [x, -y]);
            let points: Vec<_> = hull
                .into_iter()
                .chain(mirrored.into_iter().rev())
                .map(|corner| at(placed(frame, corner)))
                .collect();
            svg.polygon(&points, "fill=\"#d9dde1\" stroke=\"#6b7680\" stroke-width=\"1.2\"");
        }
        for (frame, joint_x_m) in self.frames.iter().zip(joints) {
            let joint = at(placed(frame, [joint_x_m, 0.0]));
            svg.circle(joint, 3.2, "fill=\"#6b7680\"");
        }
        for wheel in Wheel::ALL {
            self.tyre(svg, machine, wheel, at);
        }
        svg.close();
    }

    fn tyre(
        &self,
        svg: &mut Svg,
        machine: &Machine,
        wheel: Wheel,
        at: &impl Fn([f64; 2]) -> [f64; 2],
    ) {
        let index = match wheel.axle() {
            Axle::Front => 0,
            Axle::Middle => 1,
            Axle::Rear => 2,
        };
        let x_m = machine.wheels.axle_x_m[index];
        let y_m = wheel.side().sign() * machine.wheels.track_m / 2.0;
        let (r, half) = (machine.wheels.radius_m, TYRE_M / 2.0);
        let corners = [[-r, -half], [r, -half], [r, half], [-r, half]]
            .map(|[dx, dy]| at(placed(&self.frames[index], [x_m + dx, y_m + dy])));
        let style = format!("fill=\"{}\" stroke=\"#fff\" stroke-width=\"0.8\"", palette::of(wheel));
        svg.polygon(&corners, &style);
    }

    fn mark(&self, svg: &mut Svg, at: &impl Fn([f64; 2]) -> [f64; 2]) {
        let front = &self.frames[0];
        let [x, y] = at([front.x_m, front.y_m]);
        svg.circle(
            [x, y],
            4.5,
            &format!("fill=\"#fff\" stroke=\"{}\" stroke-width=\"2\"", palette::PATH),
        );
        let [x, y] = at(placed(front, [0.0, -LABEL_M]));
        svg.text([x, y + 6.0], "key", Anchor::Middle, &format!("{:.0} s", self.at_s));
    }
}

/// A point of a frame, given as in the straight machine, m in the world.
fn placed(frame: &Pose, [x, y]: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = frame.heading_rad.sin_cos();
    [frame.x_m + cos * x - sin * y, frame.y_m + sin * x + cos * y]
}

/// The target pose of the scenario and its tolerance, if it has one.
fn target(picture: &Picture<'_>) -> Option<(Pose, f64)> {
    picture.scenario.expectations.iter().find_map(|expectation| match expectation {
        Expectation::ReachesPose(e) => {
            let heading_rad = e.heading_deg.to_radians();
            Some((Pose { x_m: e.x_m, y_m: e.y_m, heading_rad }, e.within_m))
        }
        _ => None,
    })
}

/// The front axle over the whole run, m.
fn path(picture: &Picture<'_>) -> Vec<[f64; 2]> {
    let Picture { trace, machine, .. } = picture;
    let fixes = trace.antenna_m.samples().iter();
    fixes
        .filter_map(|fix| trace.pose_at(machine, fix.at_s))
        .map(|pose| [pose.x_m, pose.y_m])
        .collect()
}

/// Footprints at the start, at the end, and evenly between.
fn footprints(picture: &Picture<'_>) -> Vec<Footprint> {
    let Picture { trace, machine, .. } = picture;
    // Steps longer than the receiver's noise, so that standing adds no way.
    let mut way: Vec<(f64, f64, Pose)> = Vec::new();
    for fix in trace.antenna_m.samples() {
        let Some(pose) = trace.pose_at(machine, fix.at_s) else { continue };
        let step_m = |last: &Pose| (pose.x_m - last.x_m).hypot(pose.y_m - last.y_m);
        match way.last() {
            None => way.push((fix.at_s, 0.0, pose)),
            Some((_, along_m, last)) if step_m(last) > STEP_M => {
                way.push((fix.at_s, along_m + step_m(last), pose));
            }
            Some(_) => {}
        }
    }
    let Some(&(_, length_m, _)) = way.last() else { return Vec::new() };
    let spans = (length_m / FOOTPRINTS_APART_M).floor().max(1.0);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a handful
    let count = if length_m > STEP_M { spans as u32 } else { 0 };
    let mut chosen: Vec<Footprint> = (0..=count)
        .filter_map(|n| {
            let wanted_m = length_m * f64::from(n) / spans;
            let &(at_s, _, front) = way.iter().find(|(_, along_m, _)| *along_m >= wanted_m)?;
            let joints = trace.joint_rad.known_at(at_s).map_or([0.0; 2], |joint| joint.value);
            let ghost = length_m < FOOTPRINTS_APART_M && n == 0 && count > 0;
            Some(Footprint { at_s, ghost, frames: frames(machine, front, joints) })
        })
        .collect();
    // The machine stands at the end of its way until the run is over.
    if let (Some(last), Some(fix)) = (chosen.last_mut(), trace.antenna_m.last()) {
        last.at_s = fix.at_s;
    }
    chosen
}

/// The three frames from the front one's pose and the joint angles: each joint turns the frame
/// ahead of it to the left of the one behind.
fn frames(machine: &Machine, front: Pose, joint_rad: [f64; 2]) -> [Pose; 3] {
    let articulation = &machine.articulation;
    let behind = |ahead: Pose, joint_x_m: f64, joint_rad: f64| {
        let [x_m, y_m] = placed(&ahead, [joint_x_m, 0.0]);
        let heading_rad = ahead.heading_rad - joint_rad;
        let (sin, cos) = heading_rad.sin_cos();
        Pose { x_m: x_m - cos * joint_x_m, y_m: y_m - sin * joint_x_m, heading_rad }
    };
    let middle = behind(front, articulation.front_joint_x_m, joint_rad[0]);
    let rear = behind(middle, articulation.rear_joint_x_m, joint_rad[1]);
    [front, middle, rear]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_meet_at_their_joints() {
        let machine = Machine::xt28();
        let front = Pose { x_m: 3.0, y_m: -1.0, heading_rad: 0.4 };
        let [front, middle, rear] = frames(&machine, front, [0.2, 0.1]);
        let (a, b) = (machine.articulation.front_joint_x_m, machine.articulation.rear_joint_x_m);
        for (ahead, behind, x_m) in [(front, middle, a), (middle, rear, b)] {
            let (p, q) = (placed(&ahead, [x_m, 0.0]), placed(&behind, [x_m, 0.0]));
            assert!((p[0] - q[0]).hypot(p[1] - q[1]) < 1e-12);
        }
        assert!((rear.heading_rad - 0.1).abs() < 1e-12);
    }
}
