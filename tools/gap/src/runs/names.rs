//! What runs are called: by their file's name, with as much of its folder as tells it from the others.

use std::path::{Path, PathBuf};

use same_file::is_same_file;

use crate::{About, GapError};

/// A name for each of `paths`, no two alike where the paths are not: each day's first run may be `run-1.log`.
pub(super) fn names(paths: &[PathBuf]) -> Vec<String> {
    let name = |path: &PathBuf| {
        let others: Vec<&PathBuf> = paths.iter().filter(|other| *other != path).collect();
        let deepest = path.components().count().max(1);
        let mut ends = (1..=deepest).map(|parts| end_of(path, parts));
        let alone = |end: &PathBuf| !others.iter().any(|other| other.ends_with(end));
        let own = ends.clone().find(alone).or_else(|| ends.next_back());
        own.unwrap_or_default().display().to_string().replace('\\', "/")
    };
    paths.iter().map(name).collect()
}

/// The last so many parts of a path.
fn end_of(path: &Path, parts: usize) -> PathBuf {
    let all: Vec<_> = path.components().collect();
    all[all.len().saturating_sub(parts)..].iter().collect()
}

/// A name without its folder.
pub(super) fn bare(name: &str) -> &str {
    name.rsplit('/').next().unwrap_or(name)
}

/// Refuses `paths` of which two are one file, however it is spelt.
///
/// # Errors
/// [`GapError::SameLog`].
pub(super) fn ensure_each_once(paths: &[PathBuf]) -> Result<(), GapError> {
    for (i, again) in paths.iter().enumerate() {
        let first = paths[..i].iter().find(|first| is_same_file(first, again).unwrap_or(false));
        if let Some(first) = first {
            let [first, again] = [first, again].map(|path| path.display().to_string());
            return Err(GapError::SameLog { first, again });
        }
    }
    Ok(())
}

/// Refuses an `about`, read from `file`, of which one run would speak of two of the logs.
///
/// # Errors
/// [`GapError::Toml`].
pub(super) fn ensure_told_apart(
    about: &About,
    file: &Path,
    paths: &[PathBuf],
) -> Result<(), GapError> {
    for run in &about.run {
        let of = |path: &&PathBuf| about.run_of(path).is_some_and(|told| told.file == run.file);
        let mut told = paths.iter().filter(of);
        let Some(first) = told.next() else { continue };
        if let Some(other) = told.find(|other| *other != first) {
            let names = names(&[first.clone(), other.clone()]);
            let problem = format!(
                "run {} would speak of {} and of {}; write a [[run]] for each, with file = \"{}\" and file = \"{}\"",
                run.file,
                first.display(),
                other.display(),
                names[0],
                names[1]
            );
            let (path, line) = (file.to_owned(), about.line_of(run, "file"));
            return Err(GapError::Toml { path, line, problem });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_by_two_spellings_is_one() {
        let folder = tempfile::tempdir().unwrap();
        let plain = folder.path().join("a.log");
        std::fs::write(&plain, "").unwrap();
        let spelt = folder.path().join(".").join("a.log");
        let error = ensure_each_once(&[plain.clone(), spelt]).unwrap_err().to_string();
        assert!(error.contains("the same log as"), "{error}");
        let not_there = folder.path().join("b.log");
        assert!(ensure_each_once(&[plain, not_there.clone(), not_there]).is_ok());
    }

    fn paths(names: &[&str]) -> Vec<PathBuf> {
        names.iter().map(PathBuf::from).collect()
    }

    #[test]
    fn a_run_is_called_by_its_file_and_by_its_folder_only_where_it_must() {
        let all = paths(&["a/x/run-1.log", "b/x/run-1.log", "a/x/run-2.log", "run-3.log"]);
        assert_eq!(names(&all), ["a/x/run-1.log", "b/x/run-1.log", "run-2.log", "run-3.log"]);
        assert_eq!(names(&paths(&["run-1.log", "b/run-1.log"])), ["run-1.log", "b/run-1.log"]);
        assert_eq!(names(&paths(&["a.log", "a.log"])), ["a.log", "a.log"]);
        assert_eq!(["b/run-1.log", "run-1.log"].map(bare), ["run-1.log"; 2]);
    }

    #[test]
    fn one_run_of_an_about_speaks_of_one_log() {
        let of = |files: [&str; 2]| {
            let run = files.map(|file| format!("[[run]]\nfile = \"{file}\"\nterrain = \"flat\"\n"));
            let about = Path::new("about.toml");
            let told = About::parse(&format!("case = \"a\"\n{}", run.concat()), about).unwrap();
            let logs = paths(&["days/one/run-1.log", "days/two/run-1.log"]);
            ensure_told_apart(&told, about, &logs).map_err(|error| error.to_string())
        };
        let error = of(["run-0.log", "run-1.log"]).unwrap_err();
        assert!(error.starts_with("about.toml:6: run run-1.log would speak of "), "{error}");
        assert!(
            error.ends_with("file = \"one/run-1.log\" and file = \"two/run-1.log\""),
            "{error}"
        );
        assert_eq!(of(["one/run-1.log", "two/run-1.log"]), Ok(()));
        assert_eq!(of(["one/run-1.log", "run-1.log"]), Ok(()), "the nearer name goes first");
    }
}
