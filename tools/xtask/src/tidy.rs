//! `cargo xtask tidy`: the house rules that neither rustc nor clippy can check, as one pass.
//!
//! Every rule is a pure function from text or graph to findings, with a test that breaks the rule
//! on a made-up input and sees it found. The pass over the real tree is a test as well.

mod architecture;
mod graph;
mod licence;
mod manifest;
mod outside;
mod rules;
mod source;
mod spdx;

use std::collections::BTreeMap;
use std::fmt;
use std::fs;

use cargo_metadata::TargetKind;

use crate::workspace::{Outcome, Workspace};
use graph::Graph;
use source::Place;

/// One broken rule and where.
#[derive(PartialEq, Eq, Debug)]
pub(crate) struct Finding {
    place: String,
    message: String,
}

impl Finding {
    fn new(place: &str, message: impl Into<String>) -> Self {
        Self { place: place.to_owned(), message: message.into() }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.message)
    }
}

/// Checks the whole tree; an empty list is a tidy one.
///
/// # Errors
/// When the tree cannot be read; broken rules are findings, not errors.
pub(crate) fn check(workspace: &Workspace) -> Outcome<Vec<Finding>> {
    let graph = Graph::of(&workspace.metadata);
    let files = workspace.files()?;
    let members = members(workspace)?;
    let mut found = rules::check(&graph, rules::RULES);
    found.extend(licence::check(&graph));
    let tracked = workspace.tracked()?;
    found.extend(check_files(workspace, &files, &tracked, &members)?);
    found.extend(check_libraries(workspace)?);
    let page = fs::read_to_string(workspace.root.join("ARCHITECTURE.md"))
        .map_err(|error| format!("ARCHITECTURE.md: {error}"))?;
    let tree = architecture::Tree { members, files: &files, tracked: &tracked };
    found.extend(architecture::check(&page, &tree, &graph));
    if !tracked.iter().any(|file| file == "Cargo.lock") {
        found.push(Finding::new("Cargo.lock", "git does not track it; commit it"));
    }
    Ok(found)
}

/// Folder (relative) and name of each member.
fn members(workspace: &Workspace) -> Outcome<BTreeMap<String, String>> {
    let mut members = BTreeMap::new();
    for package in workspace.metadata.workspace_packages() {
        let manifest = package.manifest_path.as_std_path();
        let folder = manifest.parent().ok_or("a manifest without a folder")?;
        let folder = folder.strip_prefix(&workspace.root)?.to_string_lossy().into_owned();
        members.insert(folder, package.name.to_string());
    }
    Ok(members)
}

/// The rules of each kind of file. What is in a text matters once git tracks it: an editor's settings and a virtual
/// environment lie in many a checkout, full of paths of its machine. Source is held to its rules from the start.
fn check_files(
    workspace: &Workspace,
    files: &[String],
    tracked: &[String],
    members: &BTreeMap<String, String>,
) -> Outcome<Vec<Finding>> {
    let packages: Vec<String> = members.keys().cloned().collect();
    let mut found = Vec::new();
    for path in files {
        let bytes = fs::read(workspace.root.join(path))?;
        // Logs and pictures are not text to lint.
        let Ok(text) = String::from_utf8(bytes) else { continue };
        if tracked.binary_search(path).is_ok() {
            found.extend(outside::check_text(path, &text));
        }
        if path == "Cargo.lock" {
            found.extend(outside::check_lock(path, &text));
        } else if path == "clippy.toml" {
            found.extend(manifest::check_clippy(path, &text));
        } else if path.ends_with(".rs") {
            found.extend(source::check(path, Place::of(path, &packages), &text));
        } else if path.strip_suffix("/Cargo.toml").is_some_and(|dir| members.contains_key(dir)) {
            found.extend(manifest::check_member(path, &text));
        }
    }
    Ok(found)
}

fn check_libraries(workspace: &Workspace) -> Outcome<Vec<Finding>> {
    let mut found = Vec::new();
    for package in workspace.metadata.workspace_packages() {
        for target in package.targets.iter().filter(|t| t.kind.contains(&TargetKind::Lib)) {
            let path = target.src_path.as_std_path();
            let name = path.strip_prefix(&workspace.root).unwrap_or(path).to_string_lossy();
            found.extend(manifest::check_library(&name, &fs::read_to_string(path)?));
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    use super::*;

    #[test]
    fn the_tree_is_tidy() {
        let found = check(&Workspace::load().unwrap()).unwrap();
        let lines: Vec<String> = found.iter().map(Finding::to_string).collect();
        assert!(lines.is_empty(), "{} findings:\n{}", lines.len(), lines.join("\n"));
    }

    #[test]
    fn what_git_does_not_track_may_lean_on_its_machine() {
        let folder = tempfile::tempdir().unwrap();
        let git = |arguments: &[&str]| {
            let git = Command::new("git").current_dir(folder.path()).args(arguments).status();
            assert!(git.unwrap().success());
        };
        git(&["init", "--quiet"]);
        // Whatever its owner ignores everywhere.
        git(&["config", "core.excludesFile", "/dev/null"]);
        for dir in [".venv", "docs"] {
            fs::create_dir(folder.path().join(dir)).unwrap();
        }
        let home = concat!("VIRTUAL_ENV=/ho", "me/someone/xt28/.venv\n");
        fs::write(folder.path().join(".venv/activate"), home).unwrap();
        fs::write(folder.path().join("docs/page.md"), home).unwrap();
        git(&["add", "docs"]);
        let workspace = Workspace { root: folder.path().to_owned(), ..Workspace::load().unwrap() };
        let (files, tracked) = (workspace.files().unwrap(), workspace.tracked().unwrap());
        assert_eq!((files.len(), tracked.len()), (2, 1));
        let found = check_files(&workspace, &files, &tracked, &BTreeMap::new()).unwrap();
        let places: Vec<&str> = found.iter().map(|finding| finding.place.as_str()).collect();
        assert_eq!(places, ["docs/page.md:1"]);
    }
}
