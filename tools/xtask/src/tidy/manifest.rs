//! What every package and the lint settings keep to, so that the compiler can enforce the rest.

use toml::Table;

use super::Finding;

/// The clippy lists that nevers 4 to 6 rest on, and what must stay on each.
const FENCE: &[(&str, &[&str])] = &[
    (
        "disallowed-methods",
        &[
            "std::time::Instant::now",
            "std::time::SystemTime::now",
            "std::env::var",
            "std::env::args",
            "std::process::exit",
            "rand::rng",
        ],
    ),
    ("disallowed-types", &["std::collections::HashMap", "std::collections::HashSet"]),
    ("disallowed-macros", &["std::println", "std::eprintln"]),
];

/// Whether a member takes part in the workspace's lints and licence.
pub(crate) fn check_member(path: &str, text: &str) -> Vec<Finding> {
    let manifest = match text.parse::<Table>() {
        Ok(manifest) => manifest,
        Err(error) => return vec![Finding::new(path, error.message())],
    };
    let inherits = |table: &str, key: Option<&str>| {
        let mut value = manifest.get(table);
        if let Some(key) = key {
            value = value.and_then(|value| value.get(key));
        }
        value.and_then(|value| value.get("workspace")).and_then(toml::Value::as_bool) == Some(true)
    };
    let mut found = Vec::new();
    if !inherits("lints", None) {
        found.push(Finding::new(path, "without `[lints] workspace = true` the fences are down"));
    }
    if !inherits("package", Some("license")) {
        found.push(Finding::new(path, "without `license.workspace = true` it has no licence"));
    }
    found
}

/// Whether the root of a library refuses unsafe code in its own text.
pub(crate) fn check_library(path: &str, text: &str) -> Vec<Finding> {
    if text.lines().any(|line| line.trim() == "#![forbid(unsafe_code)]") {
        return Vec::new();
    }
    vec![Finding::new(path, "a library begins with #![forbid(unsafe_code)]")]
}

/// Whether `clippy.toml` still lists everything that the nevers rest on.
pub(crate) fn check_clippy(path: &str, text: &str) -> Vec<Finding> {
    let config = match text.parse::<Table>() {
        Ok(config) => config,
        Err(error) => return vec![Finding::new(path, error.message())],
    };
    let listed = |list: &str, item: &str| {
        let entries = config.get(list).and_then(toml::Value::as_array);
        let mut paths =
            entries.into_iter().flatten().map(|entry| entry.get("path").unwrap_or(entry));
        paths.any(|path| path.as_str() == Some(item))
    };
    let missing = FENCE.iter().flat_map(|(list, items)| items.iter().map(move |item| (list, item)));
    missing
        .filter(|(list, item)| !listed(list, item))
        .map(|(list, item)| Finding::new(path, format!("{item} is gone from {list}")))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_member_that_leaves_the_lints_or_the_licence_is_found() {
        let good = "[package]\nlicense.workspace = true\n[lints]\nworkspace = true\n";
        assert_eq!(check_member("a/Cargo.toml", good), []);
        let alone = good.replace("[lints]\nworkspace = true", "[lints]\nworkspace = false");
        assert_eq!(check_member("a/Cargo.toml", &alone).len(), 1);
        let own = good.replace("license.workspace = true", "license = \"MIT\"");
        assert_eq!(check_member("a/Cargo.toml", &own).len(), 1);
        assert_eq!(check_member("a/Cargo.toml", "[package").len(), 1);
    }

    #[test]
    fn a_library_without_the_forbid_is_found() {
        assert_eq!(check_library("a.rs", "//! A.\n#![forbid(unsafe_code)]\n"), []);
        assert_eq!(check_library("a.rs", "//! #![forbid(unsafe_code)]\n").len(), 1);
    }

    #[test]
    fn each_gap_in_the_fence_is_found() {
        let entry = |item: &&str| format!("{{ path = \"{item}\" }}");
        let list = |(name, items): &(&str, &[&str])| {
            let entries: Vec<String> = items.iter().map(entry).collect();
            format!("{name} = [{}]\n", entries.join(", "))
        };
        let whole: String = FENCE.iter().map(list).collect();
        assert_eq!(check_clippy("clippy.toml", &whole), []);
        for item in FENCE.iter().flat_map(|(_, items)| *items) {
            let gap = whole.replace(&format!("\"{item}\""), "\"other\"");
            assert_eq!(check_clippy("clippy.toml", &gap).len(), 1, "{item}");
        }
    }
}
