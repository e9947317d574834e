//! Whether names of a database can be names in Rust.

use std::collections::BTreeSet;

use crate::generate_error::GenerateError;

/// Words that no field, type or variant may be called.
const KEYWORDS: [&str; 52] = [
    "Self", "abstract", "as", "async", "await", "become", "box", "break", "const", "continue",
    "crate", "do", "dyn", "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if",
    "impl", "in", "let", "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub",
    "ref", "return", "self", "static", "struct", "super", "trait", "true", "try", "type", "typeof",
    "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];

/// Names of one place, each usable and given once.
pub(crate) struct Names {
    place: String,
    taken: BTreeSet<String>,
}

impl Names {
    pub(crate) const fn of(place: String) -> Self {
        Self { place, taken: BTreeSet::new() }
    }

    /// Takes a name, if Rust can and nobody has.
    pub(crate) fn take(&mut self, name: String) -> Result<(), GenerateError> {
        let refuse = |what: &'static str| {
            Err(GenerateError::Unsupported { place: format!("{}: \"{name}\"", self.place), what })
        };
        let starts = name.starts_with(|c: char| c.is_ascii_alphabetic());
        let goes_on = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if !starts || !goes_on || KEYWORDS.contains(&name.as_str()) {
            return refuse("cannot be a name in Rust; rename it in the database");
        }
        if self.taken.contains(&name) {
            return refuse("comes twice once written as Rust does; rename one in the database");
        }
        self.taken.insert(name);
        Ok(())
    }
}
