//! The vehicle as rigid parts with their places and inertias, before any solver takes them.

mod hull;
mod part;
mod stance;
mod tilt;
mod tyre_part;

use xt28_machine::{Axle, GRAVITY_M_S2, Linkage, Machine, PerWheel, Pointing, Side, Wheel};

pub use hull::HullBall;
pub use part::Part;
pub use tilt::Tilt;
pub use tyre_part::{Brush, TyrePart};

use crate::Effects;
use crate::effects::Payload;

/// Stroke at which the machine file gives the frames' positions, m.
pub const REFERENCE_STROKE_M: f64 = 0.25;

/// A pendulum arm with the wheel at its end; origin at the pivot, axes of its frame when at
/// [`REFERENCE_STROKE_M`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmPart {
    /// The arm.
    pub body: Part,
    /// The pivot on the frame, m.
    pub pivot_m: [f64; 3],
    /// From the pivot to the wheel's centre, m.
    pub to_wheel_m: [f64; 3],
    /// Sense in which the arm extends about +y: 1 where it points forward, -1 where backward.
    pub extends: f64,
}

/// Size of the load of logs whose inertia the payload has: length, width, height, m (assumed).
const LOAD_BOX_M: [f64; 3] = [4.5, 1.8, 1.2];
/// Inertia of a wheel across its axle as a share of that about it (assumed): of a thin disc it is a half, a tyre's
/// width adds the rest.
const ACROSS_AXLE: f64 = 0.6;

/// A hinge along the machine, sprung towards level, with stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollHinge {
    /// Stiffness, Nm/rad.
    pub stiffness_nm: f64,
    /// Damping, Nm s/rad.
    pub damping_nms: f64,
    /// Angle at which it meets its stops on either side, rad.
    pub max_rad: f64,
}

/// All parts of one vehicle. Frames share the machine file's axes and origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts {
    /// Front, middle and rear frame.
    pub frames: [Part; 3],
    /// Front and rear articulation joint, m; their axes are the frames' z.
    pub joint_m: [[f64; 3]; 2],
    /// Arms, each on the frame of its axle.
    pub arms: PerWheel<ArmPart>,
    /// Every wheel alike; origin at its centre, turning about y.
    pub wheel: Part,
    /// Radius of the wheels, m.
    pub radius_m: f64,
    /// Tyres.
    pub tyres: PerWheel<TyrePart>,
    /// Gravity along the axes of the ground, m/s².
    pub gravity_m_s2: [f64; 3],
    /// Roll of the middle frame against the front one, about x through the front joint; `None` where
    /// there is no such freedom. A solver that has none must refuse it, not leave it out.
    pub roll_hinge: Option<RollHinge>,
    /// How the ground, and with it every position that a solver knows, leans in the level world.
    pub tilt: Option<Tilt>,
    /// Outside of the front, middle and rear frame. A solver may leave it out and report no
    /// [`crate::Motion::chassis_force_n`].
    pub hulls: [Vec<HullBall>; 3],
    /// Between cylinder and arm.
    pub linkage: Linkage,
}

impl Parts {
    /// The parts of this machine, with what the effects change of them.
    #[must_use]
    pub fn new(machine: &Machine, effects: &Effects) -> Self {
        let (m, f) = (&machine.masses, &machine.frames);
        let shift = &effects.masses.com_shift;
        let mut front = Part::solid_box(m.front_frame_kg, f.front_com_m, f.front_box_m);
        for (com_m, by_m) in front.com_m.iter_mut().zip([shift.x_m, shift.y_m, shift.z_m]) {
            *com_m += by_m;
        }
        let rear = Part::solid_box(m.rear_frame_kg, f.rear_com_m, f.rear_box_m);
        let slope = &effects.slope;
        let tilt = Tilt::new(slope.grade_x_rad, slope.grade_y_rad);
        let down = [0.0, 0.0, -GRAVITY_M_S2];
        let joint = |x: f64| [x, 0.0, machine.wheels.radius_m];
        let v = &machine.vehicle;
        let about_axle = m.wheel_kg * v.wheel_gyration_m * v.wheel_gyration_m;
        let across = ACROSS_AXLE * about_axle;
        Self {
            frames: [
                front,
                Part::solid_box(m.middle_frame_kg, f.middle_com_m, f.middle_box_m),
                rear.joined(load(&effects.masses.payload, f.rear_com_m[0])),
            ],
            joint_m: [
                joint(machine.articulation.front_joint_x_m),
                joint(machine.articulation.rear_joint_x_m),
            ],
            arms: PerWheel::from_fn(|wheel| arm(machine, wheel)),
            wheel: Part {
                mass_kg: m.wheel_kg,
                com_m: [0.0; 3],
                inertia_kg_m2: [across, about_axle, across],
                products_kg_m2: [0.0; 3],
            },
            radius_m: machine.wheels.radius_m,
            tyres: PerWheel::from_fn(|wheel| TyrePart::new(machine, &effects.wheels[wheel])),
            gravity_m_s2: tilt.map_or(down, |tilt| tilt.to_ground(down)),
            roll_hinge: v.roll_hinge.then_some(RollHinge {
                stiffness_nm: v.roll_hinge_stiffness_nm,
                damping_nms: v.roll_hinge_damping_nms,
                max_rad: v.roll_hinge_max_deg.to_radians(),
            }),
            tilt,
            hulls: hull::hulls(machine),
            linkage: machine.linkage(),
        }
    }

    /// Hinge angle of an arm at a stroke, in the sense of [`crate::Motion::arm`], rad.
    #[must_use]
    pub fn arm_angle_rad(&self, stroke_m: f64) -> f64 {
        self.linkage.at_stroke(stroke_m).angle_rad
            - self.linkage.at_stroke(REFERENCE_STROKE_M).angle_rad
    }
}

/// The load in the bunk of an empty rear frame whose centre of mass is at `bunk_x_m`.
fn load(payload: &Payload, bunk_x_m: f64) -> Part {
    let com_m = [bunk_x_m + payload.longitudinal_m, payload.lateral_m, payload.height_m];
    Part::solid_box(payload.mass_kg, com_m, LOAD_BOX_M)
}

fn arm(machine: &Machine, wheel: Wheel) -> ArmPart {
    let reference = machine.linkage().at_stroke(REFERENCE_STROKE_M);
    let side = if wheel.side() == Side::Left { 1.0 } else { -1.0 };
    let front = machine.arms.front_arms_point == Pointing::Forward;
    let forward = if (wheel.axle() == Axle::Front) == front { 1.0 } else { -1.0 };
    let v = &machine.vehicle;
    let to_wheel_m = [
        forward * reference.reach_m,
        side * (machine.wheels.track_m / 2.0 - v.arm_pivot_y_m),
        -reference.drop_m,
    ];
    let pivot_m = [
        machine.wheels.axle_x_m[wheel.axle() as usize] - to_wheel_m[0],
        side * v.arm_pivot_y_m,
        machine.wheels.radius_m + reference.drop_m,
    ];
    let mass_kg = machine.masses.arm_kg;
    let length_m = machine.arms.pivot_to_wheel_m;
    let slender = mass_kg * length_m * length_m / 12.0;
    let body = Part {
        mass_kg,
        com_m: to_wheel_m.map(|c| c * v.arm_com_share),
        inertia_kg_m2: [slender; 3],
        products_kg_m2: [0.0; 3],
    };
    ArmPart { body, pivot_m, to_wheel_m, extends: forward }
}
