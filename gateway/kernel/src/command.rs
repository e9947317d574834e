//! What a policy asks of the machine, and what the kernel lets through: the same type.

/// Wheels, arms and cylinders, in the order FR FL MR ML BR BL.
pub const WHEELS: usize = 6;

/// One demand on all actuators.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Command {
    /// Share of full ground speed, -1 (reverse) to 1.
    pub throttle: f64,
    /// Target of the front articulation joint, rad, left > 0.
    pub front_angle_rad: f64,
    /// What the six arms are to do.
    pub arms: Arms,
    /// Parking brake on. Excludes throttle, also while it waits for the machine to stand.
    pub brake: bool,
}

/// What the six arms are to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Arms {
    /// Valves closed.
    Off,
    /// The arm ECU levels by itself.
    Automatic,
    /// Target strokes, m; `None` holds that arm where it is.
    Position([Option<f64>; WHEELS]),
    /// Valve openings, -1 to 1, positive extends.
    Valve([f64; WHEELS]),
}

impl Command {
    /// Nothing moves: no throttle, arms off, brake on, joint as it stands at `front_angle_rad`.
    #[must_use]
    pub const fn rest(front_angle_rad: f64) -> Self {
        Self { throttle: 0.0, front_angle_rad, arms: Arms::Off, brake: true }
    }

    /// True when no number in it is NaN or infinite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let arms = match self.arms {
            Arms::Off | Arms::Automatic => true,
            Arms::Position(strokes) => strokes.iter().flatten().all(|s| s.is_finite()),
            Arms::Valve(openings) => openings.iter().all(|o| o.is_finite()),
        };
        arms && self.throttle.is_finite() && self.front_angle_rad.is_finite()
    }
}
