//! Gains of the arm ECU's automatic mode: what the paper's cascade leaves open.

use serde::Deserialize;

/// The cascade of the automatic mode (paper 2.3.2): four controllers request forces, a PID turns
/// them into valve openings, an output stage into solenoid currents.
///
/// The paper gives the structure and no gain, so all of these are assumed: chosen with `cargo run
/// --release -p ecu-emu --example tune_levelling`, which prints what they cost and their stability
/// margins. A file may leave the section out.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Levelling {
    /// Mean stroke that is held when no command asks for another, m.
    pub height_m: f64,
    /// Force request of each arm per error of the mean stroke, N/m.
    pub height_n_m: f64,
    /// Force request of each arm, left against right, per roll, N/rad.
    pub roll_n_rad: f64,
    /// Force request of each front and rear arm per pitch, N/rad.
    pub pitch_n_rad: f64,
    /// Weights of height, roll, pitch and ground pressure in the sum of requests; 0 is off.
    pub weights: [f64; 4],
    /// Valve opening per force error, 1/N.
    pub force_kp_n: f64,
    /// Valve opening per force error and second, 1/(N s).
    pub force_ki_n_s: f64,
    /// Valve opening per rate of the measured force, s/N.
    pub force_kd_s_n: f64,
    /// Most that the integral part opens a valve, 0 to 1.
    pub integral_max: f64,
    /// Most that the automatic mode opens a valve, 0 to 1.
    pub opening_max: f64,
    /// Time constant of the solenoid current under its controller, s.
    pub solenoid_s: f64,
}

impl Default for Levelling {
    fn default() -> Self {
        Self {
            height_m: 0.25,
            height_n_m: 760e3,
            roll_n_rad: 340e3,
            pitch_n_rad: 1_160e3,
            weights: [1.0; 4],
            force_kp_n: 13.0e-6,
            force_ki_n_s: 1.3e-6,
            force_kd_s_n: 2.1e-6,
            integral_max: 0.05,
            opening_max: 0.5,
            solenoid_s: 0.008,
        }
    }
}

impl Levelling {
    /// What no controller can have, as key, value and remedy.
    pub(crate) fn fault(&self) -> Option<(&'static str, f64, &'static str)> {
        let bad = |weight: &f64| !(weight.is_finite() && *weight >= 0.0);
        let worst_weight = self.weights.into_iter().find(bad).unwrap_or(0.0);
        let at_least_zero = [
            ("levelling.height_m", self.height_m),
            ("levelling.height_n_m", self.height_n_m),
            ("levelling.roll_n_rad", self.roll_n_rad),
            ("levelling.pitch_n_rad", self.pitch_n_rad),
            ("levelling.weights", worst_weight),
            ("levelling.force_kp_n", self.force_kp_n),
            ("levelling.force_ki_n_s", self.force_ki_n_s),
            ("levelling.force_kd_s_n", self.force_kd_s_n),
            ("levelling.solenoid_s", self.solenoid_s),
        ];
        let negative = at_least_zero
            .into_iter()
            .find(|(_, value)| bad(value))
            .map(|(key, value)| (key, value, "it must be finite and at least zero"));
        let shares = [
            ("levelling.integral_max", self.integral_max),
            ("levelling.opening_max", self.opening_max),
        ];
        let no_share = shares
            .into_iter()
            .find(|(_, value)| !(0.0..=1.0).contains(value))
            .map(|(key, value)| (key, value, "it must lie between 0 and 1"));
        negative.or(no_share)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::Machine;

    #[test]
    fn the_built_in_machine_has_the_default_gains() {
        assert_eq!(Machine::xt28().levelling, Levelling::default());
    }

    #[test]
    fn a_gain_below_zero_and_a_share_above_one_are_refused() {
        for (key, bad) in [("roll_n_rad", "-1.0"), ("force_kp_n", "nan"), ("opening_max", "1.1")] {
            let text = format!("{}\n", Machine::builtin_text());
            let line = text.lines().find(|l| l.starts_with(key)).expect("the key is in the file");
            let text = text.replace(line, &format!("{key} = {bad}"));
            let error = Machine::parse(&text, Path::new("m.toml")).unwrap_err().to_string();
            assert!(error.contains(&format!("levelling.{key}")), "{error}");
        }
        let text = Machine::builtin_text().replace("weights = [1.0", "weights = [-inf");
        let error = Machine::parse(&text, Path::new("m.toml")).unwrap_err().to_string();
        assert!(error.contains("levelling.weights"), "{error}");
    }
}
