//! Where in a TOML text something is wrong, as scripts and policy files are refused.

use serde::de::DeserializeOwned;

/// The line, from 1, of the byte `at` of a text, or of its last one.
pub(super) fn line_at(text: &[u8], at: usize) -> usize {
    text[..at.min(text.len())].iter().filter(|&&byte| byte == b'\n').count() + 1
}

/// What a text says, or at which byte something is wrong and, in one line, what.
pub(super) fn parsed<T: DeserializeOwned>(text: &str) -> Result<T, (usize, String)> {
    toml::from_str(text).map_err(|error| {
        let problem = error.message().trim_end().replace('\n', " ");
        (error.span().map_or(0, |span| span.start), problem)
    })
}
