//! Where cases come from: drawn foreign plants, or a folder of other people's logs with answers.

use std::fs;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use flate2::bufread::MultiGzDecoder;
use rand::{RngCore, SeedableRng};
use rand_chacha::ChaCha8Rng;
use xt28_gap::diagnosis::{FieldRun, Inquiry};
use xt28_gap::{About, Decoder, FieldLog, GapError, Known, Mapping, RunSet};
use xt28_gap_plants::{Case, Kind};
use xt28_machine::Machine;

use crate::CheckError;
use crate::graft::{Graft, grafted};

/// File with what one may know of a case.
const ABOUT: &str = "about.toml";

/// One case, before anyone has looked at it.
#[derive(Clone, Debug)]
pub enum Source {
    /// A foreign plant of ours; its logs are made when they are asked for.
    Drawn(Box<Case>),
    /// A folder with logs, and the file with its answer.
    Folder {
        /// Logs, DBC and `about.toml`.
        folder: PathBuf,
        /// The answer.
        answer: PathBuf,
    },
    /// Such a folder with a fault of reading laid over its logs.
    Grafted {
        /// Name of the case.
        name: String,
        /// Logs, DBC and `about.toml`.
        folder: PathBuf,
        /// The fault.
        graft: Graft,
        /// Text of its answer.
        answer: String,
    },
}

/// How many of 20 drawn cases are of each kind.
pub const MIX: [(Kind, usize); 4] =
    [(Kind::Null, 4), (Kind::Single, 10), (Kind::Pair, 3), (Kind::Unknown, 3)];

impl Source {
    /// `count` cases from `seed`: a fifth sound, half with one effect, 15 % with two, 15 % with
    /// something that no catalogue has, in turns so that any number of cases has about that mix.
    #[must_use]
    pub fn drawn(count: usize, seed: u64) -> Vec<Self> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        // Seeds of 32 bits are easier to type than of 64.
        let draw = |kind| Case::draw(u64::from(random.next_u32()), kind);
        turns(count).into_iter().map(draw).map(Box::new).map(Self::Drawn).collect()
    }

    /// The cases in `folder`, by name: its folders with an `about.toml`. Answers are `NAME.toml` in
    /// `answers` beside the folder or within it.
    ///
    /// # Errors
    /// [`CheckError::Read`], [`CheckError::Empty`] or [`CheckError::NoAnswer`].
    pub fn in_folder(folder: &Path) -> Result<Vec<Self>, CheckError> {
        let entries = fs::read_dir(folder).map_err(|source| CheckError::read(folder, source))?;
        let mut cases = Vec::new();
        for entry in entries {
            let path = entry.map_err(|source| CheckError::read(folder, source))?.path();
            if path.join(ABOUT).is_file() {
                cases.push(path);
            }
        }
        cases.sort();
        if cases.is_empty() {
            return Err(CheckError::Empty { path: folder.to_owned() });
        }
        let shelves = [folder.join("../answers"), folder.join("answers")];
        let with_answer = |folder: PathBuf| {
            let case = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let found =
                shelves.iter().map(|s| s.join(format!("{case}.toml"))).find(|a| a.is_file());
            let answer = found.ok_or_else(|| CheckError::NoAnswer {
                case,
                looked: format!("{} or {}", shelves[0].display(), shelves[1].display()),
            })?;
            Ok(Self::Folder { folder, answer })
        };
        cases.into_iter().map(with_answer).collect()
    }

    /// `count` cases made of those in `folder`, each with a fault of reading laid over its logs: one thing
    /// wrong on a sound machine, two on one with an effect that is no sensor's, or something that is in no
    /// catalogue on a sound one.
    ///
    /// # Errors
    /// As [`Source::in_folder`], [`CheckError::Answer`], and [`CheckError::NoBase`] for a folder without such
    /// machines.
    pub fn grafted(folder: &Path, count: usize, seed: u64) -> Result<Vec<Self>, CheckError> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        grafted(&Self::in_folder(folder)?, count, &mut random)
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Drawn(case) => case.name().to_owned(),
            Self::Folder { folder, .. } => {
                folder.file_name().unwrap_or_default().to_string_lossy().into_owned()
            }
            Self::Grafted { name, .. } => name.clone(),
        }
    }

    /// Where its answer is said to stand, in errors.
    #[must_use]
    pub fn answer_path(&self) -> PathBuf {
        match self {
            Self::Drawn(case) => PathBuf::from(format!("{}.answer.toml", case.name())),
            Self::Folder { answer, .. } => answer.clone(),
            Self::Grafted { name, .. } => PathBuf::from(format!("{name}.answer.toml")),
        }
    }

    /// The files that it is read from; what an `about.toml` that cannot be read would name is none.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        let (folder, answer) = match self {
            Self::Drawn(_) => return Vec::new(),
            Self::Folder { folder, answer } => (folder, Some(answer)),
            Self::Grafted { folder, .. } => (folder, None),
        };
        let path = folder.join(ABOUT);
        let about = About::load(&path).ok();
        let named = about.iter().flat_map(|about| {
            let logs = about.run.iter().map(|run| &run.file);
            logs.chain(&about.dbc).map(|file| folder.join(file))
        });
        let beside: Vec<PathBuf> = named.collect();
        std::iter::once(path).chain(answer.cloned()).chain(beside).collect()
    }

    /// Text of its answer, to be sealed and not to be looked at.
    ///
    /// # Errors
    /// [`CheckError::Read`].
    pub fn answer_text(&self) -> Result<String, CheckError> {
        match self {
            Self::Drawn(case) => Ok(case.answer().text()),
            Self::Folder { answer, .. } => {
                fs::read_to_string(answer).map_err(|source| CheckError::read(answer, source))
            }
            Self::Grafted { answer, .. } => Ok(answer.clone()),
        }
    }

    /// What a diagnosis is asked about it: its runs, and which of them are held out.
    ///
    /// # Errors
    /// [`CheckError`] for logs that cannot be made or read.
    pub fn inquiry(&self) -> Result<Inquiry, CheckError> {
        match self {
            Self::Drawn(case) => Ok(Inquiry::new(Machine::xt28(), runs_of(case)?)),
            Self::Folder { folder, .. } => inquiry_in(folder, |log| log),
            Self::Grafted { folder, graft, .. } => inquiry_in(folder, |log| graft.over(log)),
        }
    }
}

/// Kinds in turns, each as often as [`MIX`] says, whatever the number (largest remainder first).
fn turns(count: usize) -> Vec<Kind> {
    let total: usize = MIX.iter().map(|(_, share)| share).sum();
    let mut given = [0; MIX.len()];
    (1..=count)
        .map(|n| {
            // Behind by how much, in parts of the total; the first of equals.
            let behind = |i: usize| MIX[i].1 * n - (given[i] * total).min(MIX[i].1 * n);
            let next = (0..MIX.len()).rev().max_by_key(|&i| behind(i)).expect("there are kinds");
            given[next] += 1;
            MIX[next].0
        })
        .collect()
}

/// The runs of a drawn case, through the same text, bytes and reader as any field log.
fn runs_of(case: &Case) -> Result<Vec<FieldRun>, CheckError> {
    let about = About::parse(&case.about(), &PathBuf::from(case.name()).join(ABOUT))?;
    let decoder = Decoder::parse(&Case::dbc(), Path::new("xt28-field.dbc"), &Mapping::default())?;
    let mut runs = Vec::new();
    for (name, bytes) in case.logs()? {
        let path = PathBuf::from(case.name()).join(&name);
        let input = BufReader::new(MultiGzDecoder::new(bytes.as_slice()));
        let log = FieldLog::read(input, &path.display().to_string(), &decoder, false)?;
        runs.push(run(&about, &path, log)?);
    }
    Ok(runs)
}

/// What is asked of the logs in `folder`, each as `seen`.
fn inquiry_in(folder: &Path, seen: impl Fn(FieldLog) -> FieldLog) -> Result<Inquiry, CheckError> {
    let path = folder.join(ABOUT);
    let about = About::load(&path)?;
    let dbc = about.dbc.as_ref().ok_or_else(|| CheckError::NoDatabase { path: path.clone() })?;
    let decoder = Decoder::load(&folder.join(dbc), &Mapping::default())?;
    let logs: Vec<PathBuf> = about.run.iter().map(|listed| folder.join(&listed.file)).collect();
    if logs.is_empty() {
        return Err(CheckError::NoRuns { path });
    }
    let known = Known { about: Some(&path), is_asked: true, terrain: None };
    let runs = RunSet::load(&logs, &decoder, known, false)?.map_logs(seen);
    let choice = runs.choose(&[], &[])?;
    Ok(runs.into_inquiry(Machine::xt28(), &choice, false)?)
}

fn run(about: &About, path: &Path, log: FieldLog) -> Result<FieldRun, CheckError> {
    let known = about.run_of(path);
    let refuse = |problem: &str| GapError::Toml {
        path: path.with_file_name(ABOUT),
        line: 1,
        problem: problem.to_owned(),
    };
    let known = known.ok_or_else(|| refuse("the log is not listed; add it as [[run]]"))?;
    let terrain = known.terrain().map_err(refuse)?;
    Ok(FieldRun::new(log, terrain, known.fit)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_number_of_cases_has_about_the_mix() {
        for count in [1, 7, 20, 40, 63] {
            let turns = turns(count);
            assert_eq!(turns.len(), count);
            for (kind, share) in MIX {
                let has = turns.iter().filter(|k| **k == kind).count();
                assert!((has * 20).abs_diff(share * count) < 25, "{count}: {has} of {kind:?}");
            }
        }
    }

    #[test]
    fn the_same_seed_draws_the_same_cases_and_another_other_ones() {
        let names = |seed| Source::drawn(8, seed).iter().map(Source::name).collect::<Vec<_>>();
        assert_eq!(names(1), names(1));
        assert_ne!(names(1), names(2));
        // More cases are the same ones and some more.
        assert_eq!(
            names(1),
            Source::drawn(12, 1)[..8].iter().map(Source::name).collect::<Vec<_>>()
        );
    }

    #[test]
    fn a_folder_without_cases_or_answers_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let says = || Source::in_folder(folder.path()).unwrap_err().to_string();
        assert!(says().contains("no case here"), "{}", says());
        fs::create_dir(folder.path().join("one")).unwrap();
        fs::write(folder.path().join("one/about.toml"), "").unwrap();
        assert!(says().contains("one: no answer in"), "{}", says());
        fs::create_dir(folder.path().join("answers")).unwrap();
        fs::write(folder.path().join("answers/one.toml"), "").unwrap();
        assert_eq!(Source::in_folder(folder.path()).unwrap()[0].name(), "one");
        let nowhere = Source::in_folder(&folder.path().join("two")).unwrap_err().to_string();
        assert!(nowhere.contains("two: cannot read"), "{nowhere}");
    }
}
