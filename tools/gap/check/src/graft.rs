//! Faults of reading laid over logs of other people's machines: cases whose answer is known, of a machine that
//! nobody here has modelled.
//!
//! What a sensor says and no controller of the test used can be wrong in the log alone: the machine moved as it
//! would have. So a log of a machine whose answer is known becomes that of the same machine with one more
//! thing wrong, and a handful of labelled machines becomes as many cases as one likes.

mod fault;
mod known;
mod strange;

use std::path::{Path, PathBuf};

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use xt28_gap::FieldLog;
use xt28_sim::effects::{Block, Scope};

use crate::truth::{Kind, Truth};
use crate::{CheckError, Source};
use fault::Fault;

/// Kinds of ten cases with a graft, in turn: one thing wrong, two, or something that is in no catalogue.
const TURNS: [Kind; 10] = {
    use Kind::{Pair, Single, Unknown};
    [Single, Pair, Unknown, Single, Pair, Single, Pair, Unknown, Single, Pair]
};

/// A fault of reading with its wheels and its size.
#[derive(Clone, Debug)]
pub struct Graft {
    fault: &'static Fault,
    scope: Scope,
    values: Vec<f64>,
}

impl Graft {
    /// One of the catalogue's, or one that is in no catalogue; how large and at which wheels is drawn.
    fn draw(is_known: bool, random: &mut ChaCha8Rng) -> Self {
        let faults = if is_known { known::FAULTS } else { strange::FAULTS };
        let fault = &faults[random.random_range(0..faults.len())];
        let scopes: Vec<Scope> = Scope::ALL.into_iter().filter(|s| fault.can_be_on(*s)).collect();
        let scope = scopes[random.random_range(0..scopes.len())];
        Self { fault, scope, values: fault.draw(random) }
    }

    /// `log` as it would be had the readings been wrong.
    #[must_use]
    pub fn over(&self, log: FieldLog) -> FieldLog {
        let mut readings = log.all_series().clone();
        (self.fault.lay)(&mut readings, self.scope, &self.values);
        log.with_series(readings)
    }

    /// The answer of the case `name`, which is that of `base` with this beside; `path` names that in errors.
    fn answer(
        &self,
        name: &str,
        kind: Kind,
        base: &str,
        path: &Path,
    ) -> Result<String, CheckError> {
        let refuse =
            |problem: String| CheckError::Answer { path: path.to_owned(), line: 1, problem };
        let mut sheet: toml::Table =
            toml::from_str(base).map_err(|error| refuse(error.message().to_owned()))?;
        let numbers = self.fault.parameters.iter().zip(&self.values);
        let numbers =
            numbers.map(|(parameter, value)| (parameter.name.to_owned(), (*value).into()));
        let mut fact = toml::Table::new();
        fact.insert("effect".to_owned(), self.fault.name.into());
        fact.insert("scope".to_owned(), self.scope.to_string().into());
        fact.insert("parameters".to_owned(), toml::Value::Table(numbers.collect()));
        let facts = sheet.entry("truth").or_insert_with(|| toml::Value::Array(Vec::new()));
        let facts =
            facts.as_array_mut().ok_or_else(|| refuse("truth is no [[truth]]".to_owned()))?;
        facts.push(fact.into());
        sheet.insert("case".to_owned(), name.into());
        sheet.insert("kind".to_owned(), kind.to_string().into());
        // How large the gap of each run was says nothing of it any more.
        sheet.remove("run");
        Ok(sheet.to_string())
    }
}

/// `count` cases with a graft each, on those of `bases` in a folder that are sound, or have one effect that is
/// no sensor's.
///
/// # Errors
/// [`CheckError`] for an answer that cannot be read, or where there is no such base.
pub(crate) fn grafted(
    bases: &[Source],
    count: usize,
    random: &mut ChaCha8Rng,
) -> Result<Vec<Source>, CheckError> {
    let (mut sound, mut single) = (Vec::new(), Vec::new());
    for base in bases {
        let Source::Folder { folder, answer } = base else { continue };
        let text = base.answer_text()?;
        let truth = Truth::parse(&text, answer)?;
        let is_sensor = |fact: &crate::Fact| fact.effect.is_none_or(|e| e.block == Block::Sensor);
        match truth.kind {
            Kind::Null => sound.push((folder, answer, text)),
            Kind::Single if !truth.facts.iter().any(is_sensor) => {
                single.push((folder, answer, text));
            }
            _ => {}
        }
    }
    let mut one = |n: usize| {
        let wanted = TURNS[n % TURNS.len()];
        let (bases, kind) = match (wanted, sound.is_empty(), single.is_empty()) {
            (_, true, true) => return Err(CheckError::NoBase),
            (Kind::Pair, _, false) | (_, true, _) => (&single, Kind::Pair),
            (Kind::Pair, _, true) => (&sound, Kind::Single),
            _ => (&sound, wanted),
        };
        let (folder, answer, text) = &bases[random.random_range(0..bases.len())];
        let graft = Graft::draw(kind != Kind::Unknown, random);
        let case = folder.file_name().unwrap_or_default().to_string_lossy();
        let name = format!("{case}-graft-{}", n + 1);
        let answer_text = graft.answer(&name, kind, text, answer)?;
        Ok(Source::Grafted { name, folder: PathBuf::from(folder), graft, answer: answer_text })
    };
    (0..count).map(&mut one).collect()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use rand::SeedableRng;
    use xt28_sim::effects::find;

    use super::*;

    /// A set of three machines: one sound, one with a leak, one whose pressures are off.
    fn set() -> (tempfile::TempDir, Vec<Source>) {
        let folder = tempfile::tempdir().unwrap();
        let truth = |effect| format!("kind = \"single\"\n[[truth]]\neffect = \"{effect}\"\n");
        let of = [
            ("a", "kind = \"null\"\n".to_owned()),
            ("b", truth("LeakageDrift")),
            ("c", truth("PressureBias")),
        ];
        fs::create_dir(folder.path().join("answers")).unwrap();
        for (case, answer) in of {
            fs::create_dir(folder.path().join(case)).unwrap();
            fs::write(folder.path().join(case).join("about.toml"), "").unwrap();
            let answer = format!("case = \"{case}\"\n{answer}");
            fs::write(folder.path().join(format!("answers/{case}.toml")), answer).unwrap();
        }
        let bases = Source::in_folder(folder.path()).unwrap();
        (folder, bases)
    }

    fn of(bases: &[Source], count: usize) -> Result<Vec<Source>, CheckError> {
        grafted(bases, count, &mut ChaCha8Rng::seed_from_u64(3))
    }

    #[test]
    fn every_graft_has_an_answer_of_its_kind() {
        let (_folder, bases) = set();
        let sources = of(&bases, 40).unwrap();
        let mut kinds = [0; 4];
        for source in &sources {
            let text = source.answer_text().unwrap();
            let truth = Truth::parse(&text, &source.answer_path()).unwrap();
            assert_eq!(truth.case, source.name());
            kinds[truth.kind as usize] += 1;
            assert!(!source.name().starts_with('c'), "a sensor is at fault there already");
            assert_eq!(truth.kind == Kind::Pair, source.name().starts_with('b'));
        }
        assert_eq!(kinds, [0, 16, 16, 8]);
    }

    #[test]
    fn the_same_seed_lays_the_same_faults() {
        let (_folder, bases) = set();
        let answers = || of(&bases, 12).unwrap().iter().map(|s| s.answer_text().unwrap()).collect();
        let (one, other): (Vec<String>, Vec<String>) = (answers(), answers());
        assert_eq!(one, other);
    }

    #[test]
    fn a_set_without_a_base_is_refused() {
        let (_folder, bases) = set();
        let error = of(&bases[2..], 1).unwrap_err().to_string();
        assert!(error.contains("no case to lay a fault over"), "{error}");
    }

    #[test]
    fn known_faults_are_the_catalogues_and_strange_ones_are_not() {
        for fault in known::FAULTS {
            let effect = find(fault.name).unwrap();
            assert_eq!(effect.block, Block::Sensor);
            assert_eq!(effect.has_scope(), fault.has_wheels(), "{}", fault.name);
            for parameter in fault.parameters {
                assert!(effect.parameter(parameter.name).is_some(), "{}", parameter.name);
            }
        }
        for fault in strange::FAULTS {
            assert!(find(fault.name).is_none(), "{}", fault.name);
        }
    }
}
