//! The bytes of a DBC file as text: UTF-8, or else Windows-1252, which most editors of it write.

use std::borrow::Cow;

/// Windows-1252 from 80 to 9F; the five bytes it leaves open stay what they are in Latin-1.
const HIGH: [char; 32] = [
    '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8D}', 'Ž', '\u{8F}',
    '\u{90}', '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9D}', 'ž', 'Ÿ',
];

/// The text that `bytes` are, without the mark that some editors put before UTF-8.
#[must_use]
pub fn text(bytes: &[u8]) -> Cow<'_, str> {
    let bytes = bytes.strip_prefix("\u{FEFF}".as_bytes()).unwrap_or(bytes);
    let char = |&byte: &u8| match byte {
        0x80..=0x9F => HIGH[usize::from(byte - 0x80)],
        _ => char::from(byte),
    };
    std::str::from_utf8(bytes)
        .map_or_else(|_| bytes.iter().map(char).collect::<String>().into(), Cow::Borrowed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_utf_8_with_and_without_its_mark_and_windows_1252() {
        assert_eq!(text("\"°\" Prüfstand".as_bytes()), "\"°\" Prüfstand");
        assert_eq!(text(b"\xEF\xBB\xBFVERSION \"\""), "VERSION \"\"");
        assert_eq!(
            text(b"\"\xB0\" Pr\xFCfstand \x96 5 \x80 \x9F\x81"),
            "\"°\" Prüfstand – 5 € Ÿ\u{81}"
        );
    }
}
