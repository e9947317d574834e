//! Where the wheels and the middle of all masses are, seen from the front frame of a bent machine.

use xt28_machine::{Machine, PerWheel, Wheel};
use xt28_sim::Parts;

/// Places at one bend and one set of strokes, in the front frame's axes (x forward, y left, z up).
pub(super) struct Layout {
    /// Lowest points of the wheels, m.
    pub(super) contact_m: PerWheel<[f64; 3]>,
    /// Middle of all masses, m.
    pub(super) com_m: [f64; 3],
}

/// What a wheel adds to a layout.
#[derive(Clone, Copy)]
pub(super) struct Reach {
    /// Wheel's centre from the pivot, horizontally, m.
    pub(super) reach_m: f64,
    /// Wheel's centre below the pivot, m.
    pub(super) drop_m: f64,
}

/// Origins and headings of the three frames.
struct Chain {
    origin_m: [[f64; 2]; 3],
    heading_rad: [f64; 3],
}

impl Chain {
    /// Turns the frames behind about their joints: a bend to the left turns them to the right.
    fn new(parts: &Parts, joint_rad: [f64; 2]) -> Self {
        let mut chain = Self { origin_m: [[0.0; 2]; 3], heading_rad: [0.0; 3] };
        for (k, bend) in joint_rad.into_iter().enumerate() {
            let at_x = parts.joint_m[k][0];
            let joint = chain.place(k, [at_x, 0.0]);
            let heading = chain.heading_rad[k] - bend;
            let (sin, cos) = heading.sin_cos();
            chain.heading_rad[k + 1] = heading;
            chain.origin_m[k + 1] = [joint[0] - cos * at_x, joint[1] - sin * at_x];
        }
        chain
    }

    /// A place on frame `f`, in the front frame's axes.
    fn place(&self, f: usize, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.heading_rad[f].sin_cos();
        let [ox, oy] = self.origin_m[f];
        [ox + cos * x - sin * y, oy + sin * x + cos * y]
    }
}

impl Layout {
    /// The machine bent by `joint_rad` on arms that reach as far as `reaches` say.
    pub(super) fn new(
        parts: &Parts,
        machine: &Machine,
        joint_rad: [f64; 2],
        reaches: &PerWheel<Reach>,
    ) -> Self {
        let chain = Chain::new(parts, joint_rad);
        let (mut moment, mut mass) = ([0.0; 3], 0.0);
        let mut add = |at: [f64; 2], z: f64, kg: f64| {
            moment = [moment[0] + kg * at[0], moment[1] + kg * at[1], moment[2] + kg * z];
            mass += kg;
        };
        for (f, frame) in parts.frames.iter().enumerate() {
            let [x, y, z] = frame.com_m;
            add(chain.place(f, [x, y]), z, frame.mass_kg);
        }
        let share = machine.vehicle.arm_com_share;
        let contact_m = PerWheel::from_fn(|w: Wheel| {
            let (arm, Reach { reach_m, drop_m }) = (&parts.arms[w], reaches[w]);
            let [x, y, z] = arm.pivot_m;
            let out_m = arm.to_wheel_m[1];
            let on = |share: f64| {
                chain.place(
                    w.axle() as usize,
                    [x + share * arm.extends * reach_m, y + share * out_m],
                )
            };
            add(on(1.0), z - drop_m, parts.wheel.mass_kg);
            add(on(share), z - share * drop_m, arm.body.mass_kg);
            let [x, y] = on(1.0);
            [x, y, z - drop_m - parts.radius_m]
        });
        Self { contact_m, com_m: moment.map(|m| m / mass) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use xt28_sim::Effects;

    fn level(parts: &Parts) -> PerWheel<Reach> {
        let pose = parts.linkage.at_stroke(0.25);
        PerWheel::splat(Reach { reach_m: pose.reach_m, drop_m: pose.drop_m })
    }

    #[test]
    fn a_straight_machine_stands_where_the_machine_file_says() {
        let machine = Machine::xt28();
        let parts = Parts::new(&machine, &Effects::default());
        let layout = Layout::new(&parts, &machine, [0.0; 2], &level(&parts));
        for (w, [x, y, z]) in layout.contact_m.iter() {
            assert!((x - machine.wheels.axle_x_m[w.axle() as usize]).abs() < 1e-9, "{w}");
            assert!((y.abs() - machine.wheels.track_m / 2.0).abs() < 1e-9 && z.abs() < 1e-9);
        }
        // 34 % of the wheelbase behind the front axle (facts 1.2).
        assert!((layout.com_m[0] + 0.34 * 6.05).abs() < 0.02, "{:?}", layout.com_m);
        assert!(layout.com_m[1].abs() < 1e-9);
    }

    #[test]
    fn a_bend_to_the_left_swings_the_rear_to_the_left() {
        let machine = Machine::xt28();
        let parts = Parts::new(&machine, &Effects::default());
        let layout = Layout::new(&parts, &machine, [0.3, 0.3], &level(&parts));
        // The rear of the machine lies behind and, seen from the front frame, to the left.
        let rear = (layout.contact_m[Wheel::Bl][1] + layout.contact_m[Wheel::Br][1]) / 2.0;
        assert!(rear > 1.0 && layout.com_m[1] > 0.2, "{rear} {:?}", layout.com_m);
    }
}
