//! The `mozzi` command line.
fn main() {}
