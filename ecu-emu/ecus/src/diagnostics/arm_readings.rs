//! What the pendulum-arm ECU can be asked for.

use xt28_machine::PerWheel;

use super::uds::Reply;
use super::uds::identifier::{self, Identifier, Readings};
use crate::arm::ArmPins;
use crate::life::State;

/// One task period's values, in the units of `identifier::ARM`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ArmData {
    pub(crate) state: State,
    pub(crate) pins: Option<ArmPins>,
    pub(crate) stroke_mm: PerWheel<f64>,
    pub(crate) pressure_a_kpa: PerWheel<f64>,
    pub(crate) pressure_b_kpa: PerWheel<f64>,
    pub(crate) load_dan: PerWheel<f64>,
    /// Pitch, roll.
    pub(crate) attitude_deg: [f64; 2],
    /// Solenoids A and B of each valve.
    pub(crate) current_ma: PerWheel<[f64; 2]>,
}

impl Readings for ArmData {
    const IDENTIFIERS: &'static [Identifier] = identifier::ARM;

    fn state(&self) -> u8 {
        self.state.number()
    }

    fn supply_mv(&self) -> f64 {
        self.pins.map_or(0.0, |pins| pins.supply_mv)
    }

    fn write(&self, did: u16, reply: &mut Reply) {
        let pin =
            |of: fn(&ArmPins) -> PerWheel<f64>| self.pins.as_ref().map_or(PerWheel::splat(0.0), of);
        match did {
            0x0110 => reply.unsigned(&self.stroke_mm.0),
            0x0111 => reply.unsigned(&self.pressure_a_kpa.0),
            0x0112 => reply.unsigned(&self.pressure_b_kpa.0),
            0x0113 => reply.signed(&self.load_dan.0),
            0x0114 => reply.signed(&self.attitude_deg.map(|deg| deg * 100.0)),
            0x0115 => reply.unsigned(&self.current_ma.map(|[a, _]| a).0),
            0x0116 => reply.unsigned(&self.current_ma.map(|[_, b]| b).0),
            0x0210 => reply.unsigned(&pin(|pins| pins.stroke_mv).0),
            0x0211 => reply.unsigned(&pin(|pins| pins.pressure_a_mv).0),
            0x0212 => reply.unsigned(&pin(|pins| pins.pressure_b_mv).0),
            _ => unreachable!("the table lists no {did:04X}"),
        }
    }
}
