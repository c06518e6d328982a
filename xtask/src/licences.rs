//! Checks that the licences of all dependencies are among the accepted ones.

use crate::metadata;
use crate::report::Outcome;
use crate::spdx;
use crate::workspace::Workspace;

/// Permissive licences: they require at most that their notice is kept. MPL-2.0 (changes to the licensed files stay
/// under it) would be acceptable too, but no dependency needs it, except the book's builder; it is not listed, so that
/// adding such a package is a decision.
const ALLOWED: [&str; 11] = [
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
    "0BSD",
];

/// Packages that name a file instead of an expression, with the version whose file was read, and its licence.
const READ: [(&str, &str); 5] = [
    ("f256 0.11.3", "BSD-3-Clause"),
    ("f256_pow10_div_pow2_lut 0.11.3", "BSD-3-Clause"),
    ("f256_pow2_div_pow10_lut 0.11.3", "BSD-3-Clause"),
    ("f256_pow2_div_pow5_lut 0.11.3", "BSD-3-Clause"),
    ("f256_pow5_div_pow2_lut 0.11.3", "BSD-3-Clause"),
];

/// The tool that builds the documentation book.
const BOOK: &str = "xtask/book/Cargo.toml";
/// Further licences that are allowed in this tool, since nothing that is shipped links it: mdBook is under MPL-2.0, the
/// icons of the book under CC-BY-4.0.
const ALLOWED_IN_BOOK: [&str; 2] = ["MPL-2.0", "CC-BY-4.0"];

pub fn check(workspace: &Workspace) -> Outcome {
    let book = [&ALLOWED[..], &ALLOWED_IN_BOOK].concat();
    match accepted(workspace, "Cargo.toml", &ALLOWED).and_then(|all| Ok((all, accepted(workspace, BOOK, &book)?))) {
        Ok((all, book)) => Outcome::Passed(format!("{all} dependencies, {book} of the book's builder")),
        Err(why) => Outcome::Failed(why),
    }
}

/// The number of dependencies of a manifest; an error if one has another licence than these.
fn accepted(workspace: &Workspace, manifest: &str, allowed: &[&str]) -> Result<usize, String> {
    let dependencies = metadata::dependencies(workspace, manifest)?;
    let mut refused = Vec::new();
    for dependency in &dependencies {
        let read = READ.iter().find(|(name, _)| *name == dependency.name).map(|(_, licence)| licence.to_string());
        let verdict = match &dependency.licence.clone().or(read) {
            None => Err("states no licence expression".to_owned()),
            Some(expression) => match spdx::satisfiable(expression, allowed) {
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
        true => Ok(dependencies.len()),
        false => Err(refused.join(", ")),
    }
}
