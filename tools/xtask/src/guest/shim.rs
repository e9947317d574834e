//! The preload that lets the guest's kernel run on processors with large register state.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::kernel::fingerprint;
use crate::workspace::Outcome;

const SOURCE: &str = include_str!("../../guest/xsave_shim.c");

/// Finds the compiled shim in `cache`, or compiles it into it.
///
/// # Errors
/// When the C compiler refuses it.
pub(super) fn find_or_build(cache: &Path) -> Outcome<PathBuf> {
    let shim = cache.join(format!("xsave-shim-{:016x}.so", fingerprint(SOURCE.as_bytes())));
    if shim.is_file() {
        return Ok(shim);
    }
    fs::create_dir_all(cache)?;
    // Compiled aside and renamed, so that a second xtask never loads half a file.
    let folder = tempfile::tempdir_in(cache)?;
    let source = folder.path().join("xsave_shim.c");
    let object = folder.path().join("xsave_shim.so");
    fs::write(&source, SOURCE)?;
    let compiled = Command::new("cc")
        .args(["-O2", "-shared", "-fPIC", "-o"])
        .args([&object, &source])
        .status()
        .map_err(|error| format!("cannot run cc: {error}; install gcc"))?;
    if !compiled.success() {
        return Err(format!("cc could not compile the guest's shim: {compiled}").into());
    }
    fs::rename(&object, &shim)?;
    Ok(shim)
}
