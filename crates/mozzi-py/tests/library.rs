//! `cargo xtask test` passes a library to Python. `cargo test --workspace` builds that library because this test
//! depends on it.

use std::path::Path;

#[test]
fn cargo_test_builds_the_library_for_python() {
    let name = format!("{}_mozzi{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("debug/deps");
    let bytes = std::fs::read(folder.join(&name)).expect("it lies in the folder of the tests' profile");
    let symbol = b"PyInit__mozzi";
    assert!(
        bytes.windows(symbol.len()).any(|part| part == symbol),
        "{name} has no {}",
        String::from_utf8_lossy(symbol)
    );
}
