//! Effects that a profile has nothing to do with: refused, as a run would show nothing of them.

use xt28_ecus::Profile;
use xt28_sim::effects::Entry;

/// An effect that the profile of 2016 would pass over in silence.
#[derive(Debug, thiserror::Error)]
#[error(
    "\"{effect}\" acts in loops that the ECUs of profile 2016 have not: leave it out, or take profile paper"
)]
pub struct UnheardEffect {
    /// Its name in the catalogue.
    pub effect: &'static str,
}

impl UnheardEffect {
    /// Whether ECUs of `profile` hear of all `effects`.
    ///
    /// # Errors
    /// The first that they do not.
    pub fn check(profile: Profile, effects: &[Entry]) -> Result<(), Self> {
        if profile == Profile::Paper {
            return Ok(());
        }
        let unheard = effects.iter().find(|entry| is_of_the_papers_ecus(entry));
        unheard.map_or(Ok(()), |entry| Err(Self { effect: entry.effect.name }))
    }
}

/// Whether it changes a number of what only the paper's ECUs have: loops closed on a commanded stroke or joint angle. The
/// firmware of 2016 has loops of its own, and valves that follow the cab. (Loss and jitter of frames it hears of, if
/// only on `CAN_1`, where a service tool tunes it.)
fn is_of_the_papers_ecus(entry: &Entry) -> bool {
    entry.values.iter().any(|(parameter, value)| {
        *value != parameter.neutral && entry.effect.is_law_of_an_ecu(parameter)
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use xt28_sim::effects::Overlay;

    use super::*;

    #[test]
    fn a_slow_rear_valve_is_any_machines_and_a_slow_follower_the_papers() {
        let check = |numbers: &str| {
            let text = format!("[[effect]]\nname = \"rear-follower-lag\"\n{numbers}");
            let overlay = Overlay::parse(&text, Path::new("e.toml")).unwrap();
            UnheardEffect::check(Profile::Firmware2016, &overlay.entries).is_ok()
        };
        assert!(check("valve_time_constant_s = 0.3"));
        assert!(check("time_constant_s = 0.0\nvalve_time_constant_s = 0.3"));
        assert!(!check("time_constant_s = 0.3\nvalve_time_constant_s = 0.3"));
    }
}
