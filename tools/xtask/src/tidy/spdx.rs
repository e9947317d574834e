//! SPDX licence expressions: does one leave a choice within the licences we accept?

/// The accepted licences: permissive, or file-level copyleft at most.
const ACCEPTED: &[&str] = &[
    "0BSD",
    "Apache-2.0",
    "BSD-1-Clause",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "ISC",
    "MIT",
    "MIT-0",
    "MPL-2.0",
    "Unicode-3.0",
    "Unicode-DFS-2016",
    "Zlib",
];

/// Whether the expression can be met with accepted licences alone.
///
/// `OR` offers a choice, `AND` asks for both and binds tighter, `WITH` only ever adds permission.
/// The slash of old manifests (`MIT/Apache-2.0`) means `OR`.
///
/// # Errors
/// When the text is not an expression; says where it stops being one.
pub(crate) fn accepts(expression: &str) -> Result<bool, String> {
    let spaced = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let mut parser = Parser { words: &words };
    let accepted = parser.any_of()?;
    match parser.words.first() {
        None => Ok(accepted),
        Some(word) => Err(format!("`{word}` was not expected in `{expression}`")),
    }
}

struct Parser<'a> {
    words: &'a [&'a str],
}

impl Parser<'_> {
    fn take(&mut self, word: &str) -> bool {
        let next = self.words.first() == Some(&word);
        if next {
            self.words = &self.words[1..];
        }
        next
    }

    fn any_of(&mut self) -> Result<bool, String> {
        let mut accepted = self.all_of()?;
        while self.take("OR") {
            accepted |= self.all_of()?;
        }
        Ok(accepted)
    }

    fn all_of(&mut self) -> Result<bool, String> {
        let mut accepted = self.one()?;
        while self.take("AND") {
            accepted &= self.one()?;
        }
        Ok(accepted)
    }

    fn one(&mut self) -> Result<bool, String> {
        if self.take("(") {
            let accepted = self.any_of()?;
            return if self.take(")") { Ok(accepted) } else { Err("`)` is missing".into()) };
        }
        let (&id, rest) = self.words.split_first().ok_or("a licence is missing at the end")?;
        if matches!(id, "OR" | "AND" | "WITH" | ")") {
            return Err(format!("a licence was expected where `{id}` stands"));
        }
        self.words = rest;
        if self.take("WITH") {
            let (_exception, rest) = self.words.split_first().ok_or("an exception is missing")?;
            self.words = rest;
        }
        Ok(ACCEPTED.contains(&id))
    }
}

#[cfg(test)]
mod tests {
    use super::accepts;

    #[test]
    fn a_choice_within_the_accepted_ones_is_enough() {
        for expression in [
            "MIT",
            "MIT OR Apache-2.0",
            "MIT/Apache-2.0",
            "Unlicense OR MIT",
            "GPL-3.0-only OR (Zlib AND ISC)",
            "(MIT OR Apache-2.0) AND Unicode-3.0",
            "Apache-2.0 WITH LLVM-exception",
            "GPL-2.0-only OR MIT AND BSD-3-Clause",
        ] {
            assert_eq!(accepts(expression), Ok(true), "{expression}");
        }
    }

    #[test]
    fn what_binds_us_to_another_licence_is_refused() {
        for expression in [
            "GPL-3.0-only",
            "MIT AND GPL-2.0-or-later",
            "(MIT OR ISC) AND LGPL-3.0-only",
            "GPL-2.0-only WITH Classpath-exception-2.0",
            "AGPL-3.0/GPL-3.0",
            "GPL-2.0-only OR MIT AND GPL-3.0-only",
        ] {
            assert_eq!(accepts(expression), Ok(false), "{expression}");
        }
    }

    #[test]
    fn what_is_no_expression_is_an_error() {
        for text in ["", "MIT OR", "(MIT", "MIT)", "AND MIT", "MIT Apache-2.0", "MIT WITH"] {
            assert!(accepts(text).is_err(), "{text}");
        }
    }
}
