//! What every Rust file keeps to beyond what rustfmt, rustc and clippy can say.

use super::Finding;

/// Longest file, lines. Most are a third of it.
const LONGEST: usize = 400;

/// Words that name no idea; the item they would hide behind has a better one.
const NAMELESS: &[&str] = &["util", "helper", "manager"];

/// Words that a name follows.
const NAMING: &[&str] = &["mod", "struct", "enum", "trait", "type", "fn", "union"];

/// What a CAN socket is opened with below any crate, split so that this file is not found.
const RAW_CAN: &[&str] =
    &[concat!("AF_", "CAN"), concat!("PF_", "CAN"), concat!("Family::", "CAN")];

/// The lints that fence nevers 4 to 6, and the groups that they are lifted with.
const FENCE: [&str; 4] = [
    concat!("clippy::", "disallowed_"),
    concat!("clippy::", "style"),
    concat!("clippy::", "all"),
    concat!("allow(", "warnings"),
];

/// What says something where the test harness keeps it to itself, if the test passes; split as above.
const KEPT: [&str; 2] = [concat!("print", "ln!("), concat!("print", "!(")];
/// What a test says when it cannot do its work.
const SKIPPED: &str = "\"SKIPPED";

/// Where in its package a file lies, which decides what it may do.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Place {
    /// The root of a binary, a build script, a test, an example: it may open the fence.
    Edge,
    /// Everything else.
    Inside,
}

impl Place {
    /// The place of `path` given the folders of all packages (relative, no trailing slash).
    pub(crate) fn of(path: &str, packages: &[String]) -> Self {
        let owner = packages.iter().filter(|dir| path.starts_with(&format!("{dir}/")));
        let inner = owner.max_by_key(|dir| dir.len()).map_or(path, |dir| &path[dir.len() + 1..]);
        let edge = matches!(inner, "src/main.rs" | "build.rs")
            || ["tests/", "examples/", "benches/", "src/bin/"].iter().any(|d| inner.starts_with(d));
        if edge { Self::Edge } else { Self::Inside }
    }
}

/// Everything in one Rust file that breaks a rule; `path` is relative to the root.
pub(crate) fn check(path: &str, place: Place, text: &str) -> Vec<Finding> {
    let mut found = Vec::new();
    let lines = text.lines().count();
    if lines > LONGEST {
        found.push(Finding::new(path, format!("{lines} lines; split it, {LONGEST} is the limit")));
    }
    if !text.starts_with("//! ") {
        found.push(Finding::new(path, "the first line does not say what the file is (`//! ...`)"));
    }
    if let Some(word) = nameless(path) {
        found.push(Finding::new(path, format!("`{word}` in a path says nothing; name the idea")));
    }
    for (line, number) in text.lines().zip(1..) {
        let at = format!("{path}:{number}");
        for name in declared(line) {
            if let Some(word) = nameless(name) {
                found.push(Finding::new(&at, format!("`{word}` in `{name}` says nothing")));
            }
        }
        if line.contains(concat!("#[ign", "ore]")) {
            found.push(Finding::new(&at, "an ignored test gives a reason: #[ignore = \"...\"]"));
        }
        if place == Place::Inside && FENCE.iter().any(|lint| line.contains(lint)) {
            found.push(Finding::new(&at, "only main.rs, tests and examples may open this fence"));
        }
        if !path.starts_with("dbc/bus/") && RAW_CAN.iter().any(|word| line.contains(word)) {
            found.push(Finding::new(&at, "never 4: only dbc/bus opens a CAN socket"));
        }
    }
    found.extend(unheard(text).map(|number| {
        let remedy = "the harness keeps this; say it with writeln!(io::stdout(), ...), or it counts as passed";
        Finding::new(&format!("{path}:{number}"), remedy)
    }));
    found
}

/// The lines on which a test says that it skips where nobody hears it.
fn unheard(text: &str) -> impl Iterator<Item = usize> {
    let says = KEPT.iter().flat_map(|kept| text.match_indices(kept));
    let skips = says.filter(|(at, kept)| text[at + kept.len()..].trim_start().starts_with(SKIPPED));
    skips.map(|(at, _)| text[..at].matches('\n').count() + 1)
}

/// The first word in `name` that names no idea.
fn nameless(name: &str) -> Option<&'static str> {
    // can-utils is a product, and the yardstick of the bus.
    let lower = name.to_lowercase().replace("can_utils", "");
    NAMELESS.iter().copied().find(|word| lower.contains(word))
}

/// The names that a line declares: what follows `struct`, `fn` and their like.
fn declared(line: &str) -> impl Iterator<Item = &str> {
    let code = line.split("//").next().unwrap_or_default();
    let words: Vec<&str> = code
        .split(|c: char| !(c.is_alphanumeric() || c == '_'))
        .filter(|word| !word.is_empty())
        .collect();
    let pairs: Vec<_> = words.windows(2).map(|pair| (pair[0], pair[1])).collect();
    pairs.into_iter().filter(|(word, _)| NAMING.contains(word)).map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages(path: &str, place: Place, text: &str) -> Vec<String> {
        check(path, place, text).into_iter().map(|finding| finding.to_string()).collect()
    }

    #[test]
    fn a_good_file_is_clean() {
        let text = "//! One idea.\n\n#[ignore = \"needs a can0\"]\nfn step() {}\n\
            writeln!(io::stdout(), \"SKIPPED: no bus\");\n";
        assert_eq!(messages("sim/src/tyre.rs", Place::Inside, text), [""; 0]);
        assert_eq!(messages("dbc/bus/tests/can_utils.rs", Place::Edge, text), [""; 0]);
    }

    #[test]
    fn length_counts_from_the_limit() {
        let at_limit = format!("//! x\n{}", "\n".repeat(LONGEST - 1));
        assert_eq!(messages("a.rs", Place::Inside, &at_limit), [""; 0]);
        assert_eq!(messages("a.rs", Place::Inside, &format!("{at_limit}\n")).len(), 1);
    }

    #[test]
    fn each_rule_finds_its_breach() {
        let fence = format!("//! x\n#![allow({}methods)]\n", FENCE[0]);
        let groups = FENCE.map(|lint| format!("//! x\n#![allow({lint})]\n"));
        assert!(groups.iter().all(|text| check("a.rs", Place::Inside, text).len() == 1));
        let socket = format!("//! x\nlet family = {};\n", RAW_CAN[2]);
        let ignored = concat!("//! x\n#[ign", "ore]\n");
        let [kept, broken] =
            ["", "\n    "].map(|gap| format!("//! x\ne{}{gap}{SKIPPED}: no bus\");\n", KEPT[0]));
        let breaches = [
            ("a.rs", "fn f() {}\n", "a.rs: the first line"),
            ("src/utils.rs", "//! x\n", "src/utils.rs: `util` in a path"),
            ("a.rs", "//! x\npub struct BusManager;\n", "a.rs:2: `manager` in `BusManager`"),
            ("a.rs", "//! x\nmod helpers;\n", "a.rs:2: `helper` in `helpers`"),
            ("a.rs", ignored, "a.rs:2: an ignored test"),
            ("a.rs", &kept, "a.rs:2: the harness keeps this"),
            ("a.rs", &broken, "a.rs:2: the harness keeps this"),
            ("a.rs", &fence, "a.rs:2: only main.rs"),
            ("gateway/src/a.rs", &socket, "gateway/src/a.rs:2: never 4"),
        ];
        for (path, text, start) in breaches {
            let found = messages(path, Place::Inside, text);
            assert!(found.len() == 1 && found[0].starts_with(start), "{start}: {found:?}");
        }
        assert_eq!(messages("gateway/src/main.rs", Place::Edge, &fence), [""; 0]);
        assert_eq!(messages("dbc/bus/src/a.rs", Place::Inside, &socket), [""; 0]);
    }

    #[test]
    fn the_innermost_package_decides_the_place() {
        let packages = ["tests", "gateway", "gateway/kernel"].map(String::from);
        let edges = ["gateway/src/main.rs", "gateway/kernel/tests/a.rs", "tests/tests/a.rs"];
        let inside = ["gateway/src/run.rs", "tests/src/a.rs", "gateway/kernel/src/lib.rs"];
        assert!(edges.iter().all(|path| Place::of(path, &packages) == Place::Edge));
        assert!(inside.iter().all(|path| Place::of(path, &packages) == Place::Inside));
    }
}
