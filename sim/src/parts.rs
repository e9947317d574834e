//! The vehicle as rigid parts with their places and inertias, before any solver takes them.

use xt28_machine::{Axle, GRAVITY_M_S2, Linkage, Machine, PerWheel, Pointing, Side, Wheel};

use crate::Effects;

/// Stroke at which the machine file gives the frames' positions, m.
pub const REFERENCE_STROKE_M: f64 = 0.25;

/// A rigid body's mass; axes and origin as its owner says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Centre of mass, m.
    pub com_m: [f64; 3],
    /// Principal inertias about the centre of mass, along the part's axes, kg m².
    pub inertia_kg_m2: [f64; 3],
}

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

/// A tyre's spring and damper against the ground, and its grip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TyrePart {
    /// Stiffness, N/m.
    pub stiffness_n_m: f64,
    /// Damping, N s/m.
    pub damping_n_s_m: f64,
    /// Coefficient of dry friction on the ground.
    pub friction: f64,
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
    /// Gravity in the world, m/s².
    pub gravity_m_s2: [f64; 3],
    /// Between cylinder and arm.
    pub linkage: Linkage,
}

impl Parts {
    /// The parts of this machine, with what the effects change of them.
    #[must_use]
    pub fn new(machine: &Machine, _effects: &Effects) -> Self {
        let (m, f) = (&machine.masses, &machine.frames);
        let frame = |mass_kg: f64, com_m: [f64; 3], box_m: [f64; 3]| Part {
            mass_kg,
            com_m,
            inertia_kg_m2: box_inertia_kg_m2(mass_kg, box_m),
        };
        let joint = |x: f64| [x, 0.0, machine.wheels.radius_m];
        let v = &machine.vehicle;
        let about_axle = m.wheel_kg * v.wheel_gyration_m * v.wheel_gyration_m;
        let across = 0.6 * about_axle;
        Self {
            frames: [
                frame(m.front_frame_kg, f.front_com_m, f.front_box_m),
                frame(m.middle_frame_kg, f.middle_com_m, f.middle_box_m),
                frame(m.rear_frame_kg, f.rear_com_m, f.rear_box_m),
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
            },
            radius_m: machine.wheels.radius_m,
            tyres: PerWheel::splat(TyrePart {
                stiffness_n_m: v.tyre_stiffness_n_m,
                damping_n_s_m: v.tyre_damping_n_s_m,
                friction: machine.wheels.friction,
            }),
            gravity_m_s2: [0.0, 0.0, -GRAVITY_M_S2],
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
    };
    ArmPart { body, pivot_m, to_wheel_m, extends: forward }
}

/// Principal inertias of a solid box, kg m².
fn box_inertia_kg_m2(mass_kg: f64, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let m = mass_kg / 12.0;
    [m * (y * y + z * z), m * (x * x + z * z), m * (x * x + y * y)]
}
