//! Who sits in the cab of a scenario: the profile of the ECUs, and what an operator does with it.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;

use ecu_emu::{Operator, OperatorError, Profile, Quirks};
use serde::de::{Deserialize, Deserializer, Error};

/// An operator's script, with the text that programs get as a file.
#[derive(Clone, Debug, PartialEq)]
pub struct CabScript {
    /// Its TOML.
    pub text: String,
    /// What it says.
    pub operator: Operator,
}

impl CabScript {
    /// The script at `path`, whose text `read` gets.
    ///
    /// # Errors
    /// [`OperatorError`].
    pub(crate) fn read(
        path: &Path,
        read: impl Fn(&Path) -> io::Result<String>,
    ) -> Result<Self, OperatorError> {
        let text =
            read(path).map_err(|source| OperatorError::Read { path: path.to_owned(), source })?;
        let operator = Operator::parse(&text, path)?;
        Ok(Self { text, operator })
    }
}

/// The firmware's oddities, but for those that are named with true or false.
pub(crate) fn quirks<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Quirks, D::Error> {
    let mut quirks = Quirks::firmware();
    for (name, on) in BTreeMap::<String, bool>::deserialize(deserializer)? {
        quirks.set(&name, on).map_err(D::Error::custom)?;
    }
    Ok(quirks)
}

/// A profile by the name that the command line has for it.
pub(crate) fn profile<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Profile, D::Error> {
    String::deserialize(deserializer)?.parse().map_err(D::Error::custom)
}
