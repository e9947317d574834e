//! The inertial unit on the front frame: angular rates, and the specific force it feels.

use crate::effects::ImuOffset;
use crate::{Effects, VehicleState};

/// What the unit reads, in its own axes: x forward, y left, z up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImuSample {
    /// Angular rate, rad/s.
    pub rate_rad_s: [f64; 3],
    /// Specific force, m/s²: standing level it is (0, 0, g).
    pub specific_force_m_s2: [f64; 3],
}

/// The unit; ideal and level in the nominal machine.
#[derive(Clone, Copy, Debug, Default)]
pub struct Imu {
    offset: ImuOffset,
}

impl Imu {
    /// A unit mounted as the effects say.
    #[must_use]
    pub const fn new(effects: &Effects) -> Self {
        Self { offset: effects.sensors.imu_offset }
    }

    /// What it reads in this state.
    #[must_use]
    pub fn step(self, state: &VehicleState) -> ImuSample {
        ImuSample {
            rate_rad_s: self.offset.into_unit(state.front_rate_rad_s),
            specific_force_m_s2: self.offset.into_unit(state.front_specific_force_m_s2),
        }
    }
}
