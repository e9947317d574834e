//! A first-order lag over one step, exact for an input held over it.

/// The output `dt_s` s later, on its way from `output` to `input` with a time constant of
/// `time_constant_s` s. Without a time constant it is there at once, bit for bit.
#[must_use]
pub fn first_order(output: f64, input: f64, time_constant_s: f64, dt_s: f64) -> f64 {
    if time_constant_s <= 0.0 {
        return input;
    }
    input + (output - input) * (-dt_s / time_constant_s).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_at_63_percent_after_one_time_constant() {
        let mut output = 0.0;
        for _ in 0..60 {
            output = first_order(output, 1.0, 0.3, 0.005);
        }
        assert!((output - (1.0 - (-1.0_f64).exp())).abs() < 1e-12);
        assert_eq!(first_order(0.0, 0.7, 0.0, 0.005), 0.7);
    }
}
