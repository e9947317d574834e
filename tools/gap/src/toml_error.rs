//! A line number and one line of text from a TOML error.

/// Line (from 1) and message of `error`, which came from `text`.
pub(crate) fn locate(text: &str, error: &toml::de::Error) -> (usize, String) {
    let start = error.span().map_or(0, |span| span.start.min(text.len()));
    (line_of(text, start), error.message().replace('\n', " "))
}

/// Line (from 1) of the byte at `offset`.
pub(crate) fn line_of(text: &str, offset: usize) -> usize {
    text.as_bytes()[..offset.min(text.len())].iter().filter(|&&b| b == b'\n').count() + 1
}
