//! The inertial unit on the front frame: angular rates, and the specific force it feels.

use crate::VehicleState;

/// What the unit reads, in the front frame's axes: x forward, y left, z up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImuSample {
    /// Angular rate, rad/s.
    pub rate_rad_s: [f64; 3],
    /// Specific force, m/s²: standing level it is (0, 0, g).
    pub specific_force_m_s2: [f64; 3],
}

/// The unit; ideal in the nominal machine.
#[derive(Clone, Copy, Debug, Default)]
pub struct Imu;

impl Imu {
    /// What it reads in this state.
    #[must_use]
    pub const fn step(self, state: &VehicleState) -> ImuSample {
        ImuSample {
            rate_rad_s: state.front_rate_rad_s,
            specific_force_m_s2: state.front_specific_force_m_s2,
        }
    }
}
