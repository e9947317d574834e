//! `xt28 scenarios`: the built-in scenarios, or the text of one.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;
use xt28_scenarios::{BUILTIN, Scenario, files_of};

use crate::files::{refusal, write};
use crate::say::{say, tell};
use crate::{Failure, Verdict};

/// List the built-in scenarios, or show one as a start for your own
#[derive(Args)]
pub(crate) struct Scenarios {
    /// Print the TOML of this one
    name: Option<String>,
    /// Write it into this folder instead, with the script that it names
    #[arg(long, value_name = "DIR", requires = "name")]
    out: Option<PathBuf>,
    /// Print JSON
    #[arg(long, conflicts_with = "name")]
    json: bool,
}

impl Scenarios {
    pub(crate) fn execute(&self) -> Result<Verdict, Failure> {
        if let Some(name) = &self.name {
            Scenario::find(name)?;
            let files = files_of(name);
            let Some(((_, text), beside)) = files.split_first() else {
                return Err(format!("`{name}` is a file; print it with cat").into());
            };
            if let Some(folder) = &self.out {
                return write_new(folder, &files);
            }
            say!("{text}");
            for (file, _) in beside {
                tell!("it needs {file} beside it; --out DIR writes both");
            }
            return Ok(Verdict::Positive);
        }
        let scenarios: Result<Vec<_>, _> =
            BUILTIN.iter().map(|(name, _)| Scenario::find(name)).collect();
        let scenarios = scenarios?;
        if self.json {
            let list: Vec<_> = scenarios
                .iter()
                .map(|s| json!({ "name": s.name, "title": s.title, "duration_s": s.duration_s }))
                .collect();
            say!("{}\n", json!(list));
        } else {
            let width = scenarios.iter().map(|s| s.name.chars().count()).max().unwrap_or(0);
            for s in scenarios {
                say!("{:<width$} {:>5} s  {}\n", s.name, s.duration_s, s.title);
            }
        }
        Ok(Verdict::Positive)
    }
}

/// Writes files into `folder`, none of which is there yet.
fn write_new(folder: &Path, files: &[(String, &str)]) -> Result<Verdict, Failure> {
    fs::create_dir_all(folder).map_err(|error| refusal(folder, &error))?;
    let paths: Vec<PathBuf> = files.iter().map(|(file, _)| folder.join(file)).collect();
    if let Some(there) = paths.iter().find(|path| path.exists()) {
        return Err(
            format!("{}: it is there already; give --out another folder", there.display()).into()
        );
    }
    for (path, (_, text)) in paths.iter().zip(files) {
        write(path, text)?;
    }
    Ok(Verdict::Positive)
}
