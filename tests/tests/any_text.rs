//! Scenario files that no one would write: answered in one line with file and line, never a panic.

use std::io;
use std::path::Path;

use proptest::prelude::*;
use xt28_scenarios::{BUILTIN, Scenario, ScenarioError};

fn parse(text: &str) -> Result<Scenario, ScenarioError> {
    Scenario::parse(text, Path::new("any.toml"), |_| Err(io::ErrorKind::NotFound.into()))
}

fn in_order(text: &str) -> Result<(), TestCaseError> {
    if let Err(error) = parse(text) {
        let line = error.to_string();
        prop_assert!(line.starts_with("any.toml:"), "{line}");
        prop_assert!(!line.contains('\n'), "{line}");
    }
    Ok(())
}

proptest! {
    #[test]
    fn any_text(text in any::<String>()) {
        in_order(&text)?;
    }

    #[test]
    fn a_built_in_scenario_with_a_piece_replaced(
        which in 0..BUILTIN.len(),
        at in any::<prop::sample::Index>(),
        length in 0_usize..12,
        piece in "[ -~\n]{0,12}",
    ) {
        let text = BUILTIN[which].1;
        prop_assume!(text.is_ascii());
        let from = at.index(text.len());
        let to = (from + length).min(text.len());
        in_order(&format!("{}{piece}{}", &text[..from], &text[to..]))?;
    }
}
