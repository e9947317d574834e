//! Each effect withheld in turn: what a machine with it makes a diagnosis say that has never heard of
//! it.
//!
//! It must not name another effect in its stead, unless one that nothing in these logs tells from it;
//! and it must look in the right place.

use rand::seq::IndexedRandom;
use rand::{RngCore, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;
use xt28_gap::diagnosis::{Cause, Diagnosis, Generator, Inquiry, Verdict};
use xt28_gap_plants::{Case, Cause as Fault, Scope as Wheels, Scopes};
use xt28_machine::{Machine, Wheel};
use xt28_sim::effects::{CATALOGUE, Effect, Scope};

use crate::source::Source;
use crate::{CheckError, Score, crew};

/// What came of withholding one effect.
#[derive(Clone, Debug, Serialize)]
pub struct Withheld {
    /// The effect.
    pub effect: &'static str,
    /// The machine, by whose seed it is drawn again.
    pub case: String,
    /// Its wheels on this machine; `all` where it has none.
    pub scope: String,
    /// What was said without it.
    pub verdict: Verdict,
    /// The likeliest cause named without it.
    pub named: Option<String>,
    /// Block and wheels whose gap says most.
    pub place: Option<String>,
    /// Whether it was called unknown, or by the name of one that these logs cannot tell from it.
    pub is_told: bool,
    /// Whether that is where the effect shows.
    pub is_placed: bool,
}

/// One machine for each effect of the catalogue that the foreign plants have, drawn from `seed`.
/// `told` hears of each that is done, from any thread.
///
/// # Errors
/// [`CheckError`] of the first machine whose logs cannot be made or read.
pub fn sweep(seed: u64, told: &(dyn Fn(&Withheld) + Sync)) -> Result<Vec<Withheld>, CheckError> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(2);
    let found = CATALOGUE.iter().filter_map(|effect| Some((effect, Fault::find(effect.name)?)));
    let machines: Vec<_> = found
        .map(|(effect, fault)| {
            let from = if fault.scopes == Scopes::Part { 1 } else { 0 };
            let wheels = *Wheels::EVERY[from..].choose(&mut random).expect("there are scopes");
            (effect, Case::of(u64::from(random.next_u32()), fault, wheels))
        })
        .collect();
    let one = |(effect, case): &(&'static Effect, Case)| {
        let withheld = withhold(effect, case)?;
        told(&withheld);
        Ok(withheld)
    };
    crew::each(&machines, one).into_iter().collect()
}

/// How many are told, and how many are placed.
#[must_use]
pub fn sweep_scores(all: &[Withheld]) -> [Score; 2] {
    [Score::share(all.iter().map(|w| w.is_told)), Score::share(all.iter().map(|w| w.is_placed))]
}

fn withhold(effect: &'static Effect, case: &Case) -> Result<Withheld, CheckError> {
    let scope: Scope = case.answer().truth[0].scope.parse().unwrap_or_default();
    let mut whole = Inquiry::new(Machine::xt28(), Source::Drawn(Box::new(case.clone())).runs()?);
    whole.how_far = false;
    let blind = whole.clone().without(effect).diagnose(&|_| ());
    let first = blind.causes.first();
    let is_told = match blind.verdict {
        Verdict::Unknown => true,
        Verdict::None => false,
        // Only a diagnosis that knows the effect can say what looks the same.
        Verdict::Effect => {
            first.is_some_and(|named| alike(&whole.diagnose(&|_| ()), effect, named))
        }
    };
    let place = blind.places.first();
    let is_placed = place.is_some_and(|place| {
        let hears = |generator: &Generator| generator.hears(effect, scope);
        let mut blocks = Generator::all().into_iter().filter(hears).map(Generator::block);
        blocks.any(|block| block == place.block) && meet(place.scope, scope)
    });
    Ok(Withheld {
        effect: effect.name,
        case: case.name().to_owned(),
        scope: scope.to_string(),
        verdict: blind.verdict,
        named: first.map(|cause| format!("{} {}", cause.effect.name, cause.scope)),
        place: place.map(|place| format!("{} {}", place.block, place.scope)),
        is_told,
        is_placed,
    })
}

/// Whether `whole` says that `named` and `effect` look the same.
fn alike(whole: &Diagnosis, effect: &Effect, named: &Cause) -> bool {
    let of = |one: &Effect, other: &Effect| {
        let mut causes = whole.causes.iter().filter(|cause| cause.effect == one);
        causes.any(|cause| cause.class.contains(&other.name))
    };
    of(effect, named.effect) || of(named.effect, effect)
}

fn meet(a: Scope, b: Scope) -> bool {
    Wheel::ALL.iter().any(|&wheel| a.contains(wheel) && b.contains(wheel))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scopes_that_share_a_wheel_meet() {
        let of = |name: &str| name.parse::<Scope>().unwrap();
        assert!(meet(of("front"), of("left")) && meet(of("all"), of("BR")));
        assert!(!meet(of("front"), of("rear")) && !meet(of("FL"), of("right")));
    }

    #[test]
    fn every_effect_of_the_catalogue_can_be_made() {
        for effect in CATALOGUE {
            assert!(Fault::find(effect.name).is_some(), "{}", effect.name);
        }
    }
}
