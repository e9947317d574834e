//! Masses of the machine by its file and the effects' numbers alone, moving as its sensors feel it: no part of a solver.

use xt28_machine::{Axle, Machine, Side, Wheel};
use xt28_sim::effects::MassEffects;
use xt28_sim::{REFERENCE_STROKE_M, VehicleState};

pub(crate) type V3 = [f64; 3];

/// The load's box, m.
const LOAD_BOX_M: V3 = [4.5, 1.8, 1.2];

/// A rigid body as it moves in the world.
#[derive(Clone, Copy, Debug)]
struct Body {
    mass_kg: f64,
    com_m: V3,
    velocity_m_s: V3,
    /// About its centre of mass, kg m²/s.
    spin_nms: V3,
}

/// What all bodies come to, about the world's origin.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sum {
    pub(crate) mass_kg: f64,
    /// Mass times place, kg m.
    pub(crate) first_kg_m: V3,
    /// Momentum, kg m/s.
    pub(crate) momentum: V3,
    /// Angular momentum, kg m²/s.
    pub(crate) angular: V3,
}

/// A frame whose coordinates are the machine file's: where they have their origin, along what they are, how they move.
#[derive(Clone, Copy)]
struct Frame {
    origin_m: V3,
    axes: [V3; 3],
    velocity_m_s: V3,
    rate_rad_s: V3,
}

impl Frame {
    /// The front frame in this state.
    fn front(machine: &Machine, s: &VehicleState) -> Self {
        let [(sp, cp), (sr, cr), (sy, cy)] = [s.pitch_rad, s.roll_rad, s.yaw_rad].map(f64::sin_cos);
        // Yaw, then nose up, then right side high.
        let x = [cp * cy, cp * sy, sp];
        let y = [-sy * cr + cy * sp * sr, cy * cr + sy * sp * sr, -sr * cp];
        let axes = [x, y, cross(x, y)];
        let rate_rad_s = along(&axes, s.front_rate_rad_s);
        let antenna = along(&axes, machine.sensors.gnss_antenna_m);
        let velocity_m_s = plus(s.antenna_velocity_m_s, cross(rate_rad_s, antenna), -1.0);
        Self { origin_m: s.position_m, axes, velocity_m_s, rate_rad_s }
    }

    /// The frame behind a joint at `x_m`, which a bend to the left turns to the right.
    fn behind(&self, x_m: f64, bent_rad: f64, rate_rad_s: f64) -> Self {
        let [x, y, z] = self.axes;
        let (sin, cos) = bent_rad.sin_cos();
        let axes = [plus(x.map(|c| c * cos), y, -sin), plus(y.map(|c| c * cos), x, sin), z];
        let joint_m = self.place([x_m, 0.0, 0.0]);
        let rate_rad_s = plus(self.rate_rad_s, z, -rate_rad_s);
        let back_m = along(&axes, [-x_m, 0.0, 0.0]);
        Self {
            origin_m: plus(joint_m, back_m, 1.0),
            axes,
            velocity_m_s: plus(self.velocity(joint_m), cross(rate_rad_s, back_m), 1.0),
            rate_rad_s,
        }
    }

    fn place(&self, point_m: V3) -> V3 {
        plus(self.origin_m, along(&self.axes, point_m), 1.0)
    }

    /// Of what is at this place in the world and moves along.
    fn velocity(&self, place_m: V3) -> V3 {
        plus(self.velocity_m_s, cross(self.rate_rad_s, plus(place_m, self.origin_m, -1.0)), 1.0)
    }

    /// A solid box that moves along.
    fn solid(&self, mass_kg: f64, com_m: V3, [x, y, z]: V3) -> Body {
        let inertia = [y * y + z * z, x * x + z * z, x * x + y * y].map(|m2| mass_kg / 12.0 * m2);
        let spin = core::array::from_fn(|i| inertia[i] * dot(self.axes[i], self.rate_rad_s));
        let com_m = self.place(com_m);
        Body {
            mass_kg,
            com_m,
            velocity_m_s: self.velocity(com_m),
            spin_nms: along(&self.axes, spin),
        }
    }

    /// An arm and its wheel.
    fn arm(&self, machine: &Machine, s: &VehicleState, wheel: Wheel) -> [Body; 2] {
        let (m, v, linkage) = (&machine.masses, &machine.vehicle, machine.linkage());
        let reference = linkage.at_stroke(REFERENCE_STROKE_M);
        let side = if wheel.side() == Side::Left { 1.0 } else { -1.0 };
        // Front arms point forward, the others backward; extending turns the wheel down.
        let forward = if wheel.axle() == Axle::Front { 1.0 } else { -1.0 };
        let angle_rad = linkage.at_stroke(s.stroke_m[wheel]).angle_rad;
        let rate_rad_s = forward * s.stroke_rate_m_s[wheel] / linkage.lever_m(angle_rad);
        let (sin, cos) = (forward * (angle_rad - reference.angle_rad)).sin_cos();
        let [x, y, z] = self.axes;
        let axes = [plus(x.map(|c| c * cos), z, -sin), y, plus(z.map(|c| c * cos), x, sin)];
        let pivot_m = self.place([
            machine.wheels.axle_x_m[wheel.axle() as usize] - forward * reference.reach_m,
            side * v.arm_pivot_y_m,
            machine.wheels.radius_m + reference.drop_m,
        ]);
        let across_m = side * (machine.wheels.track_m / 2.0 - v.arm_pivot_y_m);
        let to_wheel = along(&axes, [forward * reference.reach_m, across_m, -reference.drop_m]);
        let turning_rad_s = plus(self.rate_rad_s, y, rate_rad_s);
        let at = |share: f64, mass_kg: f64, spin_nms: V3| {
            let lever = to_wheel.map(|c| share * c);
            let velocity_m_s = plus(self.velocity(pivot_m), cross(turning_rad_s, lever), 1.0);
            Body { mass_kg, com_m: plus(pivot_m, lever, 1.0), velocity_m_s, spin_nms }
        };
        let slender = m.arm_kg * machine.arms.pivot_to_wheel_m.powi(2) / 12.0;
        let about_axle = m.wheel_kg * v.wheel_gyration_m.powi(2);
        let rolls_rad_s = dot(turning_rad_s, y);
        let more = about_axle * (rolls_rad_s + s.wheel_speed_rad_s[wheel])
            - 0.6 * about_axle * rolls_rad_s;
        let wheel_nms = plus(turning_rad_s.map(|w| 0.6 * about_axle * w), y, more);
        [
            at(v.arm_com_share, m.arm_kg, turning_rad_s.map(|w| slender * w)),
            at(1.0, m.wheel_kg, wheel_nms),
        ]
    }
}

/// All bodies of this machine with these effects, on level ground, as they move in this state.
pub(crate) fn sum(machine: &Machine, effects: &MassEffects, s: &VehicleState) -> Sum {
    let (m, f, a) = (&machine.masses, &machine.frames, &machine.articulation);
    let front = Frame::front(machine, s);
    let middle = front.behind(a.front_joint_x_m, s.joint_rad[0], s.joint_rate_rad_s[0]);
    let rear = middle.behind(a.rear_joint_x_m, s.joint_rad[1], s.joint_rate_rad_s[1]);
    let (shift, load) = (&effects.com_shift, &effects.payload);
    let front_com_m = plus(f.front_com_m, [shift.x_m, shift.y_m, shift.z_m], 1.0);
    let load_m = [f.rear_com_m[0] + load.longitudinal_m, load.lateral_m, load.height_m];
    let mut bodies = vec![
        front.solid(m.front_frame_kg, front_com_m, f.front_box_m),
        middle.solid(m.middle_frame_kg, f.middle_com_m, f.middle_box_m),
        rear.solid(m.rear_frame_kg, f.rear_com_m, f.rear_box_m),
        rear.solid(load.mass_kg, load_m, LOAD_BOX_M),
    ];
    for wheel in Wheel::ALL {
        let frame = [front, middle, rear][wheel.axle() as usize];
        bodies.extend(frame.arm(machine, s, wheel));
    }
    bodies.iter().fold(Sum::default(), |sum, body| {
        let momentum = body.velocity_m_s.map(|v| body.mass_kg * v);
        Sum {
            mass_kg: sum.mass_kg + body.mass_kg,
            first_kg_m: plus(sum.first_kg_m, body.com_m, body.mass_kg),
            momentum: plus(sum.momentum, momentum, 1.0),
            angular: plus(plus(sum.angular, cross(body.com_m, momentum), 1.0), body.spin_nms, 1.0),
        }
    })
}

pub(crate) fn plus(a: V3, b: V3, times: f64) -> V3 {
    core::array::from_fn(|k| a[k] + times * b[k])
}

pub(crate) fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// What has these coordinates along the axes, in the axes' own world.
fn along(axes: &[V3; 3], v: V3) -> V3 {
    core::array::from_fn(|k| v[0] * axes[0][k] + v[1] * axes[1][k] + v[2] * axes[2][k])
}
