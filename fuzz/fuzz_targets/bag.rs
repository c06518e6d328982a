#![no_main]
#[allow(dead_code)]
#[path = "../../crates/mozzi-cli/tests/fuzz/targets.rs"]
mod targets;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| targets::bag(bytes));
