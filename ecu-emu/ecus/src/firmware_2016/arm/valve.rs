//! From mA about the dead-band to solenoid currents, and the soft limits (facts 3.6).

/// Current at which a valve opens, and the most above it, mA.
const DEAD_BAND_MA: i32 = 400;
const SPAN_MA: i32 = 400;
/// Below this stroke nothing retracts, above the other nothing extends, mm.
const SOFT_LIMIT_MM: [i32; 2] = [20, 460];

/// Currents `[A, B]` for `u_ma` about the dead-band: > 0 retracts by A, < 0 extends by B.
pub(super) fn solenoids_ma(u_ma: i32, stroke_mm: i32) -> [i32; 2] {
    let u_ma = u_ma.clamp(-SPAN_MA, SPAN_MA);
    let [low_mm, high_mm] = SOFT_LIMIT_MM;
    match u_ma {
        1.. if stroke_mm >= low_mm => [DEAD_BAND_MA + u_ma, 0],
        ..=-1 if stroke_mm <= high_mm => [0, DEAD_BAND_MA - u_ma],
        _ => [0, 0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_milliampere_already_opens_and_400_is_the_most() {
        assert_eq!(solenoids_ma(0, 250), [0, 0]);
        assert_eq!(solenoids_ma(1, 250), [401, 0]);
        assert_eq!(solenoids_ma(-1, 250), [0, 401]);
        assert_eq!(solenoids_ma(900, 250), [800, 0]);
        assert_eq!(solenoids_ma(-900, 250), [0, 800]);
    }

    #[test]
    fn soft_limits_stop_one_way_only() {
        assert_eq!([solenoids_ma(50, 19), solenoids_ma(50, 20)], [[0, 0], [450, 0]]);
        assert_eq!([solenoids_ma(-50, 461), solenoids_ma(-50, 460)], [[0, 0], [0, 450]]);
        assert_eq!([solenoids_ma(-50, 0), solenoids_ma(50, 500)], [[0, 450], [450, 0]]);
    }
}
