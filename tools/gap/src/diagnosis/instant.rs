//! One instant at which a machine's stance is judged.

use xt28_machine::PerWheel;

/// What a log says of one instant. Strokes, joints, speeds and angles are taken through the filter
/// that makes the loads late, so that they are all of one moment.
#[derive(Clone, Debug)]
pub(super) struct Instant {
    /// Sample of the log.
    pub(super) sample: usize,
    /// Whether the machine neither gains nor loses speed.
    pub(super) is_calm: bool,
    /// Whether the pressures say all that the arms carry.
    pub(super) is_read: bool,
    /// Whether no brake holds a wheel that its arm, as it swings, wants to roll.
    pub(super) rolls_freely: bool,
    /// How many times as doubtful as at rest what is said of attitude and weight is.
    pub(super) doubt: f64,
    /// Front and rear joint, rad.
    pub(super) joint_rad: [f64; 2],
    /// Roll and pitch read, less what the filter feels of the motion, rad.
    pub(super) attitude_rad: [f64; 2],
    /// Acceleration to the left and forward, m/s².
    pub(super) acceleration_m_s2: [f64; 2],
    /// Cosine and sine of the heading, counter-clockwise from east, as roll and as pitch have it: a machine that
    /// turns on a slope stands otherwise before the attitude's filter has followed.
    pub(super) heading: [[f64; 2]; 2],
    /// How far the machine turns about the ground's normal within the memory of the attitude's filter, left > 0, as
    /// roll and as pitch have it, rad: a unit that leans as it turns feels of that turn a roll and a pitch.
    pub(super) turned_rad: [f64; 2],
    /// What it says of each wheel.
    pub(super) wheels: PerWheel<AtWheel>,
}

/// What a log says of one wheel at one instant.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct AtWheel {
    /// Stroke as read, m.
    pub(super) stroke_m: f64,
    /// Load of the cylinder as read, N.
    pub(super) load_n: f64,
    /// What its rod chamber shows against the rod, N.
    pub(super) rod_n: f64,
    /// Motor torque that the circuit's pressures make, forward, Nm.
    pub(super) torque_nm: f64,
    /// Share of the rolling resistance that acts, -1 to 1: against the wheel's turning.
    pub(super) rolls: f64,
}
