//! Where in a scenario's text the entries of its lists stand, so that a refusal names the right one of several.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::{Spanned, Value};

/// The keys of one entry, and where each stands.
pub(crate) type Keys = BTreeMap<Spanned<String>, Value>;

/// The lists of a scenario.
#[derive(Debug, Default, Deserialize)]
pub(crate) struct Places {
    /// `[[effect]]`.
    #[serde(default)]
    effect: Vec<Keys>,
    /// `[[event]]`.
    #[serde(default)]
    event: Vec<Keys>,
    /// `[[fault]]`.
    #[serde(default)]
    fault: Vec<Keys>,
    /// `[[expect]]`, each with one key, its name.
    #[serde(default)]
    pub(crate) expect: Vec<Keys>,
}

impl Places {
    /// The places in `text`; none where it is no scenario.
    pub(crate) fn of(text: &str) -> Self {
        toml::from_str(text).unwrap_or_default()
    }

    /// Line, from 1, of `key` in the effect `index`.
    pub(crate) fn effect(&self, index: usize, key: &str, text: &str) -> usize {
        line_of(self.effect.get(index), key, text)
    }

    /// Line, from 1, of `key` in the event `index`.
    pub(crate) fn event(&self, index: usize, key: &str, text: &str) -> usize {
        line_of(self.event.get(index), key, text)
    }

    /// Line, from 1, of `key` in the fault `index`.
    pub(crate) fn fault(&self, index: usize, key: &str, text: &str) -> usize {
        line_of(self.fault.get(index), key, text)
    }
}

fn line_of(keys: Option<&Keys>, key: &str, text: &str) -> usize {
    let of_key = keys.into_iter().flatten().find(|(name, _)| name.get_ref() == key);
    of_key.map_or(1, |(name, _)| line_at(text, name.span().start))
}

/// The line, from 1, of the byte at `offset`.
pub(crate) fn line_at(text: &str, offset: usize) -> usize {
    let before = &text.as_bytes()[..offset.min(text.len())];
    before.iter().filter(|&&byte| byte == b'\n').count() + 1
}
