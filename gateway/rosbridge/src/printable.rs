//! Text of a client that is shown to people.

/// Most of it that is shown, in characters.
const SHOWN_MAX: usize = 400;

/// A text that a terminal can be given: in one line, not long, without what would steer it.
#[must_use]
pub fn printable(text: &str) -> String {
    text.chars().take(SHOWN_MAX).map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_steers_a_terminal_is_left() {
        let shown = printable(&format!("a\u{1b}[31m\nb\r{}", "x".repeat(1000)));
        assert!(
            shown.starts_with("a\u{fffd}[31m\u{fffd}b\u{fffd}x") && shown.chars().count() == 400
        );
    }
}
