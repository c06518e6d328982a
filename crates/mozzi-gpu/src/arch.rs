//! The architecture that code is compiled for.

use crate::Error;
use std::fmt;
use std::str::FromStr;

/// A GPU's compute capability, such as 9.0: `sm_90`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Arch {
    major: u32,
    minor: u32,
}

impl Arch {
    /// The H100 and H200.
    pub const SM_90: Arch = Arch { major: 9, minor: 0 };

    /// Compute capability `major.minor`.
    ///
    /// # Errors
    /// [`Error::BadArch`] if major is 0 or minor is not a digit.
    pub fn new(major: u32, minor: u32) -> Result<Arch, Error> {
        match (major, minor) {
            (1.., 0..=9) => Ok(Arch { major, minor }),
            _ => Err(Error::BadArch { found: format!("sm_{major}{minor}") }),
        }
    }
}

impl fmt::Display for Arch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "sm_{}{}", self.major, self.minor)
    }
}

impl FromStr for Arch {
    type Err = Error;
    fn from_str(text: &str) -> Result<Arch, Error> {
        let bad = || Error::BadArch { found: text.to_string() };
        let digits = text.strip_prefix("sm_").filter(|digits| (2..=3).contains(&digits.len())).ok_or_else(bad)?;
        let number: u32 =
            digits.bytes().all(|c| c.is_ascii_digit()).then(|| digits.parse().ok()).flatten().ok_or_else(bad)?;
        Arch::new(number / 10, number % 10).map_err(|_| bad())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_and_written() {
        for name in ["sm_90", "sm_75", "sm_100", "sm_121"] {
            assert_eq!(name.parse::<Arch>().expect(name).to_string(), name);
        }
        assert_eq!("sm_90".parse::<Arch>().expect("valid"), Arch::SM_90);
        for wrong in ["90", "sm_9", "sm_", "sm_9x", "sm_+9", "sm_00", "sm_1234", "compute_90", ""] {
            let error = wrong.parse::<Arch>().expect_err(wrong).to_string();
            assert!(error.contains(&format!("`{wrong}`")) && error.contains("sm_90"), "{error}");
        }
    }
}
