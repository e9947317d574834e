//! Which runs causes are fitted on, and which are held out to judge them.

use super::names::bare;
use super::{KnownRun, RunSet};
use crate::GapError;

/// What each run of a set is for.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// One a run, in the set's order.
    pub uses: Vec<Use>,
    /// Who chose so, in one sentence.
    pub why: String,
    /// Whether somebody did: neither the command line nor `about.toml` says anything otherwise.
    pub is_advised: bool,
}

/// What a run is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// Causes are fitted on it.
    Fit,
    /// Causes are judged on it.
    Held,
    /// Neither.
    Left,
}

impl RunSet {
    /// The runs named in `fit` are fitted on, those in `held` are held out. With one of the two
    /// empty, the rest is for the other; with both empty it is as `about.toml` advises, else the last
    /// third is held out ([`crate::diagnosis::Inquiry::hold_out_what_others_show`] may know better). A run goes by
    /// file name (with or without its endings, with its folder where another has the same), by its beginning up to
    /// its number (`run-3` of `run-3-mixed.log`), by its place among the logs from 1, or by its scenario, which may be
    /// several runs.
    ///
    /// # Errors
    /// [`GapError::NoSuchRun`], [`GapError::AmbiguousRun`], [`GapError::FittedAndHeld`],
    /// [`GapError::NothingFitted`].
    pub fn choose(&self, fit: &[String], held: &[String]) -> Result<Choice, GapError> {
        let named = |names: &[String]| {
            let found: Result<Vec<Vec<usize>>, GapError> =
                names.iter().map(|name| self.find(name)).collect();
            found.map(|found| found.concat())
        };
        let (to_fit, to_hold) = (named(fit)?, named(held)?);
        let both: Vec<&str> =
            to_fit.iter().filter(|i| to_hold.contains(i)).map(|&i| self.file(i)).collect();
        if !both.is_empty() {
            return Err(GapError::FittedAndHeld { runs: both.join(", ") });
        }
        let choice = match (to_fit.is_empty(), to_hold.is_empty()) {
            (true, true) => self.unasked(),
            (no_fit, no_held) => {
                let used = |i: usize| match (to_fit.contains(&i), to_hold.contains(&i)) {
                    (true, _) => Use::Fit,
                    (_, true) => Use::Held,
                    _ if no_fit => Use::Fit,
                    _ if no_held => Use::Held,
                    _ => Use::Left,
                };
                let uses = (0..self.runs().len()).map(used).collect();
                Choice { uses, why: "as asked on the command line".to_owned(), is_advised: true }
            }
        };
        if choice.uses.contains(&Use::Fit) {
            Ok(choice)
        } else {
            Err(GapError::NothingFitted { why: choice.why })
        }
    }

    /// As `about.toml` advises; without it, or where it advises none, the last third, rounded up, is held out.
    fn unasked(&self) -> Choice {
        let runs = self.runs();
        let advised = |run: &KnownRun| run.advised == Some(true);
        if runs.iter().any(advised) {
            let uses = runs.iter().map(|run| if advised(run) { Use::Fit } else { Use::Held });
            let why = "as about.toml advises".to_owned();
            return Choice { uses: uses.collect(), why, is_advised: true };
        }
        let held_from = match runs.len() {
            0 | 1 => runs.len(),
            several => several - several.div_ceil(3),
        };
        let used = |i: usize| if i < held_from { Use::Fit } else { Use::Held };
        let why = if runs.len() < 2 {
            "there is only one run".to_owned()
        } else {
            let nobody = if runs.iter().any(|run| run.advised.is_some()) {
                "about.toml has fit = false for all of them"
            } else {
                "nobody said which"
            };
            format!(
                "{nobody}: a third is held out, rounded up, the last that show no effect the others do not"
            )
        };
        let uses = (0..runs.len()).map(used).collect();
        Choice { uses, why, is_advised: false }
    }

    fn file(&self, i: usize) -> &str {
        &self.runs()[i].file
    }

    /// Places of the runs that go by `name`.
    fn find(&self, name: &str) -> Result<Vec<usize>, GapError> {
        let runs = self.runs();
        let all = |is: &dyn Fn(usize, &KnownRun) -> bool| -> Vec<usize> {
            (0..runs.len()).filter(|&i| is(i, &runs[i])).collect()
        };
        let mut found = all(&|_, run| run.file == name || stem(&run.file) == name);
        if found.is_empty() {
            found = all(&|_, run| [bare(&run.file), stem(bare(&run.file))].contains(&name));
        }
        if found.is_empty() {
            found = all(&|_, run| run.scenario.as_deref() == Some(name));
        } else if found.len() > 1 {
            return Err(self.ambiguous(name, &found));
        }
        if let (true, Ok(number)) = (found.is_empty(), name.parse::<usize>()) {
            // `run-3-mixed.log` given second: 2 may mean its place, 3 its own number.
            found = all(&|i, run| i + 1 == number || own_number(bare(&run.file)) == Some(number));
            if found.len() > 1 {
                return Err(self.ambiguous(name, &found));
            }
        }
        // `run-3` is short for `run-3-mixed.log`.
        if let (true, Some(number)) = (found.is_empty(), number_alone(name)) {
            found = all(&|_, run| own_number(bare(&run.file)) == Some(number));
            if found.len() > 1 {
                return Err(self.ambiguous(name, &found));
            }
        }
        if found.is_empty() {
            return Err(GapError::NoSuchRun { name: name.to_owned(), known: self.known() });
        }
        Ok(found)
    }

    fn ambiguous(&self, name: &str, found: &[usize]) -> GapError {
        let runs: Vec<&str> = found.iter().map(|&i| self.runs()[i].log.name()).collect();
        GapError::AmbiguousRun { name: name.to_owned(), runs: runs.join(" and ") }
    }

    /// Every run by all of its names.
    fn known(&self) -> String {
        let one = |(i, run): (usize, &KnownRun)| match &run.scenario {
            Some(scenario) => format!("{} ({}, {scenario})", run.file, i + 1),
            None => format!("{} ({})", run.file, i + 1),
        };
        self.runs().iter().enumerate().map(one).collect::<Vec<_>>().join(", ")
    }
}

/// A file name without `.gz`, `.log` and the like.
fn stem(file: &str) -> &str {
    let bare = file.strip_suffix(".gz").unwrap_or(file);
    [".log", ".mcap", ".candump"].iter().find_map(|end| bare.strip_suffix(end)).unwrap_or(bare)
}

/// The number in `run-3`, and nothing behind it.
fn number_alone(name: &str) -> Option<usize> {
    name.strip_prefix("run-")?.parse().ok()
}

/// The number in `run-3-mixed.log`.
fn own_number(file: &str) -> Option<usize> {
    let digits = file.strip_prefix("run-")?;
    digits[..digits.find(|c: char| !c.is_ascii_digit())?].parse().ok()
}
