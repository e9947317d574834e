//! Who depends on whom: the resolved package graph, small enough to make by hand in a test.

use std::collections::{BTreeMap, VecDeque};

use cargo_metadata::{DependencyKind, Metadata};

/// When a dependency is linked or run.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Kind {
    /// In every target of the package.
    Normal,
    /// In its build script.
    Build,
    /// In its tests, examples and benches.
    Dev,
}

/// One package of the graph.
#[derive(Debug)]
pub(crate) struct Package {
    /// Its name; two versions of one crate share it.
    pub(crate) name: String,
    /// The SPDX expression of its manifest.
    pub(crate) licence: Option<String>,
    /// Whether it is a member of this workspace.
    pub(crate) ours: bool,
    /// Its direct dependencies, by id, once per kind.
    pub(crate) uses: Vec<(String, Kind)>,
}

/// All packages of the workspace and of what it depends on, by cargo's package id.
#[derive(Debug)]
pub(crate) struct Graph(pub(crate) BTreeMap<String, Package>);

impl Graph {
    /// The graph that cargo resolved.
    pub(crate) fn of(metadata: &Metadata) -> Self {
        let mut packages = BTreeMap::new();
        for node in metadata.resolve.iter().flat_map(|resolve| &resolve.nodes) {
            let package = &metadata[&node.id];
            let uses = node.deps.iter().flat_map(|dep| {
                dep.dep_kinds.iter().map(|info| {
                    let kind = match info.kind {
                        DependencyKind::Development => Kind::Dev,
                        DependencyKind::Build => Kind::Build,
                        _ => Kind::Normal,
                    };
                    (dep.pkg.repr.clone(), kind)
                })
            });
            let entry = Package {
                name: package.name.to_string(),
                licence: package.license.clone(),
                ours: metadata.workspace_members.contains(&node.id),
                uses: uses.collect(),
            };
            packages.insert(node.id.repr.clone(), entry);
        }
        Self(packages)
    }

    /// The ids of the packages called `name`, if there are any.
    pub(crate) fn named(&self, name: &str) -> Vec<&str> {
        let same = self.0.iter().filter(|(_, package)| package.name == name);
        same.map(|(id, _)| id.as_str()).collect()
    }

    /// Every package that some target of `from` links or runs, each with the id it was found by.
    ///
    /// Dev-dependencies count for `from` itself only: cargo builds nobody else's.
    pub(crate) fn reach<'a>(&'a self, from: &'a str) -> BTreeMap<&'a str, Option<&'a str>> {
        let mut found_by = BTreeMap::from([(from, None)]);
        let mut queue = VecDeque::from([from]);
        while let Some(id) = queue.pop_front() {
            for (used, kind) in self.0.get(id).iter().flat_map(|package| &package.uses) {
                let built = *kind != Kind::Dev || id == from;
                if built && !found_by.contains_key(used.as_str()) {
                    found_by.insert(used.as_str(), Some(id));
                    queue.push_back(used);
                }
            }
        }
        found_by
    }

    /// The chain of names from the start of `reach` to `to`, as `a -> b -> c`.
    pub(crate) fn chain(&self, reach: &BTreeMap<&str, Option<&str>>, to: &str) -> String {
        let mut names = Vec::new();
        let mut at = Some(to);
        while let Some(id) = at {
            names.push(self.0[id].name.as_str());
            at = reach.get(id).copied().flatten();
        }
        names.reverse();
        names.join(" -> ")
    }
}

#[cfg(test)]
pub(crate) mod synthetic {
    //! Graphs made by hand: what the rules are checked against.

    use super::{Graph, Kind, Package};

    /// Name, whether it is ours, and the names it uses.
    type Sketch<'a> = (&'a str, bool, &'a [(&'a str, Kind)]);

    /// A graph from sketches; ids are names, all licences MIT.
    pub(crate) fn graph(packages: &[Sketch<'_>]) -> Graph {
        let entry = |&(name, ours, uses): &Sketch<'_>| {
            let package = Package {
                name: name.into(),
                licence: Some("MIT".into()),
                ours,
                uses: uses.iter().map(|&(used, kind)| (used.into(), kind)).collect(),
            };
            (name.to_owned(), package)
        };
        Graph(packages.iter().map(entry).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::synthetic::graph;
    use super::*;

    #[test]
    fn reach_follows_dev_dependencies_of_the_start_only() {
        let graph = graph(&[
            ("a", true, &[("b", Kind::Normal), ("c", Kind::Dev)]),
            ("b", true, &[("d", Kind::Dev), ("e", Kind::Build)]),
            ("c", false, &[]),
            ("d", false, &[]),
            ("e", false, &[]),
        ]);
        let reach = graph.reach("a");
        assert_eq!(reach.keys().copied().collect::<Vec<_>>(), ["a", "b", "c", "e"]);
        assert_eq!(graph.chain(&reach, "e"), "a -> b -> e");
    }
}
