//! Each program by each compiler.

use crate::toolchain::{Build, SANITIZERS, exists, has_sanitizers};

const C: [&str; 2] = ["gcc", "clang"];

/// Those compilers that are here; says which are not.
fn here<'a>(compilers: &[&'a str]) -> Vec<&'a str> {
    let (here, missing): (Vec<&str>, Vec<&str>) = compilers.iter().partition(|compiler| exists(compiler));
    if !missing.is_empty() {
        println!("skipped: {} not installed", missing.join(", "));
    }
    here
}

/// A program of C99 by every compiler, and with sanitizers.
fn c99(program: &str) {
    for compiler in here(&C) {
        let build = Build { compiler, standard: "c99", flags: &["-D_POSIX_C_SOURCE=200809L"], is_static: false };
        build.run(program);
        if !has_sanitizers(compiler) {
            continue;
        }
        let flags = [&["-D_POSIX_C_SOURCE=200809L"], &SANITIZERS[..]].concat();
        Build { flags: &flags, ..build }.run(program);
    }
}

#[test]
fn every_quantity_in_c() {
    c99("quantities.c");
}
