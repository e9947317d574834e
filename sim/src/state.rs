//! What is true of the vehicle at one instant: what its sensors would read without fault or noise.

use xt28_machine::PerWheel;

/// The vehicle's state. World frame: x east, y north, z up; the machine starts at the origin
/// heading east.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VehicleState {
    /// Cylinder strokes, m.
    pub stroke_m: PerWheel<f64>,
    /// Stroke rates, m/s.
    pub stroke_rate_m_s: PerWheel<f64>,
    /// Force of the oil in each cylinder, N; positive under weight.
    pub cylinder_force_n: PerWheel<f64>,
    /// Pressure of the bore chambers (A), Pa.
    pub pressure_a_pa: PerWheel<f64>,
    /// Pressure of the rod chambers (B), Pa.
    pub pressure_b_pa: PerWheel<f64>,
    /// Wheel speeds about the axles, rad/s; forward > 0.
    pub wheel_speed_rad_s: PerWheel<f64>,
    /// Drive torques, Nm; forward > 0.
    pub wheel_torque_nm: PerWheel<f64>,
    /// Vertical force of the ground on each wheel, its friction included, N; where the ground leans as a whole
    /// ([`crate::effects::TerrainSlope`]), the force square to that lean.
    pub ground_force_n: PerWheel<f64>,
    /// Sum of what the ground presses on the three frames with, square to itself at each contact, mean of the
    /// last step, N; above zero the machine has grounded. Of an arm its pivot counts, which its frame carries; the
    /// rest lies between pivot and axle, and the load above its frame, and neither touches anything.
    /// On the reference frames are rigid and a blow lasts a step, so that its peak grows with the step rate (onto a
    /// stump 218 kN at 60 Hz, 2540 kN at 1000 Hz; `docs/second-engine.md`); the force of standing there does not, and
    /// the peak of the fast core, whose frames give way, hardly.
    pub chassis_force_n: f64,
    /// Angles of the front and the rear articulation joint, rad; left > 0.
    pub joint_rad: [f64; 2],
    /// Rates of the joints, rad/s.
    pub joint_rate_rad_s: [f64; 2],
    /// Angle of the machine's rear against its front about the roll hinge, rad; right side high > 0, zero
    /// where there is none.
    pub roll_hinge_rad: f64,
    /// Rate of the roll hinge, rad/s.
    pub roll_hinge_rate_rad_s: f64,
    /// Pump pressures 1A 1B 2A 2B, Pa.
    pub pump_pressure_pa: [f64; 4],
    /// Engine speed, rpm.
    pub engine_speed_rpm: f64,
    /// Middle of the front axle line of the frame at stroke 0.25 m, m.
    pub position_m: [f64; 3],
    /// Heading of the front frame, rad, counter-clockwise from east.
    pub yaw_rad: f64,
    /// Roll of the front frame, rad; right side high > 0 (facts 1.1).
    pub roll_rad: f64,
    /// Pitch of the front frame, rad; nose up > 0 (facts 1.1).
    pub pitch_rad: f64,
    /// Angular rate of the front frame in its own axes, rad/s.
    pub front_rate_rad_s: [f64; 3],
    /// Specific force at the inertial unit in the front frame's axes, m/s². The unit sits where the
    /// machine file has the frame's centre of mass, wherever that really is.
    pub front_specific_force_m_s2: [f64; 3],
    /// GNSS antenna, m.
    pub antenna_position_m: [f64; 3],
    /// GNSS antenna, m/s.
    pub antenna_velocity_m_s: [f64; 3],
}
