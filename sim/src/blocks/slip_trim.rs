//! The trim of a wheel that runs away from the others of its circuit.

/// A wheel this much off its circuit's mean is pulled back, rad/s (assumed: 4 rpm).
const FREE_RAD_S: f64 = 4.0 * core::f64::consts::TAU / 60.0;
/// Torque beyond that, Nm s (assumed).
pub(super) const GAIN_NMS: f64 = 6_000.0;

/// Torque that is taken from a wheel which turns by `off_rad_s` faster than its circuit's mean, Nm; given to
/// it where it is slower.
#[must_use]
pub fn slip_trim_nm(off_rad_s: f64) -> f64 {
    GAIN_NMS * (off_rad_s - off_rad_s.clamp(-FREE_RAD_S, FREE_RAD_S))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wheel_near_the_mean_is_left_alone_and_beyond_it_is_pulled_back_either_way() {
        assert!(slip_trim_nm(0.4) == 0.0 && slip_trim_nm(-0.4) == 0.0);
        let beyond_nm = GAIN_NMS * (1.0 - FREE_RAD_S);
        assert!((slip_trim_nm(1.0) - beyond_nm).abs() < 1e-9);
        assert!((slip_trim_nm(-1.0) + beyond_nm).abs() < 1e-9);
    }
}
