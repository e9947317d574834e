//! Where in a database's text its messages and signals are declared, which the parser does not tell.

/// A message as the text declares it.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Declared<'a> {
    /// Line, from 1.
    pub(crate) line: usize,
    /// Identifier, as written.
    pub(crate) id: &'a str,
    /// Name.
    pub(crate) name: &'a str,
    signals: Vec<(&'a str, usize)>,
}

impl Declared<'_> {
    /// Line of the signal of that name; the message's own without one.
    pub(crate) fn line_of(&self, signal: &str) -> usize {
        let found = self.signals.iter().find(|(name, _)| *name == signal);
        found.map_or(self.line, |(_, line)| *line)
    }
}

/// Messages in the order of the text. What stands in quotes declares nothing, over lines too.
pub(crate) fn declared(text: &str) -> Vec<Declared<'_>> {
    let (mut messages, mut quoted): (Vec<Declared<'_>>, bool) = (Vec::new(), false);
    for (index, line) in text.lines().enumerate() {
        let mut words = line.split([' ', '\t', ':']).filter(|word| !word.is_empty());
        let mut word = || words.next().unwrap_or_default();
        match (quoted, word()) {
            (false, "BO_") => messages.push(Declared {
                line: index + 1,
                id: word(),
                name: word(),
                signals: Vec::new(),
            }),
            (false, "SG_") => {
                if let Some(message) = messages.last_mut() {
                    message.signals.push((word(), index + 1));
                }
            }
            _ => {}
        }
        quoted = ends_quoted(line, quoted);
    }
    messages
}

/// Whether the text after `line` is still in quotes.
fn ends_quoted(line: &str, mut quoted: bool) -> bool {
    let mut before = ' ';
    for c in line.chars() {
        match c {
            '"' if !quoted || before != '\\' => quoted = !quoted,
            // The rest is a comment of the file's own, quotes and all.
            '/' if !quoted && before == '/' => return false,
            _ => {}
        }
        before = c;
    }
    quoted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stands_in_quotes_or_comments_declares_nothing() {
        let text = "BO_ 5 A: 8 N\n SG_ X : 0|8@1+ (1,0) [0|0] \"\" N\n\tSG_ Y m1 : 8|8@1+\n\
                    // a \" of no matter\nCM_ BO_ 5 \"said \\\"so:\nBO_ 5000 B: 8 N\n SG_ Z : 0\n\";\n\
                    BO_\t7  C : 2 N\n";
        let found = declared(text);
        let names: Vec<_> = found.iter().map(|m| (m.line, m.id, m.name)).collect();
        assert_eq!(names, [(1, "5", "A"), (9, "7", "C")]);
        assert_eq!(["X", "Y", "Z"].map(|name| found[0].line_of(name)), [2, 3, 1]);
    }
}
