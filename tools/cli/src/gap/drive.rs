//! `xt28 gap drive`: the scripted test drives that a diagnosis asks for.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use clap::Args;
use xt28_gap::diagnosis::Manoeuvre;

use crate::files::{writable, write};
use crate::say::say;
use crate::{Failure, Verdict};

/// Write a scripted test drive for `xt28 run`, by the name that a diagnosis asks for it
///
/// Without NAME, says which there are. The scenario runs on the bench as it is; on a machine the gateway
/// plays the script beside it.
#[derive(Args)]
pub(crate) struct Drive {
    /// Name of the drive
    name: Option<String>,
    /// Where to write the scenario (TOML), and its script beside it; NAME.toml when left out
    #[arg(long, value_name = "OUT", requires = "name")]
    out: Option<PathBuf>,
}

impl Drive {
    pub(crate) fn execute(&self) -> Result<Verdict, Failure> {
        let names = || Manoeuvre::all().iter().map(|one| one.name).collect::<Vec<_>>().join(" ");
        let Some(name) = &self.name else {
            for one in Manoeuvre::all() {
                say!("{:<12} {:>4.0} s\n", one.name, one.end_s);
            }
            return Ok(Verdict::Positive);
        };
        let manoeuvre = Manoeuvre::find(name)
            .ok_or_else(|| format!("there is no drive '{name}'; there are {}", names()))?;
        let out = match &self.out {
            Some(out) if out.extension().is_some_and(|ending| ending == "toml") => out.clone(),
            Some(out) => {
                let problem = "a scenario's file ends in .toml; give --out such a name";
                return Err(format!("{}: {problem}", out.display()).into());
            }
            None => PathBuf::from(format!("{name}.toml")),
        };
        write_drive((&out, "--out"), &manoeuvre, "shows what a diagnosis missed")?;
        Ok(Verdict::Positive)
    }
}

/// Whether something is at `path` that is none of ours, in whatever encoding; what cannot be read is not ours.
fn is_other(path: &Path, is_ours: impl Fn(&str) -> bool) -> bool {
    match fs::read(path) {
        Ok(bytes) => !is_ours(&String::from_utf8_lossy(&bytes)),
        Err(error) => error.kind() != ErrorKind::NotFound,
    }
}

/// Where the script of a scenario at `path` goes.
pub(super) fn script_beside(path: &Path) -> PathBuf {
    path.with_extension("script.toml")
}

/// Refuses to replace a file beside `path` that nobody named and that is no drive's script.
fn ensure_free(path: &Path) -> Result<(), Failure> {
    let script = script_beside(path);
    if is_other(&script, Manoeuvre::wrote) {
        let (script, path) = (script.display(), path.display());
        let problem = "is there and is not the script of a drive";
        return Err(format!("{script} {problem}; give another name than {path}").into());
    }
    Ok(())
}

/// Refuses to replace what is at `path`, which `option` names, unless it is as a drive is written: that is made again
/// in a moment, and what somebody wrote or changed is not.
fn ensure_ours(path: &Path, option: &str, is_ours: impl Fn(&str) -> bool) -> Result<(), Failure> {
    // What is no file keeps nothing, and a file without a word has nothing to keep.
    if path.is_file() && is_other(path, |text| text.trim().is_empty() || is_ours(text)) {
        let problem = "it is there already and is no test drive as it was written";
        return Err(format!("{}: {problem}; give {option} another", path.display()).into());
    }
    Ok(())
}

/// Refuses what is at `path`, or where its script goes, and is no drive as it was written, whichever.
pub(super) fn ensure_a_drives(path: &Path, option: &str) -> Result<(), Failure> {
    ensure_free(path)?;
    let (script, name) = script_of(path);
    let all = Manoeuvre::all();
    // Its first line says what a drive is good for, which is told of each diagnosis anew.
    let body = |text: &str| text.split_once('\n').map(|(_, body)| body.to_owned());
    ensure_ours(path, option, |text| {
        let is_of = |one: &Manoeuvre| body(text) == body(&one.scenario(&name, ""));
        Manoeuvre::is_scenario(text) && all.iter().any(is_of)
    })?;
    ensure_ours(&script, option, |text| all.iter().any(|one| one.script() == text))
}

/// Where the script of a scenario at `path` goes, and how the scenario names it.
fn script_of(path: &Path) -> (PathBuf, String) {
    let script = script_beside(path);
    let name = script.file_name().unwrap_or_default().to_string_lossy().into_owned();
    (script, name)
}

/// What is said where no drive is written into `path`: one that is there is none of this answer, and would run.
pub(super) fn not_written(path: &Path) -> String {
    let script = script_beside(path);
    let older = [path, &script].into_iter().filter(|file| file.is_file());
    let older: Vec<String> = older.map(|file| file.display().to_string()).collect();
    let older = match older.join(" and ") {
        none if none.is_empty() => none,
        older => format!("; {older} there is older and was left as it was"),
    };
    format!("{} is not written{older}", path.display())
}

/// Writes `manoeuvre` into the file that an option names, and its script beside it.
pub(super) fn write_drive(
    (path, option): (&Path, &str),
    manoeuvre: &Manoeuvre,
    good_for: &str,
) -> Result<(), Failure> {
    ensure_a_drives(path, option)?;
    let (script, name) = script_of(path);
    let texts = (manoeuvre.scenario(&name, good_for), manoeuvre.script());
    // Half a drive is none.
    writable([script.as_path(), path])?;
    write(&script, &texts.1)?;
    write(path, &texts.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_older_drive_is_not_passed_over_in_silence_where_none_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let [path, script] = ["next.toml", "next.script.toml"].map(|name| folder.path().join(name));
        let (name, beside) = (path.display(), script.display());
        assert_eq!(not_written(&path), format!("{name} is not written"));
        let straight = Manoeuvre::find("straight").unwrap();
        write_drive((&path, "--next"), &straight, "tests nothing").unwrap();
        let left = "there is older and was left as it was";
        assert_eq!(
            not_written(&path),
            format!("{name} is not written; {name} and {beside} {left}")
        );
    }
}
