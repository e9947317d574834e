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
    found.extend(check_files(workspace, &files, &members)?);
    found.extend(check_libraries(workspace)?);
    let page = fs::read_to_string(workspace.root.join("ARCHITECTURE.md"))
        .map_err(|error| format!("ARCHITECTURE.md: {error}"))?;
    let tree = architecture::Tree { members, files: &files };
    found.extend(architecture::check(&page, &tree, &graph));
    if !workspace.tracked()?.iter().any(|file| file == "Cargo.lock") {
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

fn check_files(
    workspace: &Workspace,
    files: &[String],
    members: &BTreeMap<String, String>,
) -> Outcome<Vec<Finding>> {
    let packages: Vec<String> = members.keys().cloned().collect();
    let mut found = Vec::new();
    for path in files {
        let bytes = fs::read(workspace.root.join(path))?;
        // Logs and pictures are not text to lint.
        let Ok(text) = String::from_utf8(bytes) else { continue };
        found.extend(outside::check_text(path, &text));
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
    use super::*;

    #[test]
    fn the_tree_is_tidy() {
        let found = check(&Workspace::load().unwrap()).unwrap();
        let lines: Vec<String> = found.iter().map(Finding::to_string).collect();
        assert!(lines.is_empty(), "{} findings:\n{}", lines.len(), lines.join("\n"));
    }
}
