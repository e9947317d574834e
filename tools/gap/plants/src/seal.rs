//! A seal on answers: a salted hash shown before a diagnosis runs, opened after.

use std::fmt;

use sha2::{Digest, Sha256};

/// SHA-256 of a salt and of answers in their order.
///
/// The salt keeps anyone from finding the answers by hashing guesses; whoever seals keeps it to
/// themselves until the seal is opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seal([u8; 32]);

impl Seal {
    /// Seals `answers` with `salt`.
    pub fn on<'a>(salt: &[u8; 32], answers: impl IntoIterator<Item = &'a str>) -> Self {
        let mut hash = Sha256::new();
        hash.update(salt);
        for answer in answers {
            // Lengths between, so that no two lists of answers run together alike.
            hash.update((answer.len() as u64).to_be_bytes());
            hash.update(answer.as_bytes());
        }
        Self(hash.finalize().into())
    }

    /// Whether these are the answers that were sealed.
    pub fn holds<'a>(&self, salt: &[u8; 32], answers: impl IntoIterator<Item = &'a str>) -> bool {
        *self == Self::on(salt, answers)
    }

    /// The seal that [`fmt::Display`] wrote; `None` for any other text.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.trim();
        if text.len() != 64 || !text.is_ascii() {
            return None;
        }
        let mut bytes = [0; 32];
        for (i, byte) in bytes.iter_mut().enumerate() {
            *byte = u8::from_str_radix(&text[2 * i..2 * i + 2], 16).ok()?;
        }
        Some(Self(bytes))
    }
}

impl fmt::Display for Seal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn no_text_panics_and_every_seal_reads_back(text in ".{0,70}", bytes: [u8; 32]) {
            let _ = Seal::parse(&text);
            prop_assert_eq!(Seal::parse(&Seal(bytes).to_string()), Some(Seal(bytes)));
        }
    }

    #[test]
    fn it_holds_for_these_answers_and_this_salt_alone() {
        let (salt, other) = ([7; 32], [8; 32]);
        let seal = Seal::on(&salt, ["one", "two"]);
        assert!(seal.holds(&salt, ["one", "two"]));
        for answers in [["one", "twO"], ["onet", "wo"], ["two", "one"]] {
            assert!(!seal.holds(&salt, answers), "{answers:?}");
        }
        assert!(!seal.holds(&other, ["one", "two"]));
        assert_eq!(Seal::parse(&seal.to_string()), Some(seal));
        assert_eq!(Seal::parse("sealed"), None);
    }
}
