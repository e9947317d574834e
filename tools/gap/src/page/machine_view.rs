//! The machine from above, each part in the colour of its gap.

use xt28_machine::{Machine, PerWheel, Side, Wheel};
use xt28_sim::effects::{Block, Scope};

use super::colour::{AFTER, BLANK, INK, legend, of_gap};
use super::named::{Named, signal};
use super::svg::{Anchor, Svg};
use crate::diagnosis::{Diagnosis, Spot};

const SIZE: [f64; 2] = [360.0, 405.0];
const PX_PER_M: f64 = 40.0;
/// Of a wheel from above, m; its width is assumed, it is only drawn.
const WHEEL_M: [f64; 2] = [0.75, 1.48];
/// Where the key stands.
const KEY_X: f64 = 235.0;
/// Pixels from the top to the front axle.
const FRONT_PX: f64 = 78.0;

const CAPTION: &str = "Wheels show their arm, sensors and rolling; circles steering; frames weight, \
    load and attitude. A gap of 1 is what two models of one sound machine differ by.";

/// From a part's edge to the ring around one that the verdict names.
const RING_PX: f64 = 3.5;

/// Gaps of the parts, floors; `None` where no block watches one.
struct Parts {
    wheels: PerWheel<Option<f64>>,
    joints: Option<f64>,
    drive: Option<f64>,
    frames: Option<f64>,
    bus: Option<f64>,
}

/// The drawing.
pub(super) fn draw(machine: &Machine, diagnosis: &Diagnosis) -> String {
    let parts = Parts::new(diagnosis);
    let named = Named::of(diagnosis);
    let mut svg = Svg::new(SIZE[0], SIZE[1]);
    let middle = 115.0;
    let y_of = |x_m: f64| FRONT_PX - x_m * PX_PER_M;
    let axles = machine.wheels.axle_x_m;
    let joints = [machine.articulation.front_joint_x_m, machine.articulation.rear_joint_x_m];
    svg.text([middle, 14.0], "ahead ↑", Anchor::Middle, 11.0, INK);
    frames(
        &mut svg,
        &parts,
        &named,
        middle,
        [axles[0] + 1.2, joints[0], joints[1], axles[2] - 1.1].map(y_of),
    );
    for (w, gap) in parts.wheels.iter() {
        let side = if w.side() == Side::Left { -1.0 } else { 1.0 };
        let hub = [
            middle + side * machine.wheels.track_m / 2.0 * PX_PER_M,
            y_of(axles[w.axle() as usize]),
        ];
        svg.line([middle, hub[1]], hub, "#8a8a84", 3.0);
        wheel(&mut svg, w, hub, *gap);
        if named.wheels[w] {
            let [width, length] = WHEEL_M.map(|m| m * PX_PER_M);
            ring(&mut svg, [hub[0] - width / 2.0, hub[1] - length / 2.0], [width, length], 4.0);
        }
    }
    for x_m in joints {
        let (fill, _) = shade(parts.joints);
        let y = y_of(x_m);
        svg.circle([middle, y], 9.0, fill, INK);
        if named.joints {
            ring(&mut svg, [middle - 9.0, y - 9.0], [18.0, 18.0], 9.0 + RING_PX);
        }
    }
    key(&mut svg);
    bus(&mut svg, parts.bus, named.bus);
    if !named.is_none() {
        ring(&mut svg, [KEY_X + RING_PX, 210.0], [9.0, 9.0], 2.0);
        svg.text([KEY_X + 22.0, 218.0], "named above", Anchor::Start, 10.5, INK);
    }
    let drawing =
        svg.finish("The machine from above, each wheel, joint and frame in the colour of its gap");
    format!("{drawing}<p class=\"small\">{CAPTION}</p>")
}

fn shade(gap: Option<f64>) -> (&'static str, &'static str) {
    gap.map_or((BLANK, INK), of_gap)
}

/// Around a part of this place and size.
fn ring(svg: &mut Svg, at: [f64; 2], size: [f64; 2], corner: f64) {
    svg.ring(at.map(|px| px - RING_PX), size.map(|px| px + 2.0 * RING_PX), corner, AFTER);
}

/// What has no place on the machine.
fn bus(svg: &mut Svg, gap: Option<f64>, is_named: bool) {
    let (fill, ink) = shade(gap);
    let (at, size) = ([KEY_X, 244.0], [64.0, 22.0]);
    svg.rect(at, size, fill, INK);
    svg.text([at[0] + size[0] / 2.0, at[1] + 15.0], "bus", Anchor::Middle, 10.0, ink);
    if is_named {
        ring(svg, at, size, 4.0);
    }
}

fn frames(svg: &mut Svg, parts: &Parts, named: &Named, middle: f64, [front, a, b, rear]: [f64; 4]) {
    let (fill, ink) = shade(parts.frames);
    let half = 24.0;
    for (from, to, name) in [(front, a, ""), (a, b, ""), (b, rear, "load")] {
        svg.rect([middle - half, from + 3.0], [2.0 * half, to - from - 6.0], fill, INK);
        svg.text([middle, to - 16.0], name, Anchor::Middle, 10.0, ink);
        if named.frames {
            let size = [2.0 * (half - RING_PX), to - from - 6.0 - 2.0 * RING_PX];
            ring(svg, [middle - half + RING_PX, from + 3.0 + RING_PX], size, 2.0);
        }
    }
    // The engine stands for the drive.
    let (fill, ink) = shade(parts.drive);
    svg.rect([middle - 17.0, front + 9.0], [34.0, 24.0], fill, INK);
    svg.text([middle, front + 25.0], "drive", Anchor::Middle, 10.0, ink);
    if named.drive {
        ring(svg, [middle - 17.0, front + 9.0], [34.0, 24.0], 4.0);
    }
}

fn wheel(svg: &mut Svg, w: Wheel, [x, y]: [f64; 2], gap: Option<f64>) {
    let (fill, ink) = shade(gap);
    let [width, length] = WHEEL_M.map(|m| m * PX_PER_M);
    svg.rect([x - width / 2.0, y - length / 2.0], [width, length], fill, INK);
    svg.text([x, y + 4.0], w.name(), Anchor::Middle, 11.0, ink);
}

fn key(svg: &mut Svg) {
    let x = KEY_X;
    svg.text([x, 60.0], "gap in noise floors", Anchor::Start, 11.0, INK);
    for ((colour, words), k) in legend().into_iter().zip(0_u8..) {
        let y = 70.0 + 19.0 * f64::from(k);
        svg.rect([x, y], [16.0, 14.0], colour, "#8a8a84");
        svg.text([x + 22.0, y + 11.0], &words, Anchor::Start, 10.5, INK);
    }
}

impl Parts {
    fn new(diagnosis: &Diagnosis) -> Self {
        let worst = |of: &dyn Fn(&Spot) -> bool| {
            let there = diagnosis.places.iter().filter(|place| of(&place.spot));
            let gaps = there.map(|place| place.gap_over_noise);
            gaps.fold(None, |most: Option<f64>, gap| Some(most.map_or(gap, |most| most.max(gap))))
        };
        let whole = |block: Block| worst(&|s: &Spot| s.block == block && s.scope == Scope::All);
        // A wheel that seems to hang in the air says that the machine does not stand as its strokes have it, not
        // that this wheel is the matter: it colours the frames, and its wheel only where that is what is named.
        let stands = |s: &Spot| s.block == Block::Payload;
        let is_of_wheels = |s: &Spot| !stands(s) || signal(diagnosis) == Some(s);
        Self {
            wheels: PerWheel::from_fn(|w| {
                worst(&|s: &Spot| is_of_wheels(s) && s.has_wheels() && s.scope.contains(w))
            }),
            joints: whole(Block::Steering),
            drive: whole(Block::Drive),
            frames: worst(&stands),
            bus: whole(Block::Bus),
        }
    }
}
