//! What is wrong with a machine, written down where a diagnosis does not look.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// The truth about one case, as its answer file has it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Name of the case.
    pub case: String,
    /// Seed it was drawn from.
    pub seed: u64,
    /// `null`, `single`, `pair` or `unknown`.
    pub kind: String,
    /// What is wrong; nothing for a sound machine.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub truth: Vec<Fact>,
}

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fact {
    /// Name of the effect.
    pub effect: String,
    /// Block of the machine.
    pub group: String,
    /// Wheels that it is on; `all` where it has none.
    pub scope: String,
    /// Signal that it shows in first.
    pub target_signal: String,
    /// When it begins, s from the start of every log; 0 for from before.
    pub start_s: f64,
    /// How bad it is; units in the names.
    pub parameters: BTreeMap<String, f64>,
}

impl Answer {
    /// The file's text.
    ///
    /// # Panics
    /// Never: numbers, texts and tables always serialise.
    #[must_use]
    pub fn text(&self) -> String {
        toml::to_string(self).expect("an answer is plain data")
    }

    /// Reads a file's text.
    ///
    /// # Errors
    /// The text is not an answer.
    pub fn parse(text: &str) -> Result<Self, toml::de::Error> {
        toml::from_str(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_reads_back_as_written() {
        let fact = Fact {
            effect: "arm-delay".to_owned(),
            group: "arms".to_owned(),
            scope: "front".to_owned(),
            target_signal: "stroke".to_owned(),
            start_s: 0.0,
            parameters: BTreeMap::from([("delay_s".to_owned(), 0.21)]),
        };
        let answer =
            Answer { case: "a".to_owned(), seed: 7, kind: "single".to_owned(), truth: vec![fact] };
        assert_eq!(Answer::parse(&answer.text()).unwrap(), answer);
        let sound = Answer { kind: "null".to_owned(), truth: Vec::new(), ..answer };
        assert_eq!(Answer::parse(&sound.text()).unwrap(), sound);
    }
}
