//! The valve's curve: current above the dead-band for a share of full flow (facts 3.6).

use super::whole::cut;

/// Below this share the valve stays shut, above the other it is driven fully open, %.
const SHARE_PERCENT: [f64; 2] = [2.5, 97.0];
/// Current above the dead-band of a fully open valve, mA.
const FULL_MA: f64 = 400.0;

/// Current above the dead-band for a flow of `percent` (-100 to 100) of the greatest, mA, whole,
/// with the flow's sign.
///
/// The firmware keeps it for controllers in units of flow, which nothing calls; so nothing of the
/// ECU uses it here either. It is the only published curve of the valve: monotonic, so its inverse
/// is a model of the valve.
#[must_use]
pub fn flow_to_current_ma(percent: f64) -> i32 {
    let [shut, full] = SHARE_PERCENT;
    let q = percent.abs();
    let ma = if q < shut {
        0.0
    } else if q > full {
        FULL_MA
    } else {
        let cubic = (1.172_549_76e-5 * q - 0.002_089_815_781_8) * q + 0.102_596_656_144_9;
        (cubic * q + 2.245_994_330_545_4) * q
    };
    cut(ma.copysign(percent))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The table of facts 3.6, cut off.
    #[test]
    fn the_published_table_is_met() {
        let table = [
            (0.0, 0),
            (2.4, 0),
            (2.5, 6),
            (10.0, 30),
            (25.0, 92),
            (50.0, 180),
            (75.0, 234),
            (90.0, 279),
            (97.0, 313),
            (97.1, 400),
        ];
        for (percent, ma) in table {
            assert_eq!(flow_to_current_ma(percent), ma, "{percent} %");
            assert_eq!(flow_to_current_ma(-percent), -ma);
        }
    }

    #[test]
    fn more_flow_never_takes_less_current() {
        let curve: Vec<i32> = (0..=1000).map(|q| flow_to_current_ma(f64::from(q) / 10.0)).collect();
        assert!(curve.is_sorted());
    }
}
