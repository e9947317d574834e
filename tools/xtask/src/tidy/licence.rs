//! The licences of everything we build with.

use super::graph::Graph;
use super::{Finding, spdx};

/// Every package of the graph whose licence we may not build upon, tests and all platforms included.
pub(crate) fn check(graph: &Graph) -> Vec<Finding> {
    let mut found = Vec::new();
    for package in graph.0.values() {
        let verdict = match package.licence.as_deref() {
            None => Err("its manifest names no licence".to_owned()),
            Some(expression) => spdx::accepts(expression).and_then(|accepted| {
                if accepted { Ok(()) } else { Err(format!("`{expression}` is not accepted")) }
            }),
        };
        if let Err(why) = verdict {
            found.push(Finding::new(&package.name, format!("licence: {why}")));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::graph::synthetic::graph;
    use super::check;

    #[test]
    fn a_missing_and_a_refused_licence_are_found() {
        let mut packages = graph(&[("a", true, &[]), ("b", false, &[]), ("c", false, &[])]);
        assert_eq!(check(&packages), []);
        packages.0.get_mut("b").unwrap().licence = None;
        packages.0.get_mut("c").unwrap().licence = Some("GPL-3.0-only".into());
        let places: Vec<String> = check(&packages).into_iter().map(|f| f.place).collect();
        assert_eq!(places, ["b", "c"]);
    }
}
