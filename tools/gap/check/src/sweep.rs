//! Each effect withheld in turn: what a machine with it makes a diagnosis say that has never heard of
//! it.
//!
//! It must not name another effect in its stead, unless one that nothing in these logs tells from it;
//! and it must look in the right place. What is too weak for the logs even where everybody has heard of it
//! is told apart: nobody can ask for it.

use rand::seq::IndexedRandom;
use rand::{RngCore, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;
use xt28_gap::diagnosis::{Cause, Diagnosis, Generator, Inquiry, Spot, Verdict};
use xt28_gap_plants::{Case, Cause as Fault, Scope as Wheels, Scopes};
use xt28_machine::Wheel;
use xt28_sim::effects::{Block, CATALOGUE, Effect, Scope};

use crate::examination::truth_of;
use crate::source::Source;
use crate::truth::Fact;
use crate::{CheckError, Score, crew};

/// What came of withholding what is wrong with one machine.
#[derive(Clone, Debug, Serialize)]
pub struct Withheld {
    /// The machine: that of a set, or the seed by which it is drawn again.
    pub case: String,
    /// What is wrong with it, `EFFECT SCOPE` each; the scope is `all` where an effect has none.
    pub truth: Vec<String>,
    /// What was said without it.
    pub verdict: Verdict,
    /// What speaks against the likeliest cause or pair, beside the most that does against a right one.
    pub left_over: f64,
    /// The likeliest cause named without it.
    pub named: Option<String>,
    /// Block and wheels whose gap says most.
    pub place: Option<String>,
    /// Whether it was called unknown, or by the name of one that these logs cannot tell from it.
    pub is_told: bool,
    /// Whether that is where the effect shows; of two, either.
    pub is_placed: bool,
    /// Whether these logs show anything: they do not where nothing was said without it, nor by a diagnosis
    /// that knows of it.
    pub is_shown: bool,
}

/// One machine for each effect of the catalogue that the foreign plants have, drawn from `seed`.
#[must_use]
pub fn one_of_each(seed: u64) -> Vec<Source> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(2);
    let drawn = |fault: &'static Fault| {
        let from = if fault.scopes == Scopes::Part { 1 } else { 0 };
        let wheels = *Wheels::EVERY[from..].choose(&mut random).expect("there are scopes");
        Source::Drawn(Box::new(Case::of(u64::from(random.next_u32()), fault, wheels)))
    };
    CATALOGUE.iter().filter_map(|effect| Fault::find(effect.name)).map(drawn).collect()
}

/// Each of `machines` that has effects of the catalogue, diagnosed as if nobody had heard of them.
/// `told` hears of each that is done, from any thread.
///
/// # Errors
/// [`CheckError`] of the first machine whose logs or answer cannot be made or read.
pub fn sweep(
    machines: &[Source],
    told: &(dyn Fn(&Withheld) + Sync),
) -> Result<Vec<Withheld>, CheckError> {
    let mut known = Vec::new();
    for machine in machines {
        let truth = truth_of(machine)?;
        if truth.is_nameable() {
            known.push((machine, truth.facts));
        }
    }
    let one = |(machine, facts): &(&Source, Vec<Fact>)| {
        let withheld = withhold(machine, facts)?;
        told(&withheld);
        Ok(withheld)
    };
    crew::each(&known, one).into_iter().collect()
}

/// How many are told, how many are placed, and the same of those whose logs show anything.
#[must_use]
pub fn sweep_scores(all: &[Withheld]) -> [Score; 4] {
    let shown = || all.iter().filter(|w| w.is_shown);
    [
        Score::share(all.iter().map(|w| w.is_told)),
        Score::share(all.iter().map(|w| w.is_placed)),
        Score::share(shown().map(|w| w.is_told)),
        Score::share(shown().map(|w| w.is_placed)),
    ]
}

fn withhold(machine: &Source, facts: &[Fact]) -> Result<Withheld, CheckError> {
    let mut whole = machine.inquiry()?;
    whole.how_far = false;
    let effects: Vec<_> =
        facts.iter().filter_map(|fact| Some((fact.effect?, fact.scope))).collect();
    let forgot = |inquiry: Inquiry, (effect, _): &(&Effect, Scope)| inquiry.without(effect);
    let blind = effects.iter().fold(whole.clone(), forgot).diagnose(&|_| ());
    let first = blind.causes.first();
    // Only a diagnosis that knows the effect can say what looks the same, and what nobody can see.
    let full = (blind.verdict != Verdict::Unknown).then(|| whole.diagnose(&|_| ()));
    let is_told = match (blind.verdict, first, &full) {
        (Verdict::Effect, Some(named), Some(full)) => {
            effects.iter().any(|(effect, _)| alike(full, effect, named))
        }
        (verdict, ..) => verdict == Verdict::Unknown,
    };
    let is_nothing = |said: &Diagnosis| said.verdict == Verdict::None;
    let is_shown = !(is_nothing(&blind) && full.as_ref().is_some_and(is_nothing));
    let place = blind.places.first().map(|place| &place.spot);
    let shows = |place: &Spot| effects.iter().any(|&(effect, on)| shows_at(effect, on, place));
    Ok(Withheld {
        case: machine.name(),
        truth: effects.iter().map(|(effect, on)| format!("{} {on}", effect.name)).collect(),
        verdict: blind.verdict,
        left_over: blind.grounds.left_over,
        named: first.map(|cause| format!("{} {}", cause.effect.name, cause.scope)),
        place: place.map(|place| format!("{} {}", place.block, place.scope)),
        is_told,
        is_placed: place.is_some_and(shows),
        is_shown,
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

/// Whether `effect` on these wheels shows at `place`.
fn shows_at(effect: &Effect, on: Scope, place: &Spot) -> bool {
    let hears = |generator: &Generator| generator.hears(effect, on);
    let mut blocks = Generator::all().into_iter().filter(hears).map(Generator::block);
    // How the machine stands takes a wheel off the ground by what another does.
    let reaches = place.block == Block::Payload || meet(place.scope, on);
    blocks.any(|block| block == place.block) && reaches
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
