//! The Python that the yardsticks run in: the machine's own if it has the pinned packages, or one installed
//! below the build folder.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::workspace::{Outcome, Workspace};

/// Where the yardsticks' Python and everything that both sides read are, below the root.
pub(crate) const YARDSTICK: &str = "tools/yardstick";

/// A command that runs `module` of the yardsticks from the root.
///
/// # Errors
/// When there is no Python with the packages and none can be installed; the message says the remedy.
pub(crate) fn module(workspace: &Workspace, module: &str) -> Outcome<Command> {
    Ok(with(&workspace.root, &python(workspace)?, module))
}

/// The same by a `python` that was found before.
pub(crate) fn with(root: &Path, python: &Path, module: &str) -> Command {
    let mut command = Command::new(python);
    command.current_dir(root).env("PYTHONPATH", root.join(YARDSTICK));
    command.env("PYTHONDONTWRITEBYTECODE", "1").args(["-m", module]);
    command
}

/// A Python that has the packages at the pinned versions; installs them below the build folder if
/// the machine's own has not.
///
/// # Errors
/// When they cannot be installed.
pub(crate) fn python(workspace: &Workspace) -> Outcome<PathBuf> {
    let pins = workspace.root.join(YARDSTICK).join("requirements.txt");
    let own = PathBuf::from("python3");
    if has_packages(&own, &pins)? {
        return Ok(own);
    }
    let venv = workspace.target.join("yardsticks");
    let python = venv.join("bin").join("python3");
    if has_packages(&python, &pins)? {
        return Ok(python);
    }
    eprintln!("yardstick: installing the packages of {} below {}", pins.display(), venv.display());
    let remedy = "install python3 (3.11 or later) with venv, and let it reach PyPI";
    let mut steps = Vec::new();
    if !python.exists() {
        let mut create = Command::new("python3");
        create.args(["-m", "venv"]).arg(&venv);
        steps.push(create);
    }
    let mut install = Command::new(&python);
    install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r"]);
    install.arg(&pins);
    steps.push(install);
    for step in &mut steps {
        if !step.status().is_ok_and(|status| status.success()) {
            return Err(format!("{step:?} failed; {remedy}").into());
        }
    }
    Ok(python)
}

/// Whether this Python has every pinned package in its pinned version.
fn has_packages(python: &Path, pins: &Path) -> Outcome<bool> {
    let pins = fs::read_to_string(pins).map_err(|error| format!("{}: {error}", pins.display()))?;
    let mut check = String::from("from importlib.metadata import version as v\n");
    for pin in pins.lines().filter(|line| !line.starts_with('#')) {
        let (name, version) = pin.split_once("==").ok_or_else(|| format!("not a pin: {pin}"))?;
        check.push_str(&format!("assert v({name:?}) == {version:?}\n"));
    }
    let output = Command::new(python).args(["-c", &check]).output();
    Ok(output.is_ok_and(|output| output.status.success()))
}
