//! `ARCHITECTURE.md` against the tree: its code map, its paths, its dependency statements.

use std::collections::{BTreeMap, BTreeSet};

use super::Finding;
use super::graph::{Graph, Kind};

/// The page's path, for messages.
const PAGE: &str = "ARCHITECTURE.md";

/// What the tree has, to hold the page against.
pub(crate) struct Tree<'a> {
    /// Folder of each member (relative) and its crate's name.
    pub(crate) members: BTreeMap<String, String>,
    /// All files of the tree, relative, those that git does not track yet included.
    pub(crate) files: &'a [String],
    /// Those that git tracks.
    pub(crate) tracked: &'a [String],
}

/// One entry of the code map, as the page has it.
struct Entry {
    line: usize,
    folder: String,
    name: String,
    uses: Option<BTreeSet<String>>,
}

/// Everything in which page and tree differ.
///
/// An entry of the code map is a heading that gives folder and crate between backticks
/// (folder with a slash at its end), followed by a line that begins with `Uses:` and lists
/// the crates of this workspace that its manifest names, or nothing between backticks if none.
pub(crate) fn check(page: &str, tree: &Tree<'_>, graph: &Graph) -> Vec<Finding> {
    let entries = entries(page);
    let mut found = Vec::new();
    for (folder, name) in &tree.members {
        let own: Vec<&Entry> = entries.iter().filter(|entry| entry.folder == *folder).collect();
        match own[..] {
            [] => found.push(Finding::new(PAGE, format!("no entry for {name} in {folder}/"))),
            [entry] => found.extend(check_entry(entry, name, graph)),
            [_, again, ..] => found.push(at(again.line, format!("{folder}/ has a second entry"))),
        }
    }
    for entry in entries.iter().filter(|entry| !tree.members.contains_key(&entry.folder)) {
        found.push(at(entry.line, format!("there is no crate in {}/", entry.folder)));
    }
    found.extend(check_folders(page, tree.tracked));
    found.extend(check_paths(page, tree.files));
    found
}

fn at(line: usize, message: String) -> Finding {
    Finding::new(&format!("{PAGE}:{line}"), message)
}

/// The words between backticks in a line.
fn quoted(line: &str) -> impl Iterator<Item = &str> {
    line.split('`').skip(1).step_by(2)
}

fn entries(page: &str) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    for (text, line) in page.lines().zip(1..) {
        if text.starts_with('#') {
            let mut words = quoted(text);
            if let (Some(folder), Some(name)) = (words.next(), words.next()) {
                let folder = folder.trim_end_matches('/').to_owned();
                entries.push(Entry { line, folder, name: name.to_owned(), uses: None });
            }
        } else if let (Some(list), Some(entry)) = (text.strip_prefix("Uses:"), entries.last_mut()) {
            entry.uses = Some(quoted(list).map(String::from).collect());
        }
    }
    entries
}

fn check_entry(entry: &Entry, name: &str, graph: &Graph) -> Vec<Finding> {
    if entry.name != name {
        return vec![at(entry.line, format!("{} is called {name}", entry.folder))];
    }
    let Some(stated) = &entry.uses else {
        return vec![at(entry.line, format!("{name} has no line `Uses: ...`"))];
    };
    let mut real = BTreeSet::new();
    for package in graph.named(name).into_iter().map(|id| &graph.0[id]).filter(|p| p.ours) {
        for (used, kind) in &package.uses {
            if *kind != Kind::Dev && graph.0[used].ours {
                real.insert(graph.0[used].name.clone());
            }
        }
    }
    let missing = real.difference(stated).map(|used| format!("{name} uses {used} too"));
    let extra = stated.difference(&real).map(|used| format!("{name} does not use {used}"));
    missing.chain(extra).map(|message| at(entry.line, message)).collect()
}

/// Every top-level folder that git tracks stands on the page: an editor's is nobody else's.
fn check_folders(page: &str, files: &[String]) -> Vec<Finding> {
    let named: BTreeSet<&str> = page.lines().flat_map(quoted).collect();
    let tops: BTreeSet<&str> =
        files.iter().filter_map(|file| file.split_once('/')).map(|(top, _)| top).collect();
    let missing = tops.into_iter().filter(|top| !named.contains(format!("{top}/").as_str()));
    missing.map(|top| Finding::new(PAGE, format!("`{top}/` is not on it"))).collect()
}

/// Every path that the page names exists.
fn check_paths(page: &str, files: &[String]) -> Vec<Finding> {
    let mut found = Vec::new();
    for (text, line) in page.lines().zip(1..) {
        for path in quoted(text).filter(|word| is_path(word)) {
            let folder = format!("{}/", path.trim_end_matches('/'));
            let exists = files.iter().any(|file| file == path || file.starts_with(&folder));
            if !exists {
                found.push(at(line, format!("`{path}` is not in the tree")));
            }
        }
    }
    found
}

/// Whether a quoted word means a file or folder of the tree: it has a slash or a known ending,
/// and is not below a folder that builds and runs make.
fn is_path(word: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || "._-/".contains(c);
    let made = ["target/", "out/", "/"].iter().any(|top| word.starts_with(top));
    let ends = [".md", ".toml", ".rs", ".dbc", ".sh", ".c", ".lock"];
    word.chars().all(plain)
        && !made
        && (word.contains('/') || ends.iter().any(|end| word.ends_with(end) && word != *end))
}

#[cfg(test)]
mod tests {
    use super::super::graph::synthetic::graph;
    use super::*;

    const GOOD: &str = "# Map\n### `dbc/` - `xt28-dbc`\nUses: `xt28-dbc-model`.\n\
        ### `dbc/model/` - `xt28-dbc-model`\nUses: nothing of ours.\nSee `dbc/src/lib.rs`.\n";

    fn found(page: &str) -> Vec<String> {
        let graph = graph(&[
            ("xt28-dbc", true, &[("xt28-dbc-model", Kind::Build), ("serde", Kind::Normal)]),
            ("xt28-dbc-model", true, &[("xt28-dbc", Kind::Dev)]),
            ("serde", false, &[]),
        ]);
        let files =
            ["Cargo.toml", "dbc/src/lib.rs", "dbc/model/src/lib.rs", ".vscode/settings.json"];
        let files = files.map(String::from);
        let members = [("dbc", "xt28-dbc"), ("dbc/model", "xt28-dbc-model")];
        let members = members.map(|(dir, name)| (dir.to_owned(), name.to_owned())).into();
        let tracked = &files[..3];
        let findings = check(page, &Tree { members, files: &files, tracked }, &graph);
        findings.into_iter().map(|finding| finding.to_string()).collect()
    }

    #[test]
    fn a_page_that_tells_the_truth_is_clean() {
        assert_eq!(found(GOOD), [""; 0]);
    }

    #[test]
    fn each_lie_is_found() {
        let lies = [
            ("### `dbc/` - `xt28-dbc`\n", "", "no entry for xt28-dbc"),
            ("- `xt28-dbc`", "- `xt28-wire`", "dbc is called xt28-dbc"),
            ("Uses: `xt28-dbc-model`.\n", "", "xt28-dbc has no line"),
            ("Uses: `xt28-dbc-model`.", "Uses: nothing.", "xt28-dbc uses xt28-dbc-model too"),
            ("Uses: nothing", "Uses: `xt28-sim`, nothing", "does not use xt28-sim"),
            ("# Map", "### `sim/` - `xt28-sim`", "there is no crate in sim/"),
            ("# Map", "### `dbc/` - `xt28-dbc`", "dbc/ has a second entry"),
            ("# Map", "see `dbc/src/gone.rs`", "`dbc/src/gone.rs` is not in the tree"),
            ("# Map", "see `GONE.md`", "`GONE.md` is not in the tree"),
        ];
        for (good, bad, message) in lies {
            let found = found(&GOOD.replace(good, bad));
            assert!(found.iter().any(|text| text.contains(message)), "{message}: {found:?}");
        }
    }

    #[test]
    fn a_top_level_folder_off_the_page_is_found() {
        let files = ["wiki/page.md".to_owned()];
        assert_eq!(check_folders("", &files).len(), 1);
        assert_eq!(check_folders("`wiki/`", &files), []);
    }

    #[test]
    fn commands_and_made_folders_are_no_paths() {
        for word in ["cargo xtask test", "target/guest-kernel", "xt28::a/b", "*.toml", "/dev/ptmx"]
        {
            assert!(!is_path(word), "{word}");
        }
    }
}
