//! The soname of the shared library, and its stay in memory: threads of batches may run when a program unloads it.

/// Raised by every change of mozzi.h that breaks programs; also in `mozzi_abi_version` and mozzi.h.
const ABI_VERSION: u32 = 0;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "linux") {
        println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libmozzi.so.{ABI_VERSION}");
        println!("cargo:rustc-cdylib-link-arg=-Wl,-z,nodelete");
    }
}
