//! `cargo xtask test | check`: what CI runs, anyone can run.
fn main() {}
