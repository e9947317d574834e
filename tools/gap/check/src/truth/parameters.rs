//! Numbers of other people's effects in the terms of the catalogue.

use xt28_sim::effects::{Effect, Parameter};

/// Units at the end of a name, and what one of them is in ours.
const UNITS: &[(&str, &str, f64)] = &[
    ("_mm_s", "_m_s", 1e-3),
    ("_mm", "_m", 1e-3),
    ("_ms", "_s", 1e-3),
    ("_deg_s", "_rad_s", std::f64::consts::PI / 180.0),
    ("_deg", "_rad", std::f64::consts::PI / 180.0),
    ("_kpa", "_pa", 1e3),
    ("_bar", "_pa", 1e5),
    ("_kn", "_n", 1e3),
    ("_knm", "_nm", 1e3),
    ("_l_min", "_m3_s", 1e-3 / 60.0),
    ("_l", "_m3", 1e-3),
];

/// The same quantity under another name: effect, their name, ours, and what one of theirs is.
const ALIASES: &[(&str, &str, &str, f64)] = &[
    ("payload", "ahead_m", "longitudinal_m", 1.0),
    ("seal-stiction", "breakaway_n", "stribeck_n", 1.0),
    ("engine-droop", "droop_per_20kw", "droop_per_w", 1.0 / 20e3),
];

/// The parameter of `effect` that is meant by `name`, with `value` in its unit. `None` where the
/// catalogue measures the effect by another quantity, so that the two cannot be compared.
pub(super) fn translate(
    effect: &'static Effect,
    name: &str,
    value: f64,
) -> Option<(&'static Parameter, f64)> {
    let name = name.to_lowercase();
    if let Some(parameter) = effect.parameter(&name) {
        return Some((parameter, value));
    }
    let alias = ALIASES.iter().find(|(of, theirs, ..)| *of == effect.name && *theirs == name);
    if let Some((_, _, ours, each)) = alias {
        return Some((effect.parameter(ours)?, value * each));
    }
    UNITS.iter().find_map(|(theirs, ours, each)| {
        let stem = name.strip_suffix(theirs)?;
        Some((effect.parameter(&format!("{stem}{ours}"))?, value * each))
    })
}

#[cfg(test)]
mod tests {
    use xt28_sim::effects::find;

    use super::*;

    #[test]
    fn units_and_names_are_translated_and_other_quantities_left_alone() {
        let of = |effect: &str, name: &str, value: f64| {
            translate(find(effect).unwrap(), name, value).map(|(p, v)| (p.name, v))
        };
        assert_eq!(of("arm-delay", "delay_s", 0.2), Some(("delay_s", 0.2)));
        assert_eq!(of("arm-delay", "delay_ms", 200.0), Some(("delay_s", 0.2)));
        assert_eq!(of("leakage-drift", "rate_mm_s", 7.0), Some(("rate_m_s", 0.007)));
        assert_eq!(of("pressure-bias", "bias_kpa", -500.0), Some(("bias_pa", -5e5)));
        let (name, width) = of("steer-backlash", "width_deg", 2.0).unwrap();
        assert!(name == "width_rad" && (width - 0.034_906_585).abs() < 1e-9);
        let (name, droop) = of("engine-droop", "droop_per_20kW", 0.2).unwrap();
        assert!(name == "droop_per_w" && (droop - 1e-5).abs() < 1e-18);
        assert_eq!(of("engine-droop", "power_kw", 4.8), None);
        assert_eq!(of("load-dependent-speed", "loss", 0.5), None);
    }

    #[test]
    fn every_alias_names_something() {
        for (effect, theirs, ours, _) in ALIASES {
            let effect = find(effect).unwrap();
            assert!(effect.parameter(ours).is_some() && effect.parameter(theirs).is_none());
        }
    }
}
