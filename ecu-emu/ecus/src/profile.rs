//! Whose control runs in the two ECUs.

use core::fmt;
use core::str::FromStr;

/// A profile of both ECUs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Profile {
    /// The paper's: remote commands, states, refusals.
    #[default]
    Paper,
    /// The public firmware of 2016: an operator's armrests and pedals.
    Firmware2016,
}

impl Profile {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Paper, Self::Firmware2016];

    /// As command lines and scenarios name it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Firmware2016 => "2016",
        }
    }
}

impl fmt::Display for Profile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A name that is no profile's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownProfile(String);

impl fmt::Display for UnknownProfile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no profile {:?}; give paper or 2016", self.0)
    }
}

impl core::error::Error for UnknownProfile {}

impl FromStr for Profile {
    type Err = UnknownProfile;

    fn from_str(name: &str) -> Result<Self, UnknownProfile> {
        let named = |profile: &Self| profile.name() == name;
        Self::ALL.into_iter().find(named).ok_or_else(|| UnknownProfile(name.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_profile_is_what_its_name_says() {
        for profile in Profile::ALL {
            assert_eq!(profile.to_string().parse(), Ok(profile));
        }
        let error = "2015".parse::<Profile>().unwrap_err().to_string();
        assert_eq!(error, "no profile \"2015\"; give paper or 2016");
    }
}
