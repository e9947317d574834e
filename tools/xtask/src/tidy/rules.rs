//! Nevers 1 to 4 as rules over the package graph.

use super::Finding;
use super::graph::{Graph, Kind};

/// One dependency rule and the reason for it.
pub(crate) enum Rule {
    /// No target of `from` may link or run any of `never`, however indirectly.
    Unreachable { from: &'static str, never: &'static [&'static str], because: &'static str },
    /// Of this workspace, only `by` may name `package` in its manifest.
    OnlyUser { package: &'static str, by: &'static str, because: &'static str },
    /// `package` may name nothing but `allowed`; its tests are free.
    UsesOnly { package: &'static str, allowed: &'static [&'static str], because: &'static str },
}

/// The rules of this workspace.
pub(crate) const RULES: &[Rule] = &[
    Rule::Unreachable {
        from: "xt28-ecus",
        never: &["xt28-sim", "ecu-emu", "rapier3d"],
        because: "never 1: an ECU never sees the plant",
    },
    Rule::Unreachable {
        from: "xt28-sim",
        never: &["xt28-dbc", "xt28-dbc-model", "xt28-bus", "socketcan"],
        because: "never 2: the plant never sees CAN",
    },
    Rule::Unreachable {
        from: "gateway",
        never: &["rapier3d", "xt28-sim", "ecu-emu"],
        because: "never 3: the gateway never links the simulator",
    },
    Rule::OnlyUser {
        package: "socketcan",
        by: "xt28-bus",
        because: "never 4: only dbc/bus opens a CAN socket",
    },
    Rule::Unreachable {
        from: "xt28-terrain",
        never: &["rapier3d", "xt28-sim"],
        because: "the ground needs no engine: who drives may read it too",
    },
    Rule::Unreachable {
        from: "xt28-gap",
        never: &["xt28-gap-plants", "xt28-gap-check"],
        because: "a diagnosis never knows the machines that it is examined on",
    },
    Rule::UsesOnly {
        package: "xt28-safety",
        allowed: &["libm"],
        because: "the safety kernel is no_std and has nothing to trust but itself",
    },
];

/// Everything in the graph that breaks a rule, and every rule that has lost its subject.
pub(crate) fn check(graph: &Graph, rules: &[Rule]) -> Vec<Finding> {
    let found = rules.iter().flat_map(|rule| match *rule {
        Rule::Unreachable { from, never, because } => unreachable(graph, from, never, because),
        Rule::OnlyUser { package, by, because } => only_user(graph, package, by, because),
        Rule::UsesOnly { package, allowed, because } => uses_only(graph, package, allowed, because),
    });
    found.collect()
}

/// A rule about a package that is not there would hold for ever and guard nothing.
fn lost(graph: &Graph, names: &[&str], because: &str) -> Vec<Finding> {
    let gone = names.iter().filter(|name| graph.named(name).is_empty());
    gone.map(|name| {
        Finding::new(name, format!("a rule names this package, but it is gone ({because})"))
    })
    .collect()
}

fn unreachable(graph: &Graph, from: &str, never: &[&str], because: &str) -> Vec<Finding> {
    let mut found = lost(graph, &[from], because);
    found.extend(lost(graph, never, because));
    for start in graph.named(from) {
        let reach = graph.reach(start);
        for id in reach.keys().filter(|id| never.contains(&graph.0[**id].name.as_str())) {
            let chain = graph.chain(&reach, id);
            found.push(Finding::new(from, format!("{chain} breaks {because}")));
        }
    }
    found
}

fn only_user(graph: &Graph, package: &str, by: &str, because: &str) -> Vec<Finding> {
    let mut found = lost(graph, &[package, by], because);
    for user in graph.0.values().filter(|user| user.ours && user.name != by) {
        if user.uses.iter().any(|(used, _)| graph.0[used].name == package) {
            found.push(Finding::new(&user.name, format!("uses {package}: {because}")));
        }
    }
    found
}

fn uses_only(graph: &Graph, package: &str, allowed: &[&str], because: &str) -> Vec<Finding> {
    let mut found = lost(graph, &[package], because);
    for id in graph.named(package) {
        for (used, kind) in &graph.0[id].uses {
            let name = graph.0[used].name.as_str();
            if *kind != Kind::Dev && !allowed.contains(&name) {
                found.push(Finding::new(package, format!("uses {name}: {because}")));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::graph::synthetic::graph;
    use super::*;

    /// The house in small, with one more dependency `from -> to`.
    fn house(from: &str, to: &str, kind: Kind) -> Vec<Finding> {
        let mut house = graph(&[
            ("xt28-dbc-model", true, &[]),
            ("xt28-dbc", true, &[("xt28-dbc-model", Kind::Build)]),
            ("xt28-bus", true, &[("xt28-dbc", Kind::Normal), ("socketcan", Kind::Normal)]),
            ("xt28-terrain", true, &[]),
            ("xt28-sim", true, &[("rapier3d", Kind::Normal), ("xt28-terrain", Kind::Normal)]),
            ("xt28-ecus", true, &[("xt28-dbc", Kind::Normal)]),
            ("ecu-emu", true, &[("xt28-ecus", Kind::Normal), ("xt28-sim", Kind::Normal)]),
            ("xt28-safety", true, &[("libm", Kind::Normal), ("proptest", Kind::Dev)]),
            ("xt28-gap", true, &[("xt28-sim", Kind::Normal)]),
            ("xt28-gap-plants", true, &[("xt28-sim", Kind::Normal)]),
            (
                "xt28-gap-check",
                true,
                &[("xt28-gap", Kind::Normal), ("xt28-gap-plants", Kind::Normal)],
            ),
            ("gateway", true, &[("xt28-bus", Kind::Normal), ("xt28-safety", Kind::Normal)]),
            ("socketcan", false, &[]),
            ("rapier3d", false, &[]),
            ("libm", false, &[]),
            ("proptest", false, &[]),
        ]);
        if let Some(package) = house.0.get_mut(from) {
            package.uses.push((to.to_owned(), kind));
        }
        check(&house, RULES)
    }

    #[test]
    fn the_house_as_planned_is_clean() {
        assert_eq!(house("", "", Kind::Normal), []);
    }

    #[test]
    fn each_forbidden_dependency_is_found() {
        let forbidden = [
            ("xt28-ecus", "xt28-sim", "xt28-ecus -> xt28-sim breaks never 1"),
            ("xt28-dbc", "rapier3d", "xt28-ecus -> xt28-dbc -> rapier3d breaks never 1"),
            ("xt28-sim", "xt28-dbc", "xt28-sim -> xt28-dbc breaks never 2"),
            ("xt28-sim", "xt28-bus", "xt28-sim -> xt28-bus -> socketcan breaks never 2"),
            ("xt28-bus", "xt28-sim", "gateway -> xt28-bus -> xt28-sim -> rapier3d breaks never 3"),
            ("xt28-terrain", "rapier3d", "xt28-terrain -> rapier3d breaks the ground"),
            ("xt28-gap", "xt28-gap-plants", "xt28-gap -> xt28-gap-plants breaks a diagnosis"),
            ("gateway", "socketcan", "uses socketcan: never 4"),
            ("xt28-safety", "socketcan", "uses socketcan: the safety kernel"),
        ];
        for (from, to, message) in forbidden {
            let found = house(from, to, Kind::Normal);
            assert!(found.iter().any(|f| f.message.starts_with(message)), "{from} {to}: {found:?}");
        }
    }

    #[test]
    fn tests_count_as_targets_except_where_they_are_free() {
        assert_ne!(house("gateway", "rapier3d", Kind::Dev), []);
        assert_ne!(house("xt28-ecus", "xt28-sim", Kind::Dev), []);
        assert_eq!(house("xt28-safety", "xt28-dbc-model", Kind::Dev), []);
    }

    #[test]
    fn a_rule_without_its_subject_is_found() {
        let empty = graph(&[]);
        let found = check(&empty, RULES);
        assert!(found.iter().any(|finding| finding.place == "xt28-safety"), "{found:?}");
        assert!(found.iter().any(|finding| finding.place == "rapier3d"), "{found:?}");
    }
}
