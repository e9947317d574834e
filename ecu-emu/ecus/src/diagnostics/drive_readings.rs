//! What the transmission and steering ECU can be asked for.

use xt28_machine::PerWheel;

use super::uds::Reply;
use super::uds::identifier::{self, Identifier, Readings};
use crate::drive::DrivePins;
use crate::life::State;

/// One task period's values.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct DriveData {
    pub(crate) state: State,
    pub(crate) pins: Option<DrivePins>,
    /// Front, rear; left > 0.
    pub(crate) joint_deg: [f64; 2],
    /// Forward > 0.
    pub(crate) wheel_rpm: PerWheel<f64>,
    /// 1A 1B 2A 2B.
    pub(crate) pump_bar: [f64; 4],
    pub(crate) engine_rpm: f64,
    /// 1A 1B 2A 2B.
    pub(crate) pump_ma: [f64; 4],
    pub(crate) motor_ma: PerWheel<f64>,
}

impl Readings for DriveData {
    const IDENTIFIERS: &'static [Identifier] = identifier::DRIVE;

    fn state(&self) -> u8 {
        self.state.number()
    }

    fn supply_mv(&self) -> f64 {
        self.pins.map_or(0.0, |pins| pins.supply_mv)
    }

    fn write(&self, did: u16, reply: &mut Reply) {
        let joint_mv = self.pins.map_or([0.0; 2], |p| [p.joint_front_mv, p.joint_rear_mv]);
        match did {
            0x0120 => reply.signed(&self.joint_deg.map(|deg| deg * 100.0)),
            0x0121 => reply.signed(&self.wheel_rpm.0.map(|rpm| rpm * 10.0)),
            0x0122 => reply.unsigned(&self.pump_bar.map(|bar| bar * 100.0)),
            0x0123 => reply.unsigned(&[self.engine_rpm * 8.0]),
            0x0124 => reply.unsigned(&self.pump_ma),
            0x0125 => reply.unsigned(&self.motor_ma.0),
            0x0220 => reply.unsigned(&joint_mv),
            0x0221 => reply.unsigned(&self.pins.map_or([0.0; 4], |p| p.pump_mv)),
            0x0222 => reply.unsigned(&self.pins.map_or([0.0; 6], |p| p.wheel_hz.0)),
            _ => unreachable!("the table lists no {did:04X}"),
        }
    }
}
