#![no_main]
#[allow(dead_code, non_snake_case)]
#[path = "../../crates/mozzi-urdf/tests/fuzz/targets.rs"]
mod targets;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| targets::mjcf(bytes));
