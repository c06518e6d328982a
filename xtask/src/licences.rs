//! Whether everything that we build on may be used under the licences that we accept.

use crate::metadata;
use crate::report::Outcome;
use crate::spdx;
use crate::workspace::Workspace;

/// Permissive licences: they ask for their notice at most. MPL-2.0 (changes to the licensed files stay under it) would
/// do no harm either, but nothing that we use needs it; so that adding such a package is a decision, it is not here.
const ALLOWED: [&str; 10] = [
    "MIT",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "ISC",
    "Zlib",
    "Unlicense",
    "Unicode-3.0",
    "BSL-1.0",
    "CC0-1.0",
];

/// Packages that name a file instead of an expression, in the versions whose file was read: what it is.
const READ: [(&str, &str); 5] = [
    ("f256 0.11.3", "BSD-3-Clause"),
    ("f256_pow10_div_pow2_lut 0.11.3", "BSD-3-Clause"),
    ("f256_pow2_div_pow10_lut 0.11.3", "BSD-3-Clause"),
    ("f256_pow2_div_pow5_lut 0.11.3", "BSD-3-Clause"),
    ("f256_pow5_div_pow2_lut 0.11.3", "BSD-3-Clause"),
];

pub fn check(workspace: &Workspace) -> Outcome {
    let dependencies = match metadata::dependencies(workspace) {
        Ok(dependencies) => dependencies,
        Err(why) => return Outcome::Failed(why),
    };
    let mut refused = Vec::new();
    for dependency in &dependencies {
        let read = READ.iter().find(|(name, _)| *name == dependency.name).map(|(_, licence)| licence.to_string());
        let verdict = match &dependency.licence.clone().or(read) {
            None => Err("states no licence expression".to_owned()),
            Some(expression) => match spdx::satisfiable(expression, &ALLOWED) {
                Ok(true) => Ok(()),
                Ok(false) => Err(format!("`{expression}` is not covered by the allowed licences")),
                Err(error) => Err(format!("`{expression}`: {error}")),
            },
        };
        if let Err(why) = verdict {
            println!("{}: {why}", dependency.name);
            refused.push(dependency.name.clone());
        }
    }
    match refused.is_empty() {
        true => Outcome::Passed(format!("{} dependencies", dependencies.len())),
        false => Outcome::Failed(refused.join(", ")),
    }
}
