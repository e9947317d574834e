//! Everything the kernel may know at one step.

use crate::{Command, Limits, WHEELS};

/// What is asked and what is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Input {
    /// An order from the person or program in charge.
    pub order: Order,
    /// What the policy wants, `None` before its first answer.
    pub request: Option<Command>,
    /// What the sensors say now.
    pub measured: Measured,
    /// The parking brake is on: arming opens it for nobody who wants it closed.
    pub is_braked: bool,
    /// The arm ECU.
    pub arm: Link,
    /// The drive ECU.
    pub drive: Link,
    /// When the other streams last had news.
    pub stamps: Stamps,
    /// False from bus-off until the bus is well again. (Where the interface is gone there is nobody left to ask.)
    pub bus_ok: bool,
    /// False while somebody else commands the ECUs: they take either's frames, and acknowledge them to both.
    pub alone: bool,
}

/// What the one in charge wants of the kernel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// Nothing new.
    #[default]
    None,
    /// Begin the handshake.
    Arm,
    /// Stop letting anything through.
    Disarm,
    /// Stop, and refuse to arm until released.
    EmergencyStop,
    /// Release the emergency stop; arming is then a further order.
    Release,
}

/// Sensor values that limits are relative to. NaN where not known, which blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Strokes, m.
    pub stroke_m: [f64; WHEELS],
    /// Front joint, rad, left > 0.
    pub front_angle_rad: f64,
    /// Ground speed by the wheels, m/s, forward > 0.
    pub speed_m_s: f64,
    /// Roll, rad, right side high > 0.
    pub roll_rad: f64,
    /// Pitch, rad, nose up > 0.
    pub pitch_rad: f64,
}

impl Measured {
    /// Nothing is known yet.
    pub const UNKNOWN: Self = Self {
        stroke_m: [f64::NAN; WHEELS],
        front_angle_rad: f64::NAN,
        speed_m_s: f64::NAN,
        roll_rad: f64::NAN,
        pitch_rad: f64::NAN,
    };

    /// True when strokes and joint are where a sensor in order can read them.
    #[must_use]
    pub fn is_plausible(&self, limits: &Limits) -> bool {
        let [low_m, high_m] = limits.stroke_read_m;
        self.stroke_m.iter().all(|s| (low_m..=high_m).contains(s))
            && libm::fabs(self.front_angle_rad) <= limits.angle_read_rad
    }

    /// True when no number is NaN or infinite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.stroke_m.iter().all(|s| s.is_finite())
            && [self.front_angle_rad, self.speed_m_s, self.roll_rad, self.pitch_rad]
                .iter()
                .all(|x| x.is_finite())
    }
}

/// The talk with one ECU.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Link {
    /// When its status frame last came with a fresh alive counter, ns.
    pub heard_at_ns: Option<u64>,
    /// It says standby or active.
    pub ready: bool,
    /// Alive counter of the last command frame sent to it.
    pub sent: Option<u8>,
    /// Alive counter it says it accepted last.
    pub accepted: u8,
}

impl Link {
    /// True when the last accepted counter is one of the last few sent.
    #[must_use]
    pub const fn in_step(&self, lag_max: u8, modulus: u8) -> bool {
        match self.sent {
            Some(sent) if modulus > 0 && sent < modulus && self.accepted < modulus => {
                let lag = (sent as u16 + modulus as u16 - self.accepted as u16) % modulus as u16;
                lag <= lag_max as u16
            }
            _ => false,
        }
    }
}

/// When the streams last had news, ns; `None` for never.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stamps {
    /// The oldest of the sensors in [`Measured`].
    pub sensors_ns: Option<u64>,
    /// The observation that the policy last acted on, or was last shown.
    pub observation_ns: Option<u64>,
    /// The policy's last answer; of one that thinks elsewhere, the observation that it answers.
    pub policy_ns: Option<u64>,
}
