//! The classes of rays that a renderer sends.

use std::fmt;
use std::str::FromStr;

/// Why a renderer would send these rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Class {
    /// From the camera, through jittered places of the pixels.
    Primary,
    /// From what the camera sees to a light.
    Shadow,
    /// Mirrored by what the camera sees.
    Reflect,
    /// Scattered by what the camera sees, with the density of a diffuse surface.
    Diffuse,
    /// As diffuse, but short: is anything near?
    Ao,
    /// From anywhere within the bounds, anywhere.
    Random,
}

/// What is asked of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Question {
    /// Which hit is the nearest?
    Closest,
    /// Is there any hit?
    Any,
}

impl Class {
    /// All classes, in the order of reports.
    pub const ALL: [Self; 6] =
        [Self::Primary, Self::Shadow, Self::Reflect, Self::Diffuse, Self::Ao, Self::Random];
    /// Their names.
    pub const NAMES: [&'static str; 6] = ["primary", "shadow", "reflect", "diffuse", "ao", "random"];

    /// As written on the command line and in reports.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize]
    }
    /// What is asked of such rays.
    pub fn question(self) -> Question {
        match self {
            Self::Shadow | Self::Ao => Question::Any,
            _ => Question::Closest,
        }
    }
}

impl fmt::Display for Class {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Class {
    type Err = String;
    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|class| class.name() == name);
        found
            .ok_or_else(|| format!("there is no class `{name}`: expected some of {}", Self::NAMES.join(", ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_back() {
        for class in Class::ALL {
            assert_eq!(class.to_string().parse(), Ok(class));
        }
        assert!("mirror".parse::<Class>().unwrap_err().contains("reflect"));
    }
}
