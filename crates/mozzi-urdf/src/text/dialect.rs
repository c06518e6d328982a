//! The languages that robots are read in.

/// The language of a text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Dialect {
    #[default]
    Urdf,
    Mjcf,
    Sdf,
}

impl Dialect {
    /// The language of the text's first element, whatever the file's name; URDF if there is none.
    pub fn of(text: &str) -> Self {
        let mut rest = text;
        while let Some((_, after)) = rest.split_once('<') {
            let end = match after {
                _ if after.starts_with("!--") => "-->",
                _ if after.starts_with(['?', '!']) => ">",
                _ if after.starts_with("mujoco") => return Dialect::Mjcf,
                _ if is_sdf(after) => return Dialect::Sdf,
                _ => return Dialect::Urdf,
            };
            rest = after.split_once(end).map_or("", |(_, rest)| rest);
        }
        Dialect::Urdf
    }

    pub fn name(self) -> &'static str {
        match self {
            Dialect::Urdf => "URDF",
            Dialect::Mjcf => "MJCF",
            Dialect::Sdf => "SDFormat",
        }
    }

    /// The name of the root element.
    pub fn root(self) -> &'static str {
        match self {
            Dialect::Urdf => "robot",
            Dialect::Mjcf => "mujoco",
            Dialect::Sdf => "sdf",
        }
    }

    /// The prefix of its codes.
    pub fn prefix(self) -> &'static str {
        match self {
            Dialect::Urdf => "mozzi::urdf::",
            Dialect::Mjcf => "mozzi::mjcf::",
            Dialect::Sdf => "mozzi::sdf::",
        }
    }
}

/// True if the text begins with the whole word `sdf`.
fn is_sdf(text: &str) -> bool {
    text.strip_prefix("sdf")
        .is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_whitespace() || c == '>' || c == '/'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_element_tells() {
        for (text, dialect) in [
            ("<?xml version='1.0'?>\n<!-- <robot> -->\n<mujoco model='a'>", Dialect::Mjcf),
            ("<mujocoinclude>", Dialect::Mjcf),
            ("<?xml version='1.0'?><sdf version='1.9'>", Dialect::Sdf),
            ("<sdformat>", Dialect::Urdf),
            ("<robot><mujoco/></robot>", Dialect::Urdf),
            ("<!-- <mujoco>", Dialect::Urdf),
            ("", Dialect::Urdf),
        ] {
            assert_eq!(Dialect::of(text), dialect, "{text}");
        }
    }
}
