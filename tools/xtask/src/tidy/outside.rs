//! Nothing tracked may lean on one person's machine: no private hosts, mirrors or absolute folders.

use super::Finding;

/// Where packages come from; the only source that `Cargo.lock` may name.
const REGISTRY: &str = "registry+https://github.com/rust-lang/crates.io-index";

/// Top-level folders in which people and CI machines keep their checkouts and homes.
const HOMES: &[&str] = &["builds", "home", "root", "Users", "work", "workspace"];

/// Settings that would send a package client to another registry.
const MIRRORS: &[&str] = &["replace-with", "index-url", "GOPROXY=", "npm_config_registry"];

/// Every package source in a lock file that is not the public registry.
pub(crate) fn check_lock(path: &str, text: &str) -> Vec<Finding> {
    let sources = text.lines().zip(1..).filter_map(|(line, number)| {
        let source = line.strip_prefix("source = ")?.trim_matches('"');
        (source != REGISTRY).then_some((number, source))
    });
    sources
        .map(|(number, source)| {
            Finding::new(&format!("{path}:{number}"), format!("packages come from {source}"))
        })
        .collect()
}

/// Every private host, mirror setting and absolute home folder in a text.
pub(crate) fn check_text(path: &str, text: &str) -> Vec<Finding> {
    let mut found = Vec::new();
    // This file lists what it looks for.
    if path.ends_with("tidy/outside.rs") {
        return found;
    }
    for (line, number) in text.lines().zip(1..) {
        let at = format!("{path}:{number}");
        for host in hosts(line).filter(|host| private(host)) {
            found.push(Finding::new(&at, format!("`{host}` is not a public host")));
        }
        for home in HOMES.iter().filter(|home| absolute_below(line, home)) {
            found.push(Finding::new(&at, format!("an absolute path below `{home}`")));
        }
        for mirror in MIRRORS.iter().filter(|mirror| line.contains(**mirror)) {
            found.push(Finding::new(&at, format!("`{mirror}` points at somebody's mirror")));
        }
    }
    found
}

/// The hosts of the web addresses in a line, without port.
fn hosts(line: &str) -> impl Iterator<Item = &str> {
    line.split("://").skip(1).filter_map(|rest| {
        let end = rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '.' || c == '-'));
        let host = &rest[..end.unwrap_or(rest.len())];
        (!host.is_empty()).then_some(host.trim_end_matches('.'))
    })
}

/// A host without a public top-level domain: a bare name, an address, an internal suffix.
fn private(host: &str) -> bool {
    let Some((_, top)) = host.rsplit_once('.') else { return host != "localhost" };
    let numeric = top.bytes().all(|byte| byte.is_ascii_digit());
    (numeric && !host.starts_with("127."))
        || ["corp", "home", "internal", "intranet", "lan", "local"].contains(&top)
}

/// Whether the line names something below `/top/`, the slash not being inside a longer path.
fn absolute_below(line: &str, top: &str) -> bool {
    let needle = format!("/{top}/");
    line.match_indices(&needle).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        !before.is_some_and(|c| c.is_alphanumeric() || "._-/~}*)".contains(c))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_public_registry_may_be_locked() {
        let good = format!("name = \"a\"\nsource = \"{REGISTRY}\"\n");
        assert_eq!(check_lock("Cargo.lock", &good), []);
        let other = good.replace("github.com", "mirror.example");
        assert_eq!(check_lock("Cargo.lock", &other).len(), 1);
        assert_eq!(check_lock("Cargo.lock", "source = \"git+https://github.com/a/b\"\n").len(), 1);
    }

    #[test]
    fn public_addresses_and_relative_paths_pass() {
        for line in [
            "see https://doc.rust-lang.org/cargo/",
            "http://localhost:9090 or ws://127.0.0.1:9090",
            "frame/work/x and ../home/y",
            "the format! of \"{scheme}://{host}\"",
        ] {
            assert_eq!(check_text("a.md", line), [], "{line}");
        }
    }

    #[test]
    fn what_leans_on_a_machine_is_found() {
        for line in [
            "cd /home/someone/xt28",
            "\"/root/.cargo\"",
            "at (/builds/xt28)",
            "http://build-cache:8080/simple",
            "https://10.0.0.7/index",
            "https://crates.corp/",
            "replace-with = \"mirror\"",
        ] {
            assert_eq!(check_text("a.md", line).len(), 1, "{line}");
        }
    }
}
