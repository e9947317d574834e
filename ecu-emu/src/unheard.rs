//! Effects that a profile has nothing to do with: refused, as a run would show nothing of them.

use xt28_ecus::Profile;
use xt28_sim::effects::Effect;

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
    /// Whether ECUs of `profile` hear of `effect`.
    ///
    /// # Errors
    /// They do not.
    pub fn check(profile: Profile, effect: &Effect) -> Result<(), Self> {
        let unheard = profile == Profile::Firmware2016;
        match OF_THE_PAPERS_ECUS.iter().find(|name| unheard && **name == effect.name) {
            Some(effect) => Err(Self { effect }),
            None => Ok(()),
        }
    }
}
