//! The files that a command writes: whether it can is asked before the work, not after it.

use std::fs::{self, OpenOptions};
use std::path::Path;

use crate::Failure;

/// Refuses files that could not be written. One that is there keeps what it holds, and none is left.
pub(crate) fn writable<'a>(paths: impl IntoIterator<Item = &'a Path>) -> Result<(), Failure> {
    for path in paths {
        let there = path.exists();
        let opened = OpenOptions::new().write(true).create_new(!there).open(path);
        opened.map_err(|error| refusal(path, &error))?;
        if !there {
            fs::remove_file(path)?;
        }
    }
    Ok(())
}

/// Refuses to write over one of the files that a command reads; `option` names what is to be written.
pub(crate) fn no_input<'a>(
    path: &Path,
    option: &str,
    read: impl IntoIterator<Item = &'a Path>,
) -> Result<(), Failure> {
    let Ok(own) = path.canonicalize() else { return Ok(()) };
    if read.into_iter().any(|one| one.canonicalize().is_ok_and(|one| one == own)) {
        let path = path.display();
        return Err(format!("{path}: this command reads that file; give {option} another").into());
    }
    Ok(())
}

/// Writes `text` into `path`, and says so.
pub(crate) fn write(path: &Path, text: &str) -> Result<(), Failure> {
    fs::write(path, text).map_err(|error| refusal(path, &error))?;
    eprintln!("wrote {}", path.display());
    Ok(())
}

fn refusal(path: &Path, error: &std::io::Error) -> Failure {
    let path = path.display();
    format!("{path}: cannot write: {error}; give a folder that exists and has room").into()
}
