//! Effects that a profile has nothing to do with: refused, as a run would show nothing of them.

use xt28_ecus::Profile;
use xt28_sim::effects::Entry;

/// Effects of what only the paper's ECUs have: loops closed on a commanded stroke or joint angle. The
/// firmware of 2016 has loops of its own, and valves that follow the cab. (Loss and jitter of frames it
/// hears of, if only on `CAN_1`, where a service tool tunes it.)
const OF_THE_PAPERS_ECUS: [&str; 3] = ["arm-gain", "steer-gain", "rear-follower-lag"];

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
        let mut names = effects.iter().map(|entry| entry.effect.name);
        let unheard = names.find(|name| OF_THE_PAPERS_ECUS.contains(name));
        unheard.map_or(Ok(()), |effect| Err(Self { effect }))
    }
}
