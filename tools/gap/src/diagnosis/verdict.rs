//! What a diagnosis says: where the gap is, what causes it, how far it shrinks, what would tell more.

use serde::{Serialize, Serializer};
use xt28_sim::effects::{Block, Effect, Parameter, Scope};

use super::beginning::Beginning;
use super::onset::Onset;
use super::scales::Grounds;
use super::vague_laws::size_share;

/// The whole answer to one machine's logs. Serialises to the form of `--json`.
#[derive(Clone, Debug, Serialize)]
pub struct Diagnosis {
    /// In one word.
    pub verdict: Verdict,
    /// Blocks on measured inputs, the gap that says most first.
    #[serde(rename = "where")]
    pub places: Vec<Place>,
    /// What the places' shares are of.
    pub share_of: ShareOf,
    /// The signal that the best of the catalogue leaves open, where something unknown is the matter; `null` in JSON
    /// elsewhere.
    pub unexplained: Option<Spot>,
    /// Causes, the likeliest first. Those with a probability above one half are stood by.
    #[serde(serialize_with = "as_told")]
    pub causes: Vec<Cause>,
    /// Probability that nothing is wrong beyond ordinary tolerances.
    pub probability_none: f64,
    /// Probability that what is wrong is not in the catalogue.
    pub probability_unknown: f64,
    /// Probability that an effect of the catalogue is there of which these logs show nothing.
    pub probability_unseen: f64,
    /// What these rest on.
    pub grounds: Grounds,
    /// All causes stood by, at once; `null` in JSON without any.
    pub together: Option<Together>,
    /// Runs that were not fitted, by file name; none where all were.
    pub held_out_runs: Vec<String>,
    /// Whether the next test drive was looked for.
    pub looked_ahead: bool,
    /// Manoeuvre that would tell likely causes apart best or, where none would, test most of what these
    /// logs do not; `null` in JSON without one.
    pub next: Option<Next>,
    /// Effects that these logs cannot show, each with the manoeuvre that would.
    pub not_testable: Vec<NotTestable>,
    /// What was taken for granted, and what was odd about the logs; whole sentences.
    pub notes: Vec<String>,
    /// What is wrong with the logs, message by message, where notes tell what befell many as one.
    pub log_faults: Vec<String>,
    /// Wall time of the diagnosis, s; set by who holds the clock.
    pub seconds: f64,
}

/// A diagnosis in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// One or two effects of the catalogue.
    Effect,
    /// Nothing beyond ordinary tolerances.
    None,
    /// Something, but nothing in the catalogue.
    Unknown,
}

impl Diagnosis {
    /// A verdict and its causes, with nothing said beside.
    #[must_use]
    pub const fn of(verdict: Verdict, causes: Vec<Cause>) -> Self {
        Self {
            verdict,
            places: Vec::new(),
            share_of: ShareOf::Squares,
            unexplained: None,
            causes,
            probability_none: 0.0,
            probability_unknown: 0.0,
            probability_unseen: 0.0,
            grounds: Grounds { evidence_nats: 0.0, left_over: 0.0 },
            together: None,
            held_out_runs: Vec::new(),
            looked_ahead: false,
            next: None,
            not_testable: Vec::new(),
            notes: Vec::new(),
            log_faults: Vec::new(),
            seconds: 0.0,
        }
    }
}

/// What the shares of places add up to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ShareOf {
    /// The squares of all blocks' gaps on measured inputs, as far as they go beyond noise.
    Squares,
    /// The whole machine's gap 5 s ahead, shared out among its blocks by Shapley's value.
    Machine,
}

/// A signal of a block, and the wheels that it is of.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spot {
    /// The block.
    #[serde(serialize_with = "as_text")]
    pub block: Block,
    /// Who watches it, by the name that it has wherever residuals are shown: "stance", "arm".
    pub part: &'static str,
    /// Its wheels.
    #[serde(serialize_with = "as_text")]
    pub scope: Scope,
    /// The signal that is compared.
    pub residual: String,
}

impl Spot {
    /// Whether its wheels say anything: a joint and the engine have none.
    #[must_use]
    pub fn has_wheels(&self) -> bool {
        self.block == Block::Arms || self.scope != Scope::All
    }
}

/// One block on measured inputs.
#[derive(Clone, Debug, Serialize)]
pub struct Place {
    /// What is compared there.
    #[serde(flatten)]
    pub spot: Spot,
    /// Root mean square of what ordinary tolerances leave, in units of the noise floor.
    pub gap_over_noise: f64,
    /// Share that it carries of what [`Diagnosis::share_of`] says, 0 to 1.
    pub share: f64,
}

/// One cause at one scope.
#[derive(Clone, Debug, Serialize)]
pub struct Cause {
    /// The effect.
    #[serde(serialize_with = "name_of")]
    pub effect: &'static Effect,
    /// Its wheels.
    #[serde(serialize_with = "as_text")]
    pub scope: Scope,
    /// Wheels that it may be at, `scope` first, each with its share of the probability, 0 to 1.
    #[serde(serialize_with = "by_wheels")]
    pub scopes: Vec<(Scope, f64)>,
    /// Its parameters at each of `scopes`, in the order of the effect's; no part of the JSON.
    #[serde(skip)]
    pub values: Vec<Vec<f64>>,
    /// That this effect is at work at any wheels; calibrated, 0 to 1.
    pub probability: f64,
    /// Each parameter with its interval.
    #[serde(serialize_with = "by_name")]
    pub parameters: Vec<Estimate>,
    /// Names of the effects that these logs cannot tell from this one, itself first.
    pub class: Vec<&'static str>,
    /// When it began, where not before the logs; `null` in JSON where before.
    pub begins: Option<Beginning>,
    /// How far the gap shrinks on runs that were not fitted; on all where all were. `null` in JSON where it
    /// was not worked out.
    pub shrink: Option<Shrink>,
}

/// A cause below this probability is not worth telling from others.
pub(crate) const WORTH_TELLING: f64 = 0.01;

impl Cause {
    /// When it sets in.
    #[must_use]
    pub fn onset(&self) -> Onset {
        self.begins.as_ref().map_or(Onset::ALWAYS, |begins| begins.onset)
    }

    /// The other effects that these logs cannot tell from this one; none of what is all but ruled out.
    #[must_use]
    pub fn alike(&self) -> &[&'static str] {
        match &self.class[..] {
            [_, others @ ..] if self.probability >= WORTH_TELLING => others,
            _ => &[],
        }
    }
}

/// One parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Name with its unit, as in overlays.
    pub name: &'static str,
    /// Best value, and the ends of the 90 % interval.
    pub value: [f64; 3],
}

/// 5 % lie beyond this many standard deviations on either side.
const NINETY: f64 = 1.645;
/// How much wider an interval is than noise alone makes it.
const WIDER: f64 = 2.0;

impl Estimate {
    /// `value` of a parameter of `effect` that noise leaves uncertain by `sigma`.
    #[must_use]
    pub(super) fn new(effect: &Effect, parameter: &Parameter, value: f64, sigma: f64) -> Self {
        let size = value - parameter.neutral;
        let reach = NINETY * (WIDER * sigma).hypot(size_share(effect) * size);
        let [low, high] = parameter.range;
        let interval = [(value - reach).max(low), (value + reach).min(high)];
        Self { name: parameter.name, value: [value, interval[0], interval[1]] }
    }

    /// Its interval; of no width, as of a value that nobody fitted, it bounds nothing.
    #[must_use]
    pub(super) const fn interval(&self) -> [f64; 2] {
        let [_, low, high] = self.value;
        if low < high { [low, high] } else { [f64::NEG_INFINITY, f64::INFINITY] }
    }

    /// Standard deviation that the interval stands for, by its longer side: the other may end with the
    /// parameter's range. Infinite for an interval of no width, as of a value that nobody fitted.
    #[must_use]
    pub(super) fn deviation(&self) -> f64 {
        let [value, low, high] = self.value;
        let reach = (high - value).max(value - low);
        if reach > 0.0 { reach / NINETY } else { f64::INFINITY }
    }

    /// The same as logs that do not show it tell it: it may be anything that the law is made for.
    #[must_use]
    pub(super) fn untold(mut self, parameter: &Parameter) -> Self {
        let [_, low, high] = &mut self.value;
        [*low, *high] = parameter.range;
        self
    }

    /// The same with all of another's interval in its own.
    #[must_use]
    pub(super) fn reaching(mut self, other: &Self) -> Self {
        let [_, low, high] = &mut self.value;
        (*low, *high) = (low.min(other.value[1]), high.max(other.value[2]));
        self
    }
}

/// Share of the gap that goes once an effect is in the simulator: 1 is all of it, below 0 is worse.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Shrink {
    /// Blocks on measured inputs, a tenth of a second ahead.
    pub one_step: f64,
    /// The whole machine over 5 s from measured states.
    pub five_s: f64,
    /// The whole machine over whole runs.
    pub run: f64,
    /// 90 % bootstrap intervals of the three: over blocks of 5 s, of the third over runs and blocks in them.
    pub interval: [[f64; 2]; 3],
}

/// All causes at once.
#[derive(Clone, Debug, Serialize)]
pub struct Together {
    /// Names.
    pub effects: Vec<&'static str>,
    /// How far the gap shrinks with all of them.
    pub shrink: Shrink,
    /// How far a free model of the residuals without physics, fitted on the same runs, shrinks it.
    pub black_box: Shrink,
    /// File names of the runs that were not fitted, which the shrinks are of; none where all were: then
    /// they are of those.
    pub held_out_runs: Vec<String>,
}

/// A test drive worth making.
#[derive(Clone, Debug, Serialize)]
pub struct Next {
    /// Name of the scripted manoeuvre.
    pub manoeuvre: String,
    /// Effects that it tells apart, with the wheels of one that may be at several; none where it is for what
    /// it tests alone.
    pub separates: Vec<String>,
    /// How well it tells them apart: by how much the logarithm of the odds is expected to grow, nats; `null` in
    /// JSON where it is for what it tests alone.
    pub nats: Option<f64>,
    /// Effects that the runs fitted do not test, or not at every wheel, and that it would.
    pub tests: Vec<&'static str>,
    /// The other manoeuvres, best first: those that no run is of or, where it is for what it tests alone,
    /// those that test something too.
    pub others: Vec<Drive>,
}

/// A manoeuvre and what it is worth.
#[derive(Clone, Debug, Serialize)]
pub struct Drive {
    /// Name of the scripted manoeuvre.
    pub manoeuvre: String,
    /// How well it tells apart, as in [`Next`], nats.
    pub nats: Option<f64>,
    /// Effects that the runs fitted do not test, or not at every wheel, and that it would.
    pub tests: Vec<&'static str>,
}

/// An effect that stays in the dark.
#[derive(Clone, Debug, Serialize)]
pub struct NotTestable {
    /// The effect.
    #[serde(serialize_with = "name_of")]
    pub effect: &'static Effect,
    /// What the logs lack.
    pub lacks: String,
    /// Scripted manoeuvre that would show it.
    pub manoeuvre: String,
    /// What that needs more of than it had, where it was driven and fitted.
    pub more: Option<String>,
    /// Runs held out that have what the fitted ones lack, by file name: to fit them shows it.
    pub fit: Vec<String>,
    /// Whether some wheels are tested all the same.
    pub in_part: bool,
}

impl NotTestable {
    /// What to do to have it tested: "fit run-6", "drive straight".
    #[must_use]
    pub fn remedy(&self) -> String {
        match (&self.fit[..], &self.more) {
            ([], None) => format!("drive {}", self.manoeuvre),
            ([], Some(more)) => format!("drive {} again, {more}", self.manoeuvre),
            (runs, _) => format!("fit {}", runs.join(" and ")),
        }
    }
}

fn as_text<T: ToString, S: Serializer>(value: &T, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(&value.to_string())
}

/// Causes, each beside those that it is worth telling it from.
fn as_told<S: Serializer>(all: &[Cause], to: S) -> Result<S::Ok, S::Error> {
    let told = |cause: &Cause| {
        let class = std::iter::once(cause.effect.name).chain(cause.alike().iter().copied());
        Cause { class: class.collect(), ..cause.clone() }
    };
    to.collect_seq(all.iter().map(told))
}

#[allow(clippy::trivially_copy_pass_by_ref)] // The shape that serde asks for.
fn name_of<S: Serializer>(effect: &&'static Effect, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(effect.name)
}

fn by_name<S: Serializer>(all: &[Estimate], to: S) -> Result<S::Ok, S::Error> {
    to.collect_map(all.iter().map(|estimate| (estimate.name, estimate.value)))
}

fn by_wheels<S: Serializer>(all: &[(Scope, f64)], to: S) -> Result<S::Ok, S::Error> {
    to.collect_map(all.iter().map(|(scope, share)| (scope.to_string(), share)))
}
