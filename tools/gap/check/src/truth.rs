//! What is wrong with a case's machine, as its answer says.
//!
//! Answers of our own plants and of others' have one form: `case`, `kind`, and a `[[truth]]` for each
//! thing that is wrong. Others may add how large the gap of each run is; nothing else is let through.

mod parameters;
mod spelling;

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use serde::{Deserialize, Serialize};
use toml::Spanned;
use xt28_sim::effects::{CATALOGUE, Effect, Parameter, Scope, find};

use crate::CheckError;

/// How much is wrong with a machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// Nothing beyond ordinary tolerances.
    Null,
    /// One effect of the catalogue.
    Single,
    /// Two of them.
    Pair,
    /// Something that no catalogue has.
    Unknown,
}

/// The truth about one case.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// Name of the case.
    pub case: String,
    /// How much is wrong.
    pub kind: Kind,
    /// What is wrong.
    pub facts: Vec<Fact>,
}

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct Fact {
    /// Its name, in the spelling of the catalogue.
    pub name: String,
    /// The effect of the catalogue; `None` for what is in no catalogue.
    pub effect: Option<&'static Effect>,
    /// Its wheels; all of them where it has none.
    pub scope: Scope,
    /// When it begins, s from a run's start.
    pub start_s: f64,
    /// The run in which it begins for good, by file name; none where it begins in every run.
    pub start_run: Option<String>,
    /// Those of its numbers that the catalogue has too, in the catalogue's units.
    pub parameters: Vec<(&'static Parameter, f64)>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(dead_code)] // Named so that a key that is none of them is refused.
struct Sheet {
    case: String,
    kind: Spanned<Kind>,
    seed: Option<u64>,
    variant: Option<u64>,
    units: Option<BTreeMap<String, String>>,
    #[serde(default)]
    truth: Vec<Line>,
    #[serde(default)]
    run: Vec<Gap>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(dead_code)] // As above.
struct Line {
    effect: Spanned<String>,
    group: Option<String>,
    scope: Option<Spanned<String>>,
    target_signal: Option<String>,
    #[serde(default)]
    start_s: f64,
    start_run: Option<String>,
    #[serde(default)]
    parameters: BTreeMap<String, f64>,
}

/// Gap of one run by signal; units are those of the answer.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(dead_code)] // As above.
struct Gap {
    scenario: String,
    oracle_gap_rmse: Option<BTreeMap<String, f64>>,
    nuisance_gap_rmse: Option<BTreeMap<String, f64>>,
    worst_component_ratio: Option<BTreeMap<String, f64>>,
}

impl Truth {
    /// Reads an answer; `path` names it in errors.
    ///
    /// # Errors
    /// [`CheckError::Answer`] for what is no answer, for an effect or a scope that there is not, and
    /// for a `kind` that does not go with the number of truths.
    pub fn parse(text: &str, path: &Path) -> Result<Self, CheckError> {
        let refuse = |at: usize, problem: String| {
            let line = text.as_bytes()[..at.min(text.len())].iter().filter(|&&b| b == b'\n');
            CheckError::Answer { path: path.to_owned(), line: line.count() + 1, problem }
        };
        let sheet: Sheet = toml::from_str(text).map_err(|error| {
            let at = error.span().map_or(0, |span| span.start);
            refuse(at, error.message().replace('\n', " "))
        })?;
        let kind = *sheet.kind.get_ref();
        let facts = sheet.truth.into_iter().map(|line| line.fact(kind));
        let facts = facts.collect::<Result<Vec<_>, _>>().map_err(|(at, what)| refuse(at, what))?;
        let (fits, wanted) = match kind {
            Kind::Null => (facts.is_empty(), "no [[truth]]"),
            Kind::Single => (facts.len() == 1, "one [[truth]]"),
            Kind::Pair => (facts.len() == 2, "two [[truth]]"),
            Kind::Unknown => (!facts.is_empty(), "a [[truth]]"),
        };
        if !fits {
            let problem = format!("kind = \"{kind}\" goes with {wanted}, not {}", facts.len());
            return Err(refuse(sheet.kind.span().start, problem));
        }
        Ok(Self { case: sheet.case, kind, facts })
    }

    /// Whether the answer is in the catalogue: a single effect or a pair.
    #[must_use]
    pub fn is_nameable(&self) -> bool {
        matches!(self.kind, Kind::Single | Kind::Pair)
    }

    /// Whether `effect` is one of those at work.
    #[must_use]
    pub fn has(&self, effect: &Effect) -> bool {
        self.facts.iter().any(|fact| fact.effect == Some(effect))
    }

    /// Whether `effect` is at work at `scope`; the scope of an effect that has none does not matter.
    #[must_use]
    pub fn has_at(&self, effect: &Effect, scope: Scope) -> bool {
        let there = |fact: &&Fact| !effect.has_scope() || fact.scope == scope;
        self.facts.iter().filter(there).any(|fact| fact.effect == Some(effect))
    }
}

impl Line {
    /// The fact, or where and what is wrong.
    fn fact(self, kind: Kind) -> Result<Fact, (usize, String)> {
        let name = spelling::kebab(self.effect.get_ref());
        // What is in no catalogue may have any name, by accident also one that is in it.
        let effect = if kind == Kind::Unknown { None } else { find(&name) };
        if effect.is_none() && kind != Kind::Unknown {
            let known = CATALOGUE.iter().map(|effect| effect.name);
            let hint = spelling::nearest(&name, known)
                .map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
            let problem = format!(
                "`{}` is no effect of the catalogue{hint} (`xt28 effects` lists them; kind = \"unknown\" takes any name)",
                self.effect.get_ref()
            );
            return Err((self.effect.span().start, problem));
        }
        let scope = self.scope.map_or(Ok(Scope::All), |scope| {
            scope.get_ref().parse().map_err(|error| (scope.span().start, format!("{error}")))
        })?;
        let translate = |(name, value): (&String, &f64)| {
            effect.and_then(|effect| parameters::translate(effect, name, *value))
        };
        let parameters = self.parameters.iter().filter_map(translate).collect();
        let (start_s, start_run) = (self.start_s, self.start_run);
        Ok(Fact { name, effect, scope, start_s, start_run, parameters })
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Null => "null",
            Self::Single => "single",
            Self::Pair => "pair",
            Self::Unknown => "unknown",
        })
    }
}

impl fmt::Display for Fact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.effect {
            Some(effect) if !effect.has_scope() => write!(f, "{}", self.name),
            _ => write!(f, "{} {}", self.name, self.scope),
        }
    }
}

impl fmt::Display for Truth {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.facts.is_empty() {
            return f.write_str("nothing");
        }
        let facts: Vec<String> = self.facts.iter().map(ToString::to_string).collect();
        f.write_str(&facts.join(" + "))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use xt28_gap_plants::{Case, Kind as Drawn};

    use super::*;

    const PAIR: &str = r#"case = "dev-99"
seed = 7
variant = 1
kind = "pair"
units = { stroke = "mm" }

[[truth]]
effect = "ValveDeadband"
group = "arms"
scope = "rear"
parameters = { deadband = 0.04 }
target_signal = "stroke"
start_s = 0

[[truth]]
effect = "SteerBacklash"
scope = "all"
parameters = { width_deg = 2.7354, colour = 3 }

[[run]]
scenario = "arm_step"
oracle_gap_rmse = { stroke = 13, load = 934.25 }
nuisance_gap_rmse = { stroke = 0.3 }
"#;

    fn parse(text: &str) -> Result<Truth, CheckError> {
        Truth::parse(text, Path::new("answers/dev-99.toml"))
    }

    #[test]
    fn another_s_answer_is_read_in_our_terms() {
        let truth = parse(PAIR).unwrap();
        assert_eq!(truth.to_string(), "valve-deadband rear + steer-backlash");
        assert_eq!((truth.case.as_str(), truth.kind), ("dev-99", Kind::Pair));
        assert_eq!(truth.facts[0].parameters[0].0.name, "deadband");
        // The colour is no number of the catalogue's.
        assert_eq!(truth.facts[1].parameters.len(), 1);
        let [deadband, backlash] = ["valve-deadband", "steer-backlash"].map(|n| find(n).unwrap());
        assert!(truth.has(deadband) && !truth.has(find("arm-delay").unwrap()));
        assert!(!truth.has_at(deadband, Scope::All));
        assert!(truth.has_at(backlash, Scope::Axle(xt28_machine::Axle::Front)), "it has no wheel");
    }

    #[test]
    fn what_is_wrong_is_said_with_file_and_line() {
        for (from, to, says) in [
            (
                "ValveDeadband",
                "ValveDedband",
                ":8: `ValveDedband` is no effect of the catalogue; did you mean `valve-deadband`?",
            ),
            ("\"rear\"", "\"back\"", ":10: \"back\" is no scope"),
            ("\"pair\"", "\"single\"", ":4: kind = \"single\" goes with one [[truth]], not 2"),
            ("\"pair\"", "\"couple\"", ":4: unknown variant `couple`"),
            ("group = ", "gruop = ", ":9: unknown field `gruop`"),
            ("0.04", "\"much\"", ":11: invalid type"),
            ("[[run]]", "[[runs]]", ":20: unknown field `runs`"),
            ("kind = \"pair\"\n", "", "missing field `kind`"),
        ] {
            let error = parse(&PAIR.replacen(from, to, 1)).unwrap_err().to_string();
            assert!(error.starts_with("answers/dev-99.toml:"), "{error}");
            assert!(error.contains(says), "{error}");
        }
    }

    #[test]
    fn what_is_in_no_catalogue_may_have_any_name() {
        let text = "case = \"a\"\nkind = \"unknown\"\n[[truth]]\neffect = \"HauntedGearbox\"\n";
        let truth = parse(text).unwrap();
        assert_eq!(truth.to_string(), "haunted-gearbox all");
        assert!(truth.facts[0].effect.is_none() && !truth.is_nameable());
    }

    #[test]
    fn the_answers_of_our_own_plants_are_read_too() {
        for (seed, kind) in (0..40)
            .zip([Drawn::Null, Drawn::Single, Drawn::Pair, Drawn::Unknown].into_iter().cycle())
        {
            let answer = Case::draw(seed, kind).answer();
            let truth = parse(&answer.text()).unwrap();
            assert_eq!(truth.kind.to_string(), answer.kind);
            let names: Vec<_> = truth.facts.iter().map(|fact| fact.name.as_str()).collect();
            assert_eq!(names, answer.truth.iter().map(|f| f.effect.as_str()).collect::<Vec<_>>());
        }
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "((case|kind|truth|effect|scope|\\[\\[truth\\]\\]|[a-z]{0,6}) ?=? ?[\\[\\]{}\"a-z.,0-9 ä-]{0,24}\n){0,8}") {
            let _ = parse(&text);
        }

        #[test]
        fn no_damage_panics(at in 0..PAIR.len(), len in 0_usize..12, by in "[\"=\\[\\]{}a-zA-Zä0-9\n]{0,4}") {
            let mut text = PAIR.to_owned();
            text.replace_range(at..(at + len).min(PAIR.len()), &by);
            let _ = parse(&text);
        }
    }
}
