//! Programs as cargo builds them, found by what it says of them.

use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use cargo_metadata::{Artifact, Message};

use crate::workspace::Outcome;

/// Runs cargo, released code only, and returns what it built.
///
/// # Errors
/// When it cannot be run or does not succeed.
pub(super) fn build(root: &Path, arguments: &[&str]) -> Outcome<Vec<Artifact>> {
    let mut cargo = Command::new(env!("CARGO"))
        .current_dir(root)
        .args(arguments)
        .args(["--release", "--locked", "--message-format=json-render-diagnostics"])
        .stdout(Stdio::piped())
        .spawn()?;
    let output = cargo.stdout.take().ok_or("no output to read")?;
    let mut built = Vec::new();
    for message in Message::parse_stream(BufReader::new(output)) {
        if let Message::CompilerArtifact(artifact) = message? {
            built.push(artifact);
        }
    }
    let status = cargo.wait()?;
    if status.success() { Ok(built) } else { Err(format!("cargo {arguments:?}: {status}").into()) }
}

/// The one of this name.
///
/// # Errors
/// When there is none.
pub(super) fn executable<'a>(
    built: impl Iterator<Item = &'a Artifact>,
    name: &str,
) -> Outcome<PathBuf> {
    let found = built.filter(|artifact| artifact.target.name == name);
    let mut paths = found.filter_map(|artifact| artifact.executable.clone());
    Ok(paths.next().ok_or_else(|| format!("cargo built no {name}"))?.into_std_path_buf())
}
