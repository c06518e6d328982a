//! The order of mozzi's modules: none uses one above it.

/// From the ground up. `quantities` has the list of all quantities, which names kernels: its `mod.rs` is exempt.
const ORDER: [&str; 13] = [
    "scalar",
    "linalg",
    "lie",
    "spatial",
    "model",
    "workspace",
    "quantities",
    "kinematics",
    "dynamics",
    "constraints",
    "fast",
    "api",
    "conventions",
];
const EXEMPT: &str = "crates/mozzi/src/quantities/mod.rs";

/// A module above the file's own that a line of its code uses.
pub fn above(file: &str, line: &str) -> Option<&'static str> {
    let own = file.strip_prefix("crates/mozzi/src/").filter(|_| file != EXEMPT)?;
    let own = own.split(['/', '.']).next()?;
    let place = ORDER.iter().position(|module| *module == own)?;
    let uses = |module: &str| {
        line.match_indices("crate::").any(|(at, path)| {
            let rest = &line[at + path.len()..];
            rest.strip_prefix(module).is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
        })
    };
    ORDER[place + 1..].iter().copied().find(|module| uses(module))
}

#[cfg(test)]
mod tests {
    use super::above;

    #[test]
    fn a_module_uses_those_below_it() {
        let file = "crates/mozzi/src/model/build.rs";
        assert_eq!(above(file, "use crate::lie::SE3;"), None);
        assert_eq!(above(file, "use crate::kinematics::forward_kinematics;"), Some("kinematics"));
        assert_eq!(above(file, "use crate::dynamics_of_others;"), None);
        assert_eq!(above("crates/mozzi/src/fast.rs", "use crate::dynamics::mass_matrix;"), None);
        assert_eq!(above("crates/mozzi/src/quantities/mod.rs", "pub use crate::dynamics::x;"), None);
        assert_eq!(above("crates/mozzi-sim/src/lib.rs", "use crate::constraints;"), None);
    }
}
