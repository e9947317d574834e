//! The pressure compensator before a spool: what of the drop over it is left to the load.

/// Pressure that the pump holds when a compensator fails, Pa (assumed).
const SUPPLY_PA: f64 = 2.0e7;
/// Load at which a valve without compensator would be set to its nominal flow, Pa (assumed).
const SET_AT_PA: f64 = 7.0e6;

/// Flow over nominal flow. A sound compensator holds the drop, `loss` = 0; with `loss` = 1 the spool
/// is an orifice between pump, load and tank, with flow by the root of the drop.
///
/// `load_pa` is the pressure that resists extension; contracting, it drives the oil out.
pub(crate) fn flow_share(loss: f64, opening: f64, load_pa: f64) -> f64 {
    let drop = if opening >= 0.0 {
        (SUPPLY_PA - load_pa) / (SUPPLY_PA - SET_AT_PA)
    } else {
        load_pa.max(0.0) / SET_AT_PA
    };
    ((1.0 - loss) + loss * drop).max(0.05).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sound_one_does_not_know_the_load() {
        assert_eq!(flow_share(0.0, 0.3, 1.5e7), 1.0);
        assert_eq!(flow_share(0.0, -0.3, 1.0e6), 1.0);
    }

    #[test]
    fn a_failed_one_lifts_slowly_and_lowers_quickly_under_load() {
        assert!((flow_share(1.0, 0.3, 1.35e7) - 0.5_f64.sqrt()).abs() < 1e-12);
        assert!((flow_share(1.0, -0.3, 1.4e7) - 2.0_f64.sqrt()).abs() < 1e-12);
        assert!(flow_share(0.5, 0.3, 1.35e7) > flow_share(1.0, 0.3, 1.35e7));
    }
}
