//! The currents that a steering valve takes (facts 4.6).

/// Valve current at rest, and at full joystick on a valve of its own and on the rear one when both
/// steer, mA.
pub(super) const REST_MA: i32 = 415;
pub(super) const FULL_MA: i32 = 730;
pub(super) const REAR_MA: i32 = 500;

/// Currents for so much above the valve's rest; at rest none flows.
pub(super) const fn written(above_ma: i32, a: bool) -> [i32; 2] {
    if above_ma <= 0 {
        [0; 2]
    } else if a {
        [REST_MA + above_ma, 0]
    } else {
        [0, REST_MA + above_ma]
    }
}
