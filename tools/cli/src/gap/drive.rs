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
            None => unnamed(name)?,
        };
        write_drive(&out, &manoeuvre, "shows what a diagnosis missed")?;
        Ok(Verdict::Positive)
    }
}

/// Where a drive goes that nobody gave a file for: what is there under its name must be a drive too.
fn unnamed(name: &str) -> Result<PathBuf, Failure> {
    let out = PathBuf::from(format!("{name}.toml"));
    if is_other(&out, Manoeuvre::is_scenario) {
        let problem = "is there and is not a drive; name another file with --out";
        return Err(format!("{} {problem}", out.display()).into());
    }
    Ok(out)
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
pub(super) fn ensure_free(path: &Path) -> Result<(), Failure> {
    let script = script_beside(path);
    if is_other(&script, Manoeuvre::wrote) {
        let (script, path) = (script.display(), path.display());
        let problem = "is there and is not the script of a drive";
        return Err(format!("{script} {problem}; give another name than {path}").into());
    }
    Ok(())
}

/// Writes `manoeuvre` into `path`, and its script beside it.
pub(super) fn write_drive(
    path: &Path,
    manoeuvre: &Manoeuvre,
    good_for: &str,
) -> Result<(), Failure> {
    ensure_free(path)?;
    let script = script_beside(path);
    // Half a drive is none.
    writable([script.as_path(), path])?;
    let name = script.file_name().unwrap_or_default().to_string_lossy().into_owned();
    write(&script, &manoeuvre.script())?;
    write(path, &manoeuvre.scenario(&name, good_for))
}
