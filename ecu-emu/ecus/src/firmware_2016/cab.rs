//! What the cab has on the drive ECU's pins: pedals, chair, door, fuel and oil senders.

/// Signals of the cab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CabPins {
    /// Accelerators of the front and the rear pedal set, mV.
    pub gas_mv: [f64; 2],
    /// Brake pedals, likewise.
    pub brake_mv: [f64; 2],
    /// Chair switch, mV: above 6 V the chair is to the front.
    pub chair_mv: f64,
    /// Door input; low is open.
    pub door_high: bool,
    /// Fuel sender, ohm; 187 empty, 11 full.
    pub fuel_ohm: f64,
    /// Oil in the tank, degC.
    pub tank_oil_deg_c: f64,
}

impl CabPins {
    /// Nobody at the pedals, chair to the front, door shut, half a tank, oil at 40 degC (assumed).
    pub const IDLE: Self = Self {
        gas_mv: [500.0; 2],
        brake_mv: [500.0; 2],
        chair_mv: 24_000.0,
        door_high: true,
        fuel_ohm: 99.0,
        tank_oil_deg_c: 40.0,
    };
}

impl Default for CabPins {
    fn default() -> Self {
        Self::IDLE
    }
}
