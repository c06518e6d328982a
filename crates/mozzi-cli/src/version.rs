//! Output of `mozzi --version`: the version, the commit, and the features of this build on this machine.

use mozzi_engine::Shape;

/// The optional parts, and whether this build has them.
const FEATURES: [(&str, bool); 5] = [
    ("arrow", cfg!(feature = "arrow")),
    ("mcap", cfg!(feature = "mcap")),
    ("parquet", cfg!(feature = "parquet")),
    ("pdf", cfg!(feature = "pdf")),
    ("png", cfg!(feature = "png")),
];

/// A version, then a line for each of the rest.
pub fn long() -> String {
    let version = env!("CARGO_PKG_VERSION");
    // set where releases are built
    let commit = option_env!("MOZZI_COMMIT").unwrap_or("not recorded (not a released build)");
    let features: Vec<&str> = FEATURES.iter().filter(|(_, is_on)| *is_on).map(|(name, _)| *name).collect();
    let features = if features.is_empty() { "none".to_string() } else { features.join(", ") };
    let mut compiled: Vec<&str> =
        Shape::ALL.into_iter().filter(|shape| shape.is_supported()).map(Shape::instruction_set).collect();
    compiled.sort_unstable();
    compiled.dedup();
    let compiled = if compiled.is_empty() { "not on this machine".to_string() } else { compiled.join(", ") };
    let unused = Shape::unused().map_or(String::new(), |set| format!(" ({set} is there and not used)"));
    format!(
        "{version}\ncommit: {commit}\nfeatures: {features}\nmachine code: {compiled}{unused}\nfor: {} {}",
        std::env::consts::ARCH,
        std::env::consts::OS
    )
}
